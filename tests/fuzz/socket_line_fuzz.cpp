// Any bytes as lines of the command socket: each line gets at most one answer line that is JSON, and whatever reaches the machine
// is finite and names what the machine has.
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // What is longer is no deeper, only slower: a few lines show what one does to the next.
    if (size > 1024) return -1;
    test::FakeMachine machine;
    Gateway gateway(machine);
    JsonRequests requests(gateway, machine, [] { return std::int64_t{1'800'000'000'000'000}; });
    gateway.observe(true);
    requests.observe(&machine.snapshot);
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
        while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
        int answers = 0;
        while (const auto line = requests.next_line()) {
            if (++answers > 1 || !nlohmann::json::accept(line->text) || line->text.find('\n') != std::string::npos) std::abort();
        }
    }
    requests.on_close(1);
    return 0;
}
