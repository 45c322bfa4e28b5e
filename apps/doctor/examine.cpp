#include "apps/doctor/examine.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "apps/doctor/findings.hpp"
#include "apps/machine/running_machine.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "hmi_bridge/socket/client.hpp"

namespace taktwerk::apps {
namespace {

constexpr int below_machines = 70;  // 80 is the usual priority of a cycle

bool machine_runs() {
    const auto client = hmi::Client::connect("");
    return client.ok() || client.error().code == "socket.ambiguous";
}

void judge(Examination& seen) {
    sort_by_cost(seen.findings);
    seen.verdict = verdict(seen.findings, seen.measured ? &*seen.measured : nullptr, seen.wanted);
}

/// Nothing, with the reason, where a frame of ours would be in somebody's way.
std::unique_ptr<ecat::RawSocketTransport> bus_at(const std::string& interface, const Clock& clock, std::string& why_not) {
    if (const auto machine = machine_on(interface, {})) {
        why_not = "machine " + machine->name + " has this interface (`taktwerk status` has its figures)";
        return nullptr;
    }
    auto opened = ecat::RawSocketTransport::open(interface, {.clock = &clock});
    if (!opened) {
        why_not = opened.error().text();
        return nullptr;
    }
    (*opened)->refresh();
    if (!(*opened)->link_up()) {
        why_not = "there is no link";
        return nullptr;
    }
    return std::move(*opened);
}

}  // namespace

Examination examine(const std::filesystem::path& root, const EthernetPorts& ports, const Wanted& wanted, const std::string& interface) {
    const HostFiles files{root};
    Examination seen;
    seen.wanted = wanted;
    seen.interface = interface;
    seen.findings = host_findings(host_facts(files, wanted.cpu >= 0 ? std::optional{wanted.cpu} : std::nullopt), wanted);
    if (!interface.empty()) {
        auto of_port = port_findings(port_facts(files, ports, interface), wanted);
        seen.findings.insert(seen.findings.end(), of_port.begin(), of_port.end());
        // The master that is heard there is one of ours.
        if (const auto machine = machine_on(interface, {}))
            for (auto& finding : seen.findings)
                if (finding.code == "port.other_master")
                    finding = {"port.machine", Severity::good, 0, fmt::format("machine {} has {}", machine->name, interface), "", "", ""};
    }
    judge(seen);
    return seen;
}

void measure(Examination& seen, Duration lasts) {
    Measured m;
    m.plan.interval = seen.wanted.cycle;
    m.plan.lasts = lasts;
    m.plan.cpu = seen.wanted.cpu;
    if (machine_runs()) m.plan.priority = below_machines;
    SystemClock clock;
    std::unique_ptr<ecat::RawSocketTransport> bus;
    if (!seen.interface.empty()) {
        const auto is = [&](std::string_view code) {
            return std::any_of(seen.findings.begin(), seen.findings.end(), [&](const Finding& f) { return f.code == code; });
        };
        if (is("port.missing")) m.no_trips = fmt::format("there is no {} here, see below", seen.interface);
        else if (is("port.other_master") || is("port.bridged")) m.no_trips = "see below why this interface is not free";
        else bus = bus_at(seen.interface, clock, m.no_trips);
        if (bus) m.trips.emplace();
    }
    std::atomic<bool> over{false};
    ClockWatch clocks;
    std::thread watch{[&] {
        while (!over.load()) {
            clock.sleep_until(clock.now() + std::chrono::milliseconds{100});
            if (bus) bus->refresh();
            clocks.look();
        }
    }};
    m.lateness = measure_lateness(m.plan, bus.get(), m.trips ? &*m.trips : nullptr);
    over = true;
    watch.join();
    m.clocks = clocks.facts();
    auto measured = measured_findings(m, seen.wanted);
    seen.findings.insert(seen.findings.end(), measured.begin(), measured.end());
    seen.measured = std::move(m);
    judge(seen);
}

}  // namespace taktwerk::apps
