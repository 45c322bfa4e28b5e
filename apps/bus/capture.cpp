// taktwerk bus capture: hears a cable, writes what is on it, and says who speaks there. Sends nothing.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/clock.hpp"
#include "ecat/recording/interface_listener.hpp"
#include "ecat/recording/pcapng_file.hpp"

namespace taktwerk::apps {

namespace {

struct CaptureOptions {
    std::string nic, output;
    bool json = false, replace = false;
    double duration_s = 0;
};

constexpr Duration look_for_signals = std::chrono::milliseconds{100};
constexpr std::size_t shown_kinds = 12;

std::string address_text(const ecat::MacAddress& a) {
    return fmt::format("{:02x}:{:02x}:{:02x}:{:02x}:{:02x}:{:02x}", a[0], a[1], a[2], a[3], a[4], a[5]);
}

std::string place_text(const ecat::DatagramTraffic& kind) {
    switch (kind.command) {
        case ecat::Command::LRD:
        case ecat::Command::LWR:
        case ecat::Command::LRW: return fmt::format("{:08X}h", kind.address.raw);
        case ecat::Command::FPRD:
        case ecat::Command::FPWR:
        case ecat::Command::FPRW:
        case ecat::Command::FRMW: return fmt::format("station {:04X}h, {:04X}h", kind.address.adp(), kind.address.ado());
        default: return fmt::format("{:04X}h", kind.address.ado());
    }
}

/// The most frequent first: "9 (9,990 times), 6 (8)".
std::string counters_text_of(const ecat::DatagramTraffic& kind) {
    std::vector<std::pair<std::uint16_t, std::uint64_t>> counters{kind.working_counters.begin(), kind.working_counters.end()};
    std::stable_sort(counters.begin(), counters.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string text;
    for (const auto& [counter, times] : counters) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", counter, times);
    return text.empty() ? "none came back" : text;
}

std::vector<ecat::DatagramTraffic> by_frequency(std::vector<ecat::DatagramTraffic> kinds) {
    const auto times = [](const ecat::DatagramTraffic& kind) {
        std::uint64_t back = 0;
        for (const auto& [counter, count] : kind.working_counters) back += count;
        return std::max(kind.sent, back);
    };
    std::stable_sort(kinds.begin(), kinds.end(), [&](const auto& a, const auto& b) { return times(a) > times(b); });
    return kinds;
}

double mean_ms(const ecat::CycleTraffic& cycle) {
    return cycle.cycles == 0 ? 0 : to_seconds(cycle.last - cycle.first) * 1e3 / static_cast<double>(cycle.cycles);
}

int capture(const CaptureOptions& options) {
    if (!options.output.empty() && !options.replace && std::filesystem::exists(options.output)) {
        print_error({"capture.exists", options.output, "there is such a file already", "choose another name, or say --replace"});
        return exit_bad_file;
    }
    auto opened = ecat::InterfaceListener::open(options.nic);
    if (!opened) {
        print_error(opened.error());
        return exit_bus;
    }
    std::unique_ptr<ecat::PcapngFile> file;
    if (!options.output.empty()) {
        auto created = ecat::PcapngFile::create(options.output, {options.nic, "taktwerk bus capture", {}});
        if (!created) {
            print_error(created.error());
            return exit_bad_file;
        }
        file = std::move(*created);
    }
    watch_stop_signals();
    if (!options.json) fmt::print(stderr, "listening on {}{}\n", options.nic, options.duration_s > 0 ? "" : ", until Ctrl-C");
    SystemClock clock;
    const auto end = clock.now() + from_seconds(options.duration_s);
    ecat::BusTraffic traffic;
    std::uint64_t missed = 0;
    Result<void> written;
    while (!stop_requested() && written && (options.duration_s == 0 || clock.now() < end)) {
        const auto heard = (*opened)->next(look_for_signals);
        if (!heard) continue;
        const auto at = Instant{heard->since_1970};
        traffic.note(heard->frame, at, heard->outgoing);
        if (file) written = file->packet(heard->frame, at, heard->outgoing);
    }
    missed = (*opened)->missed();
    if (file && written) written = file->finish();
    if (options.json) print_json(traffic_json(traffic, missed));
    else fmt::print("{}", traffic_text(options.nic, traffic, missed, colours_of_output()));
    std::fflush(stdout);
    if (written) return exit_ok;
    print_error(written.error());
    return exit_bad_file;
}

}  // namespace

std::string traffic_text(const std::string& where, const ecat::BusTraffic& traffic, std::uint64_t missed, Colours colours) {
    if (traffic.frames() == 0) return fmt::format("{}: no EtherCAT frame was heard: no master works here\n", where);
    std::string out = fmt::format("{}: {}\n", where, count_text(traffic.frames(), "frame"));
    for (const auto& master : traffic.masters()) {
        out += fmt::format("\n{}\n  ", toned("master " + address_text(master.address), Tone::strong, colours));
        if (master.sent > 0) out += fmt::format("{} sent, {} came back", count_text(master.sent, "frame"), master.back);
        else out += fmt::format("{} came back; what it sends is not to be heard here", count_text(master.back, "frame"));
        if (master.damaged > 0) out += fmt::format("; {} are no whole EtherCAT frames", master.damaged);
        out += "\n";
        if (const auto& cycle = master.cycle(); cycle.cycles > 0)
            out += fmt::format("  a cycle each {:.3f} ms in the mean, {:.3f} to {:.3f} ms\n", mean_ms(cycle),
                               to_seconds(cycle.shortest) * 1e3, to_seconds(cycle.longest) * 1e3);
        using Side = TextTable::Column::Side;
        TextTable table{{{"command"}, {"address"}, {"bytes", Side::right}, {"sent", Side::right}, {"working counter (times)"}}};
        const auto kinds = by_frequency(master.datagrams);
        for (std::size_t i = 0; i < kinds.size() && i < shown_kinds; ++i)
            table.add({std::string(ecat::name(kinds[i].command)), place_text(kinds[i]), std::to_string(kinds[i].size),
                       std::to_string(kinds[i].sent), counters_text_of(kinds[i])});
        out += table.text(colours, 2);
        if (kinds.size() > shown_kinds) out += fmt::format("  and {} more kinds of datagrams\n", kinds.size() - shown_kinds);
    }
    if (traffic.others() > 0) out += fmt::format("\n{} of nobody who can be told\n", count_text(traffic.others(), "frame"));
    if (missed > 0) out += fmt::format("\n{} did not fit and are missing\n", count_text(missed, "frame"));
    return out;
}

Json traffic_json(const ecat::BusTraffic& traffic, std::uint64_t missed) {
    Json masters = Json::array();
    for (const auto& master : traffic.masters()) {
        Json kinds = Json::array();
        for (const auto& kind : by_frequency(master.datagrams)) {
            Json counters = Json::object();
            for (const auto& [counter, times] : kind.working_counters) counters[std::to_string(counter)] = times;
            kinds.push_back({{"command", ecat::name(kind.command)},
                             {"address", place_text(kind)},
                             {"bytes", kind.size},
                             {"sent", kind.sent},
                             {"working_counters", std::move(counters)}});
        }
        masters.push_back({{"address", address_text(master.address)},
                           {"sent", master.sent},
                           {"back", master.back},
                           {"damaged", master.damaged},
                           {"cycle_ms", mean_ms(master.cycle())},
                           {"cycle_min_ms", to_seconds(master.cycle().shortest) * 1e3},
                           {"cycle_max_ms", to_seconds(master.cycle().longest) * 1e3},
                           {"datagrams", std::move(kinds)},
                           {"other_datagrams", master.other_datagrams}});
    }
    return {{"frames", traffic.frames()}, {"missed", missed}, {"masters", std::move(masters)}};
}

void add_bus_capture(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("capture", "listen to a cable beside whoever works there: who speaks, and every frame into a file");
    auto options = std::make_shared<CaptureOptions>();
    sub->add_option("--nic", options->nic, "network interface")->required()->type_name("INTERFACE");
    sub->add_option("-o,--output", options->output, "write every frame to this file, for Wireshark and tshark")->type_name("FILE");
    sub->add_flag("--replace", options->replace, "write over a file that is there");
    add_duration(*sub, "--duration", options->duration_s, "how long; default: until Ctrl-C");
    sub->add_flag("--json", options->json, "what was heard as one JSON object");
    sub->callback([&action, options] { action = [options] { return capture(*options); }; });
}

}  // namespace taktwerk::apps
