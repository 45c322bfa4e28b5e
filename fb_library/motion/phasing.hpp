#pragma once
// MC_PhasingAbsolute, MC_PhasingRelative: PLCopen Part 1 v2.0, 4.8, 4.9. MC_HaltPhasing, which the standard has not, in the form of its
// MC_HaltSuperimposed. Real-time safe.
//
// They shift the master's position as the slave sees it and run beside the coupling: its block stays Active.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

namespace detail {

/// What the view says while this command runs and when it has ended; another one that has begun meanwhile counts for itself.
[[nodiscard]] inline double phase_output(const MotionContext& ctx, const ExecuteCore& core, double last,
                                         double axes::AxisView::*value) noexcept {
    const axes::AxisView* view = ctx.view(core.axis());
    if (view == nullptr) return last;
    const auto running = view->side[static_cast<std::size_t>(axes::SideSlot::phasing)];
    const bool mine = core.active() || (core.done() && (running == 0 || running == core.command()));
    return mine ? view->*value : last;
}

}  // namespace detail

struct MC_PhasingAbsolute : CommandBlock<MC_PhasingAbsolute> {
    AxisRef Master{}, Slave{};
    bool Execute = false;
    double PhaseShift = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    double AbsolutePhaseShift = 0;

    static constexpr auto kind = axes::CommandKind::phasing_absolute;
    static constexpr std::string_view summary = "Shifts the master's position seen by the slave to an absolute value.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Master, &Self::Slave, &Self::Execute>(),
                         in<&Self::PhaseShift>("u of master", "the shift that results"),
                         in<&Self::Velocity>("u/s of master", "largest velocity of the shift; 0 = the axis' limit"),
                         in<&Self::Acceleration>("u/s2 of master", "of the shift; 0 = the axis' default"),
                         in<&Self::Deceleration>("u/s2 of master", "of the shift; 0 = the axis' default"),
                         in<&Self::Jerk>("u/s3 of master", "of the shift; 0 = the axis' default"), shared<&Self::BufferMode>(),
                         out<&Self::Done>("", "the shift is complete"), outcome<Self>(),
                         out<&Self::AbsolutePhaseShift>("u of master", "shift in effect, while Active; stays until the next one"));
    }

    void show(const MotionContext& ctx) noexcept {
        AbsolutePhaseShift = detail::phase_output(ctx, core_, AbsolutePhaseShift, &axes::AxisView::phase_shift);
    }
};

struct MC_PhasingRelative : CommandBlock<MC_PhasingRelative> {
    AxisRef Master{}, Slave{};
    bool Execute = false;
    double PhaseShift = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    double CoveredPhaseShift = 0;

    static constexpr auto kind = axes::CommandKind::phasing_relative;
    static constexpr std::string_view summary = "Shifts the master's position seen by the slave by an additional value.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Master, &Self::Slave, &Self::Execute>(),
                         in<&Self::PhaseShift>("u of master", "added to the shift there is"),
                         in<&Self::Velocity>("u/s of master", "largest velocity of the shift; 0 = the axis' limit"),
                         in<&Self::Acceleration>("u/s2 of master", "of the shift; 0 = the axis' default"),
                         in<&Self::Deceleration>("u/s2 of master", "of the shift; 0 = the axis' default"),
                         in<&Self::Jerk>("u/s3 of master", "of the shift; 0 = the axis' default"), shared<&Self::BufferMode>(),
                         out<&Self::Done>("", "the shift is complete"), outcome<Self>(),
                         out<&Self::CoveredPhaseShift>("u of master", "shifted since the start; stays until the next one"));
    }

    void show(const MotionContext& ctx) noexcept {
        CoveredPhaseShift = detail::phase_output(ctx, core_, CoveredPhaseShift, &axes::AxisView::phase_covered);
    }
};

struct MC_HaltPhasing : CommandBlock<MC_HaltPhasing> {
    AxisRef Slave{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::halt_phasing;
    static constexpr std::string_view summary = "Ends the phasing under way; the shift that is reached stays, and the coupling goes on.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Slave, &Self::Execute>(), in<&Self::Deceleration>("u/s2 of master", "0 = the axis' default"),
                         in<&Self::Jerk>("u/s3 of master", "0 = the axis' default"), out<&Self::Done>("", "the shift changes no more"),
                         outcome<Self>());
    }
};

}  // namespace taktwerk::fb
