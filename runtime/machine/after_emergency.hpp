#pragma once
// Axes that an emergency stop left in ErrorStop: whoever lets a program go on before they are reset would leave the motion to the reset.

#include <algorithm>
#include <span>

#include "axes/axis/alarms.hpp"
#include "axes/axis/axis.hpp"

namespace taktwerk::runtime {

[[nodiscard]] inline bool stopped_by_emergency(const axes::Axis& axis) noexcept {
    if (axis.view().state != axes::AxisState::ErrorStop) return false;
    const auto facts = axis.active_alarms();
    return std::any_of(facts.begin(), facts.end(),
                       [](const AlarmFact& fact) { return fact.id == axes::id(axes::AxisAlarm::emergency_stop); });
}

[[nodiscard]] inline bool axes_to_reset(std::span<const axes::Axis> axes) noexcept {
    return std::any_of(axes.begin(), axes.end(), [](const axes::Axis& axis) { return stopped_by_emergency(axis); });
}

}  // namespace taktwerk::runtime
