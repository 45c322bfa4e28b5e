#pragma once
// Locks the master's cycle to the reference clock: says each cycle by how much the next period has to be longer or shorter, so
// that frames leave at one phase of the reference's time and so at one distance before SYNC0. Pure, integer, deterministic,
// real-time safe; one thread.
//
// What it is given is the phase error of the instant at which a frame is sent: ReferenceClock filters the samples, rejects
// outliers and bridges gaps, so that the error is known in each cycle, also while frames are lost or after a stall: send
// instants are known, only the reference has to be extrapolated. The correction is
//
//     - drift of the reference in a period - proportional * error
//
// The drift follows the quartz (an estimate, bounded by its own limit: nothing that could wind up), the rest takes a sixteenth of
// the error out each cycle. Both together are limited in size and in change: whatever the reference does, the period stays
// within `largest_correction` of the nominal one.

#include <cstdint>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::ecat {

enum class DcLock : std::uint8_t {
    none,       ///< no reference clock, or its time is not known yet
    acquiring,  ///< the phase error is being taken out
    locked,
    coasting,  ///< locked, but without samples: on with the speed learned last
    lost,      ///< without samples for so long that the phase is a guess
};
[[nodiscard]] std::string_view name(DcLock lock) noexcept;

/// Fractions of the bus cycle; in brackets what they are for a cycle of 1 ms.
struct ServoSettings {
    std::int64_t proportional = 16;                 ///< 1/16 of the error a cycle
    std::int64_t largest_correction = 100;          ///< clamp: a hundredth of the cycle [10 us]: half a cycle is made up in 50 cycles
    std::int64_t slew = 1000;                       ///< largest change of the correction from cycle to cycle [1 us]
    std::int64_t lock_window = 200;                 ///< locked when the error was inside it [5 us] ...
    std::uint32_t lock_cycles = 32;                 ///< ... for so many cycles
    std::int64_t unlock_window = 25;                ///< not any more when it was outside this [40 us] ...
    std::uint32_t unlock_cycles = 8;                ///< ... for so many
    std::uint32_t coast_after = 8;                  ///< cycles without a sample until it says so
    Duration lost_after = std::chrono::seconds{2};  ///< 1 ppm of error in the speed is 2 us then
};

/// What the servo sees of one cycle.
struct ServoSample {
    std::int64_t phase_error = 0;  ///< ns: how much later than it should the frame leaves, in system time; -cycle/2 .. cycle/2
    std::int64_t drift = 0;        ///< ns / 65536 that the reference gains on the machine in a cycle (ReferenceClock::drift_in)
    bool fresh = false;            ///< a sample of the reference came since the last call
};

class CycleServo {
public:
    explicit CycleServo(Duration cycle, const ServoSettings& settings = {}) noexcept;

    /// Once a cycle. Returns what has to be added to the next period.
    Duration step(const ServoSample& sample) noexcept;
    /// Instead of step() while the system time or the phase it should have is not known. Returns 0.
    Duration wait() noexcept;

    [[nodiscard]] DcLock lock() const noexcept { return lock_; }
    /// Largest |correction|.
    [[nodiscard]] Duration limit() const noexcept { return Duration{limit_}; }
    [[nodiscard]] Duration slew() const noexcept { return Duration{slew_}; }

private:
    void judge(const ServoSample& sample) noexcept;

    Duration cycle_;
    ServoSettings settings_;
    std::int64_t limit_, slew_;    // ns
    std::int64_t correction_ = 0;  // ns, of the last cycle
    std::int64_t part_ = 0;        // ns / 65536 that were not given out yet
    std::uint32_t inside_ = 0, outside_ = 0, without_sample_ = 0;
    bool held_ = false;  // locked, when samples come again
    DcLock lock_ = DcLock::none;
};

}  // namespace taktwerk::ecat
