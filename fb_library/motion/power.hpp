#pragma once
// MC_Power: PLCopen Part 1 v2.0, 3.1. Real-time safe.
//
//   * Status is the real state of the power stage, also while Enable is FALSE or another party powers the axis.
//   * The wish is renewed in each call while Enable is TRUE and taken back once when it falls; a block that never had Enable
//     TRUE wishes nothing, so an operator may power an axis whose program is idle.
//   * The axis is taken at the rising edge of Enable; another handle counts from the next edge.
//   * EnablePositive and EnableNegative are TRUE by default: an unconnected pin forbids nothing.
//   * While another party owns the axis (an operator in manual mode) a block with Enable TRUE shows owned_by_other, and Valid comes
//     back with the control.
//   * A second MC_Power on the axis shows Error with power_conflict; the axis decides which one.

#include <array>
#include <string_view>

#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

struct MC_Power {
    AxisRef Axis{};
    bool Enable = false;
    bool EnablePositive = true, EnableNegative = true;

    bool Status = false;
    bool Valid = false;
    bool Error = false;
    ErrorId ErrorID{};

    EnableCore core{};
    AxisRef powered_axis{};  ///< axis of the last rising edge; not a pin

    static constexpr std::string_view summary = "Switches the axis' power stage and permits its directions.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Enable>("", "power stage on while TRUE"),
            in<&Self::EnablePositive>("", "permits positive motion while Enable is TRUE; default TRUE"),
            in<&Self::EnableNegative>("", "permits negative motion while Enable is TRUE; default TRUE"),
            out<&Self::Status>("", "power stage is on and motion is accepted"),
            out<&Self::Valid>("", "Enable is TRUE and the axis takes the wish"),
            out<&Self::Error>("", "the axis refuses this block"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    void operator()(const MotionContext& ctx) noexcept {
        const auto edge = core.begin(Enable);
        if (edge == EnableCore::Edge::rising) powered_axis = Axis;
        const AxisRef axis = Enable || edge == EnableCore::Edge::falling ? powered_axis : Axis;
        const axes::AxisView* view = ctx.view(axis);
        if (view == nullptr) {
            if (Enable) core.took(Reading::unless(ErrorId::invalid_axis));
        } else if (Enable) {
            const auto error = ctx.requests->power(axis, true, EnablePositive, EnableNegative, ctx.owner);
            if (error == ErrorId::none && core.valid()) {  // as in the call before
                Status = view->powered;
                return;
            }
            core.took(Reading::unless(error));
        } else if (edge == EnableCore::Edge::falling) {
            ctx.requests->power(axis, false, false, false, ctx.owner);
        }
        Status = view != nullptr && view->powered;
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {}
};

}  // namespace taktwerk::fb
