// Any bytes as lines of the command socket: each line gets at most one answer line that is JSON, and whatever reaches the machine
// is finite and names what the machine has.
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

/// Some rows for the scope: its words are numbers, infinite ones and none among them.
runtime::SignalRing& rows() {
    using runtime::SignalGroup, runtime::SignalKind, runtime::SignalCell;
    static runtime::SignalRing ring{
        {{"time_s", "s", SignalKind::real, SignalGroup::machine, "", "", "", {0, 0, 64, SignalCell::Coding::integer, 1e9}},
         {"x.set_position", "mm", SignalKind::real, SignalGroup::axis, "x", "", "", {1, 0, 64, SignalCell::Coding::real, 1}},
         {"x.state", "", SignalKind::state, SignalGroup::axis, "x", "", "", {2, 3, 5, SignalCell::Coding::natural, 1}}},
        3,
        50,
        std::chrono::milliseconds{1}};
    for (std::uint64_t cycle = 1; ring.span().last < 80; ++cycle) {
        auto row = ring.begin(cycle);
        row.put(Duration{cycle * 1'000'000});
        row.put(cycle % 7 == 0 ? std::nan("") : cycle % 5 == 0 ? HUGE_VAL : static_cast<double>(cycle));
        row.put(cycle * 977);
        ring.commit();
    }
    return ring;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // What is longer is no deeper, only slower: a few lines show what one does to the next.
    if (size > 1024) return -1;
    test::FakeMachine machine;
    machine.rows = &rows();
    Gateway gateway(machine);
    JsonRequests requests(gateway, machine, [] { return std::int64_t{1'800'000'000'000'000}; });
    AlarmHistory history(
        "/nowhere/alarms.sqlite", 10, [&](const AlarmFact& fact) { return machine.describe(fact); }, nullptr);
    requests.set_history(&history);
    gateway.observe(true);
    requests.observe(&machine.snapshot);
    runtime::CycleHistograms cycle;
    axes::DriveProfile profile;
    profile.parameters.resize(2);
    machine.its_times.cycle = &cycle;
    machine.drives = {{nullptr, &profile}};
    const auto log = std::make_shared<LogTail>();
    log->add("a line\n\xff");
    requests.set_log(log);
    requests.on_open(1, {});
    Instant now{std::chrono::seconds{1}};

    std::string_view rest(reinterpret_cast<const char*>(data), size);
    for (int lines = 0; lines < 8 && !rest.empty(); ++lines) {
        const auto end = std::min(rest.find('\n'), rest.size());
        const auto before = machine.submitted.size();
        requests.on_line(1, rest.substr(0, end), now);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (machine.submitted.size() > before + 1) std::abort();
        if (machine.submitted.size() > before) {
            const auto& command = machine.submitted.back();
            if (!std::isfinite(command.value) || !std::isfinite(command.value2)) std::abort();
            if (command.axis != 0xFFFF && command.axis >= machine.its_layout.axes.size()) std::abort();
            const bool forces = command.action == runtime::OperatorAction::force || command.action == runtime::OperatorAction::unforce;
            const auto points = command.flag ? machine.its_layout.outputs.size() : machine.its_layout.inputs.size();
            if (forces && command.index >= points) std::abort();
            // Letting go is never too late.
            const bool lets_go = command.action == runtime::OperatorAction::set_value && command.value == 0;
            if (!lets_go && command.expires <= now - std::chrono::nanoseconds{1}) std::abort();
            if (command.action == runtime::OperatorAction::set_value &&
                (command.index >= machine.its_layout.variables.size() || !machine.its_layout.variables[command.index].takes(command.value)))
                std::abort();
            machine.answer(runtime::Answer::accepted);
        }
        now += std::chrono::milliseconds{5};
        gateway.step(now);
        requests.step(now);
        while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
        history.work(now);
        requests.step(now);
        int answers = 0;
        while (const auto line = requests.next_line()) {
            if (++answers > 1 || !nlohmann::json::accept(line->text) || line->text.find('\n') != std::string::npos) std::abort();
        }
    }
    requests.on_close(1);
    return 0;
}
