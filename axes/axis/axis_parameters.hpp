#pragma once
// What is written to an axis beside motion: its parameters and the outputs of its drive. Both live in the view, where everybody reads them.

#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/axis/mode_state.hpp"
#include "axes/axis/parameters.hpp"

namespace taktwerk::axes {

class AxisParameters {
public:
    AxisParameters(AxisBody& body, AxisMotion& motion, const ModeState& modes, AxisView& view) noexcept
        : body_(body), motion_(motion), modes_(modes), view_(view) {}

    /// From the configuration, once.
    void store() noexcept;
    /// The stored values become those that hold.
    void use() noexcept;
    ErrorId write(const WriteParameter& wanted) noexcept;
    ErrorId write_output(const WriteOutput& wanted) noexcept;

    [[nodiscard]] std::uint32_t output_mask() const noexcept { return output_mask_; }

private:
    [[nodiscard]] bool beyond_reach(double edge, bool positive) const noexcept;
    [[nodiscard]] bool narrows(const WriteParameter& wanted) const noexcept;
    [[nodiscard]] ErrorId refuse_now(const WriteParameter& wanted) const noexcept;

    AxisBody& body_;
    AxisMotion& motion_;
    const ModeState& modes_;
    AxisView& view_;

    std::uint32_t output_mask_ = 0;  // outputs of the drive that were ever written
};

}  // namespace taktwerk::axes
