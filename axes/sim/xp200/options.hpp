#pragma once
// What the XP200's manual leaves open or says twice, and how the simulated one does it. The defaults are those a careful host must cope with.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

/// A register bit of an input or output that is conducting, which is ON in positive logic (9.5 says "1 = high level", 4.2.1 "low-active").
enum class ConductingReads : std::uint8_t { zero, one };

/// What it answers while it saves (9.6.6 says only: wait 5 s).
enum class WhileSaving : std::uint8_t { silent, says_busy };

struct Options {
    Duration turnaround = std::chrono::milliseconds{5};   ///< not stated
    Duration start_up = std::chrono::milliseconds{1500};  ///< mains on to SRDY (4.7.1); the port answers from then on
    Duration saving = std::chrono::seconds{5};            ///< 9.6.6
    WhileSaving while_saving = WhileSaving::silent;
    ConductingReads inputs = ConductingReads::zero, outputs = ConductingReads::zero;
    std::uint8_t highest_station = 247;          ///< 9.2, 9.3; 9.3 also prints 32
    std::uint16_t words_written = 10;            ///< 9.6.4, note; the table there prints 122
    double overspeed = 1.2;                      ///< alarm 1 beyond this many times Pr075; 6.1 gives no number
    Duration stalled = std::chrono::seconds{2};  ///< alarm 6: torque at its limit and standstill for so long; 6.1 gives no time
    double overload = 1.1;                       ///< alarm 13: heat of the motor beyond that of this many rated torques; 6.1 gives no curve
    Duration heat = std::chrono::seconds{20};    ///< time constant of that heat
    bool brake = false;                          ///< a holding brake hangs on BRK
};

}  // namespace taktwerk::axes::sim::xp200
