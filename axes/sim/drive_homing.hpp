#pragma once
// Homing by the drive: the rising edge of control word bit 4 starts it, its fall or halt (bit 8) break it off, its end gives the drive a
// new zero. After a halt a new edge is needed: CiA 402 calls the procedure interrupted then, no manual says how it would go on.

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/homing_run.hpp"

namespace taktwerk::axes::sim {

class DriveHoming {
public:
    /// How a run has ended, in the step in which it did.
    enum class News : std::uint8_t { none, attained, failed };

    /// This exchange asks for a run; false: it does not, and one that is under way may have been broken off.
    bool asked(const AxisInputs& in) noexcept;
    /// By the method and with the settings of this exchange; a method that the drive does not document fails.
    void start(const AxisInputs& in, const DriveProfile& profile, const HomingView& view) noexcept;
    /// Each exchange ends with the level of bit 4.
    void exchanged(const AxisInputs& in) noexcept { bit_ = (in.control & 0x10u) != 0; }
    /// The motor has no power; or another mode is chosen, which forgets how the last run ended as well.
    void cancel() noexcept { run_.cancel(); }
    void forget() noexcept;
    News step(double dt, const HomingView& view) noexcept;

    [[nodiscard]] bool idle() const noexcept { return run_.state() == HomingRun::State::idle; }
    [[nodiscard]] bool busy() const noexcept { return run_.busy(); }
    /// It runs against a block: the demanded position must not run ahead of the motor.
    [[nodiscard]] bool presses() const noexcept { return run_.presses(); }
    [[nodiscard]] double velocity() const noexcept { return run_.velocity(); }
    [[nodiscard]] HomingRun::Failure failure() const noexcept { return run_.failure(); }
    /// Bits 12 and 13 of the status word.
    [[nodiscard]] bool attained() const noexcept { return attained_; }
    [[nodiscard]] bool failed() const noexcept { return failed_; }
    /// Of the drive's zero, by the run that attained. SV33-E table 3-75 (60E6h).
    [[nodiscard]] double shift(double zero) const noexcept;

private:
    HomingRun run_;
    bool attained_ = false, failed_ = false, bit_ = false;
    std::int64_t offset_ = 0, position_method_ = 0;  ///< 607Ch, 60E6h
};

}  // namespace taktwerk::axes::sim
