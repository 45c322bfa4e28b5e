#pragma once
// How much torque the drive may give in each direction: what is configured, and what MC_SetTorqueLimit made of it. A limit that was set holds until the
// next one, in every state and without power too; it never passes what is configured.

#include <algorithm>
#include <limits>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

/// Rated torques, magnitudes, in the axis' sense. Infinity: what the drive has.
struct TorqueRange {
    double positive = std::numeric_limits<double>::infinity(), negative = std::numeric_limits<double>::infinity();
    friend bool operator==(const TorqueRange&, const TorqueRange&) = default;
};

class TorqueBounds {
public:
    TorqueBounds(AxisBody& body, ModeState& modes) noexcept;

    [[nodiscard]] Submitted submit(const AxisCommand& command) noexcept;
    /// What became of the one that was given. True: it is over.
    [[nodiscard]] bool watch(const DriveFeedback& feedback) noexcept {
        return id_ != 0 && told_ && feedback.fresh && feedback.torque_limits != TorqueLimitAnswer::pending &&
               end(feedback.torque_limits == TorqueLimitAnswer::refused);
    }
    /// That it was given to the drive.
    void tell() noexcept { told_ = true; }

    /// Something bounds it.
    [[nodiscard]] bool used() const noexcept { return used_; }
    [[nodiscard]] const TorqueRange& range() const noexcept { return range_; }
    /// The MC_SetTorqueLimit under way; 0: none.
    [[nodiscard]] CommandId id() const noexcept { return id_; }

private:
    [[nodiscard]] ErrorId refuse(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool end(bool refused) noexcept;
    void take(const TorqueRange& range) noexcept;

    AxisBody& body_;
    ModeState& modes_;
    TorqueRange most_;    // as configured
    TorqueRange range_;   // in force
    TorqueRange former_;  // before the one under way
    CommandId id_ = 0;
    bool told_ = false, used_ = false;
};

}  // namespace taktwerk::axes
