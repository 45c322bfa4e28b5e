#pragma once
// MC_SetOverride: PLCopen Part 1 v2.0, 3.18. Real-time safe.

#include <string_view>

#include "fb_library/motion/enable_core.hpp"
#include "fb_library/motion/setting_follower.hpp"

namespace taktwerk::fb {

/// Writes the factors while Enable is TRUE; the last ones stay when it falls. Factors that are not allowed change nothing.
struct MC_SetOverride {
    using Self = MC_SetOverride;
    AxisRef Axis{};
    bool Enable = false;
    double VelFactor = 1, AccFactor = 1, JerkFactor = 1;

    bool Enabled = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    EnableCore core{};
    SettingFollower factors{};

    static constexpr std::string_view summary = "Scales velocity, acceleration and jerk of everything the axis does.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), in<&Self::VelFactor>("1", "0 to 1; 0 stops without Standstill; default 1"),
                         in<&Self::AccFactor>("1", "above 0 to 1, on acceleration and deceleration; default 1"),
                         in<&Self::JerkFactor>("1", "above 0 to 1; default 1"), out<&Self::Enabled>("", "the axis has these factors"),
                         outcome<Self>());
    }

    void operator()(const MotionContext& ctx) noexcept {
        if (core.begin(Enable) != EnableCore::Edge::none) factors = {};
        if (core.working()) core.took(write(ctx));
        core.publish(*this);
    }
    void warm_start(Instant) noexcept { factors = {}; }

private:
    [[nodiscard]] Reading write(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(Axis);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_axis);
        const axes::Override wanted{VelFactor, AccFactor, JerkFactor};
        if (view->override_factors == wanted) return Reading::valid();
        return factors.ask(ctx, Axis, wanted);
    }
};

}  // namespace taktwerk::fb
