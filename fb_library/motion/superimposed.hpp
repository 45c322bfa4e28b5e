#pragma once
// MC_MoveSuperimposed, MC_HaltSuperimposed: PLCopen Part 1 v2.0, 3.8, 3.9. Real-time safe.
//
// They run beside the axis' own motion: the block that commands it stays Active. An aborting command on the axis aborts both; another
// MC_MoveSuperimposed replaces only the first.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_MoveSuperimposed : CommandBlock<MC_MoveSuperimposed> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Distance = 0, VelocityDiff = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    double CoveredDistance = 0;

    static constexpr auto kind = axes::CommandKind::move_superimposed;
    static constexpr std::string_view summary = "Adds a distance to whatever the axis does, without interrupting it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(), in<&Self::Distance>("u", "signed; added on top"),
                         in<&Self::VelocityDiff>("u/s", "largest velocity of the addition, > 0; need not be reached"),
                         in<&Self::Acceleration>("u/s2", "of the addition alone; 0 = the axis' default"),
                         in<&Self::Deceleration>("u/s2", "of the addition alone; 0 = the axis' default"),
                         in<&Self::Jerk>("u/s3", "of the addition alone; 0 = the axis' default"),
                         out<&Self::Done>("", "the distance is added"), outcome<Self>(),
                         out<&Self::CoveredDistance>("u", "added since the start; stays until the next one"));
    }

    void show(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(core_.axis());
        if (view == nullptr) return;
        const auto running = view->side[static_cast<std::size_t>(axes::SideSlot::superimposed)];
        // Another one that has begun meanwhile counts for itself.
        if (core_.active() || (Done && (running == 0 || running == core_.command()))) CoveredDistance = view->superimposed_covered;
        else if (core_.running()) CoveredDistance = 0;
    }
};

struct MC_HaltSuperimposed : CommandBlock<MC_HaltSuperimposed> {
    AxisRef Axis{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::halt_superimposed;
    static constexpr std::string_view summary = "Ends every superimposed motion of the axis; what it lies upon goes on.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::Deceleration, &Self::Jerk>(),
                         out<&Self::Done>("", "the added velocity is zero"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb
