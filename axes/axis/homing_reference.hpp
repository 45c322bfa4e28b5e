#pragma once
// The reference of a homing: whether there is one, its level, its latch, and the coordinate it gives.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/command.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class AxisProbes;

class HomingReference {
public:
    HomingReference(AxisBody& body, const Measured& measured, HomingRuns& runs, const AxisProbes& probes) noexcept
        : body_(body), measured_(measured), runs_(runs), probes_(probes) {}

    [[nodiscard]] ErrorId refuse(const TriggerRef& reference) const noexcept;
    [[nodiscard]] bool level(const TriggerRef& reference) const noexcept;
    void arm(const TriggerRef& reference, bool continuous) noexcept;
    /// The motor's place `at` is the load's `coordinate`, whatever compensation adds on the way between them.
    void set_coordinate(std::int64_t at, double coordinate) noexcept;

    /// A latch knows its edge, not a level.
    [[nodiscard]] static bool latched_by_drive(const TriggerRef& reference) noexcept {
        return reference.source != TriggerSource::home_switch && reference.source != TriggerSource::input;
    }

private:
    AxisBody& body_;
    const Measured& measured_;
    HomingRuns& runs_;
    const AxisProbes& probes_;
};

}  // namespace taktwerk::axes
