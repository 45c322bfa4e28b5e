// Any bytes as a message on the command channel: nothing but a whole command of this version reaches the gateway, and what
// reaches the machine is in range. The fingerprint, size and stamp are put right in half of the inputs, or none would get through.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "hmi_bridge/lcm/lcm_commands.hpp"
#include "hmi_bridge/lcm/memory_bus.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    constexpr std::int64_t wall = 1'800'000'000'000'000;
    test::FakeMachine machine;
    Gateway gateway(machine);
    LcmCommandReceiver receiver(gateway, [] { return wall; });
    MemoryBus bus;
    const Channels channels("demo");
    gateway.observe(true);
    const Instant now{std::chrono::seconds{1}};

    std::vector<std::byte> message(reinterpret_cast<const std::byte*>(data) + 1, reinterpret_cast<const std::byte*>(data) + size);
    if (data[0] & 1) {
        taktwerk_lcm::command_v1_t command;
        std::memset(&command, 0, sizeof command);
        command.utime = wall;
        command.protocol_version = 1;
        std::vector<std::byte> good(static_cast<std::size_t>(command.getEncodedSize()));
        command.encode(good.data(), 0, static_cast<int>(good.size()));
        message.resize(good.size());
        std::memcpy(message.data(), good.data(), 16);           // fingerprint and stamp
        std::memcpy(message.data() + 24, good.data() + 24, 4);  // protocol version, behind the sequence
    }
    for (int round = 0; round < 2; ++round) {  // a repeated message is executed once
        receiver.receive(message, now);
        gateway.step(now);
        while (const auto reply = gateway.next_reply()) receiver.deliver(*reply, bus, channels);
        if (machine.submitted.size() > 1) std::abort();
        if (round == 0 && !machine.submitted.empty()) machine.answer(runtime::Answer::accepted);
    }
    for (const auto& command : machine.submitted) {
        const bool moves = command.action == runtime::OperatorAction::jog || command.action == runtime::OperatorAction::move_absolute;
        if (moves && (!std::isfinite(command.value) || command.axis >= machine.its_layout.axes.size())) std::abort();
        if (command.owner != axes::Owner::operator_panel || command.mode > runtime::Mode::automatic || command.expires < now) std::abort();
    }
    return 0;
}
