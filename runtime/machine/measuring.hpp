#pragma once
// Measuring an axis by hand: one at a time, by the lease of a jog. Feeds the axis the set-points of axes/excitation/ cycle by cycle and keeps what
// it answers for the service side. The axis stays master of its limits: what it does not take ends the measurement. Real-time safe.

#include <cstdint>

#include "axes/excitation/excitation.hpp"
#include "axes/excitation/measure_sample.hpp"
#include "core/spsc_ring.hpp"
#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/measure_state.hpp"

namespace taktwerk::runtime {

class Measuring {
public:
    static constexpr std::size_t samples_kept = 4096;  ///< until the service side fetches them

    Measuring(MachineBody& body, HandMotion& hands) : body_(body), hands_(hands), samples_(samples_kept) {}

    // --- service side: one reader ----------------------------------------------------------------------------------------------------
    bool next_sample(axes::MeasureSample& out) noexcept { return samples_.try_pop(out); }

    // --- cycle -------------------------------------------------------------------------------------------------------------------------
    /// As OperatorAction::measure.
    Verdict command(const OperatorCommand& command, std::size_t axis) noexcept;
    /// Before the axes plan: the next set-point, or the end.
    void step() noexcept;
    /// After they have planned.
    void keep() noexcept;
    [[nodiscard]] const MeasureState& state() const noexcept { return state_; }

private:
    Verdict press(const OperatorCommand& command, std::size_t axis) noexcept;
    void end(MeasureEnd how, axes::ErrorId error = axes::ErrorId::none) noexcept;
    [[nodiscard]] axes::ErrorId feed(const axes::MotionState& next) noexcept;

    MachineBody& body_;
    HandMotion& hands_;
    SpscRing<axes::MeasureSample> samples_;
    axes::Excitation excitation_;
    MeasureState state_;
    axes::CommandId command_ = 0;
    axes::Owner owner_ = axes::Owner::none;
    std::uint32_t client_ = 0;
    Instant renewed_{};
    bool begins_ = false;   // pressed in this cycle
    double override_ = 1;   // of the velocity, as it began
    double unwrapped_ = 0;  // u: so many moduli more the axis calls the same place by
};

}  // namespace taktwerk::runtime
