#pragma once
// Alarms: a fault is a fact inside the cycle (an id, a source, two numbers); its words and its reaction stand in one
// constexpr table per floor. That table is the only place that decides reactions.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace taktwerk {

/// What the machine does about a condition. Ordered: the strongest active one wins.
enum class Reaction : std::uint8_t {
    none,          ///< information only
    warn,          ///< shown, nothing stops
    stop_axis,     ///< the axis stops along its own deceleration, state ErrorStop
    stop_machine,  ///< every axis stops along its own deceleration, programs are told
    power_off,     ///< every axis stops, then power goes off (at once where the drive already fell)
};

/// How a condition goes away.
enum class ResetRule : std::uint8_t {
    self_clearing,  ///< gone when the condition is gone
    acknowledge,    ///< needs an acknowledgement after the condition is gone
    reset,          ///< needs MC_Reset (or `taktwerk reset`) after the condition is gone
    restart,        ///< needs a power cycle of the device or a restart of the runtime
};

/// Floors own ranges: core 0x0xxx, ecat 0x1xxx, modbus 0x2xxx, axes 0x3xxx, blocks 0x4xxx, programs 0x5xxx, runtime 0x6xxx, hmi 0x7xxx.
using AlarmId = std::uint16_t;

struct AlarmInfo {
    AlarmId id;
    std::string_view name;     ///< stable, snake_case: "following_error"
    std::string_view english;  ///< one sentence; {a} and {b} stand for the two numbers
    std::string_view chinese;
    std::string_view cause;
    std::string_view remedy;
    ResetRule reset;
    Reaction reaction;  ///< while the master is alive
    /// What the drive does alone when the master is gone; empty where the condition cannot coincide with that.
    std::string_view master_gone;
};

enum class AlarmSource : std::uint8_t { machine, bus, slave, axis, program, task, io, hmi };

/// An alarm as the cycle raises it: a fact, without text. Trivially copyable.
struct AlarmFact {
    AlarmId id = 0;
    AlarmSource source = AlarmSource::machine;
    std::uint16_t index = 0;  ///< which slave, axis, task, ... ; 0-based
    double a = 0, b = 0;      ///< the two numbers of the text
};

/// The entry of `id` in a table, or nullptr. Linear: for use outside the cycle and at arm time.
[[nodiscard]] constexpr const AlarmInfo* find_alarm(std::span<const AlarmInfo> table, AlarmId id) noexcept {
    for (const auto& info : table)
        if (info.id == id) return &info;
    return nullptr;
}

}  // namespace taktwerk
