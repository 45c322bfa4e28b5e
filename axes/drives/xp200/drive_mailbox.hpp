#pragma once
// What crosses between the cycle and the schedule of the line, each way as the newest value (core/latest_value.hpp). Plain data.

#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::xp200 {

/// Cycle to line: what the drive shall do. In the drive's own units; `sequence` grows with every change.
struct Wish {
    PowerRequest power = PowerRequest::off;
    bool reset = false;
    bool halt = false;  ///< ramp to rest, whatever `speed` says
    bool torque_mode = false;
    std::int16_t speed = 0;               ///< r/min
    std::int16_t torque = 0;              ///< % of rated
    std::int16_t speed_limit = 0;         ///< r/min, torque mode; 0 = leave
    std::int16_t up_ms = 0, down_ms = 0;  ///< ms for 1000 r/min; 0 = leave
    /// The newest session of the line in which the cycle has seen the drive without power: only in that one it may be enabled. An axis that
    /// still wants power from before a silence does not switch the motor on by that.
    std::uint16_t session = 0;
    std::uint16_t latch = 0;       ///< grows each time the index pulse is waited for anew; its lowest bit: it is waited for
    std::uint16_t power_turn = 0;  ///< grows each time power is wanted or not wanted any more; odd: it is wanted
    std::uint32_t sequence = 0;

    [[nodiscard]] bool asks_the_same(const Wish& other) const noexcept {
        return power == other.power && reset == other.reset && halt == other.halt && torque_mode == other.torque_mode &&
               speed == other.speed && torque == other.torque && speed_limit == other.speed_limit && up_ms == other.up_ms &&
               down_ms == other.down_ms && session == other.session && latch == other.latch && power_turn == other.power_turn;
    }
};

/// Line to cycle: what the drive said last.
struct Sample {
    std::uint32_t revision = 0;  ///< grows with each answer
    std::uint32_t number = 0;    ///< grows with each new position
    bool online = false;
    bool saving = false;  ///< it stores parameters and is silent meanwhile
    Instant heard{};      ///< newest answer
    Instant sampled{};    ///< when the position was taken
    std::int64_t position = 0;
    double velocity = 0;  ///< counts/s
    double torque = 0;    ///< fraction of rated
    std::uint16_t alarm = 0;
    bool running = false;        ///< RUN: energised, by whatever order
    std::uint16_t power_of = 0;  ///< the Wish::power_turn that it has its power by; 0: none of them
    bool torque_mode = false;
    bool setup_refused = false;
    bool home = false, negative_limit = false, positive_limit = false;
    std::uint16_t inputs = 0;   ///< conducting terminals, bit 0 = DI1
    std::uint16_t outputs = 0;  ///< conducting terminals, bit 0 = DO1
    std::uint16_t epoch = 0;    ///< grows when the position's zero may be another
    std::uint16_t session = 0;  ///< grows each time the line was opened
    bool released = false;      ///< it has been without power in this session: what ran before the silence is over
    std::uint16_t latch = 0;    ///< the wish that the following belong to
    bool latch_armed = false, latched = false;
    bool no_index = false;           ///< nobody can say where the index pulse is: the motor has not made a full turn yet
    std::int64_t latch_at = 0;       ///< counts
    std::uint32_t acknowledged = 0;  ///< all of the wish with this sequence is done
};

}  // namespace taktwerk::axes::xp200
