#pragma once
// Commands from people: fixed size, validated by the gateway, carried by one recorded inbox into the cycle, answered from it.

#include <cstdint>
#include <type_traits>

#include "axes/axis/types.hpp"
#include "core/fixed_text.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

enum class OperatorAction : std::uint8_t {
    none,
    take_control, release_control,   ///< authority over `axis` (0xFFFF = all)
    set_mode,                        ///< mode
    power,                           ///< axis; flag = on
    home,                            ///< axis
    jog,                             ///< axis; value = velocity u/s, signed; a fresh one each 50 ms renews the lease; 0 stops
    move_absolute,                   ///< axis; value = position u, value2 = velocity u/s (manual move to a position)
    stop,                            ///< axis (0xFFFF = all): stop along the ramp; always allowed
    reset,                           ///< axis (0xFFFF = all and machine)
    program_start, program_stop, program_reset,  ///< index = program
    set_parameter,                   ///< index = parameter; value
    set_output,                      ///< index = output point; value; only while no program runs
    acknowledge_alarms,
    shutdown,                        ///< stop axes, power off, end
};

/// One command. Trivially copyable: goes through a ring.
struct OperatorCommand {
    OperatorAction action = OperatorAction::none;
    axes::Owner owner = axes::Owner::operator_panel;
    Mode mode = Mode::manual;
    bool flag = false;
    std::uint16_t axis = 0xFFFF;
    std::uint16_t index = 0xFFFF;
    double value = 0, value2 = 0;
    std::uint32_t client = 0;        ///< who; answers go there
    std::uint64_t sequence = 0;      ///< of the client; a repeated one is answered again, not executed again
    Instant expires{};               ///< older than this at drain: refused as stale
};
static_assert(std::is_trivially_copyable_v<OperatorCommand>);

/// Stable answers (exit codes and LCM acknowledgements derive from them).
enum class Answer : std::uint8_t {
    accepted, unknown_name, bad_value, stale, no_control, wrong_mode, refused_by_axis, not_possible_now, queue_full, duplicate,
};

struct CommandAnswer {
    std::uint32_t client = 0;
    std::uint64_t sequence = 0;
    Answer answer = Answer::accepted;
    axes::ErrorId error = axes::ErrorId::none;   ///< refused_by_axis: why
    axes::Owner owner = axes::Owner::none;       ///< no_control: who has it
};
static_assert(std::is_trivially_copyable_v<CommandAnswer>);

}  // namespace taktwerk::runtime
