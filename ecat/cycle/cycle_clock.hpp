#pragma once
// The clock half of the cycle: what is asked of the reference clock in each first frame, what the answer is worth, the phase of
// the master's own sending, and the servo. Arithmetic: ecat/dc/. Real-time safe; belongs to the cycle's thread.
//
// The first datagram of each cycle is a FRMW of 0910h: the reference puts its time in, everybody behind it takes it out. While
// the reference does not answer as it should it is a FPRD instead: its time is read and given to nobody. So the clocks of the
// slaves coast by themselves, rather than follow a master's guess or a reference that was just switched on.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/time.hpp"
#include "ecat/cycle/cycle_link.hpp"
#include "ecat/dc/cycle_servo.hpp"
#include "ecat/dc/reference_clock.hpp"
#include "ecat/wire/commands.hpp"

namespace taktwerk::ecat {

/// As clocks and links keep an instant: ns of the host's steady clock.
[[nodiscard]] constexpr std::int64_t nanoseconds(Instant t) noexcept { return t.time_since_epoch().count(); }

class CycleClock {
public:
    /// What a FRMW carries towards the reference is its time as the master knows it, less this (cycle_clock.cpp says why).
    static constexpr Duration mark = std::chrono::microseconds{10};
    explicit CycleClock(Duration cycle) noexcept : cycle_(cycle), servo_(cycle) {}

    /// Once a cycle, by send(): the phase of sending, then the correction of the next period.
    void steer(Instant now, CycleLink* link) noexcept;

    /// The clock datagram of the frame that leaves at `now`: to whoever serves as reference, `first` unless the link says otherwise.
    struct Request {
        Command command = Command::FPRD;
        std::uint16_t station = 0;
        std::int64_t behind = 0;  ///< ns: propagation delay from the first reference to this one
        std::int64_t data = 0;
    };
    [[nodiscard]] Request request(Instant now, std::uint16_t first) noexcept;
    /// It came back. `sent`: when its frame left.
    void answer(std::span<const std::byte> data, std::uint16_t wkc, Instant sent) noexcept;
    void no_answer() noexcept;

    /// System time at which the last frame that brought a sample passed the first reference; nothing when the last one did not.
    [[nodiscard]] std::optional<std::int64_t> passed_reference() const noexcept { return passed_; }
    [[nodiscard]] const ReferenceClock& reference() const noexcept { return reference_; }
    [[nodiscard]] bool known() const noexcept { return reference_.known(); }
    [[nodiscard]] std::optional<std::int64_t> offset() const noexcept { return reference_.offset(); }
    [[nodiscard]] std::int64_t offset_at(Instant t) const noexcept { return reference_.offset_at(t); }
    [[nodiscard]] DcLock lock() const noexcept { return servo_.lock(); }
    /// To be added to the period that begins now.
    [[nodiscard]] Duration correction() const noexcept { return correction_; }
    /// ns; how much later than it should the last frame left, in system time. 0 while the phase is not fixed.
    [[nodiscard]] std::int64_t phase_error() const noexcept { return phase_error_; }

private:
    Duration cycle_;
    CycleLink* link_ = nullptr;  ///< of the last steer()
    ReferenceClock reference_;
    CycleServo servo_;
    std::optional<std::int64_t> phase_;  ///< of send(), modulo the cycle, machine time, smoothed
    std::int64_t phase_error_ = 0;
    Duration correction_{};
    Request asked_;
    std::uint32_t missing_ = 0;  ///< cycles without a sample
    std::optional<std::int64_t> passed_;
    bool trusted_ = false;  ///< the last answer was the reference's and plausible
    bool fresh_ = false;    ///< ... since the last steer()
};

}  // namespace taktwerk::ecat
