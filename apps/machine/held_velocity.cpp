#include "apps/machine/held_velocity.hpp"

#include <fmt/format.h>

namespace taktwerk::apps {

std::string held_velocity(const nlohmann::ordered_json& axis, const std::string& mode) {
    const auto limiter = axis.at("velocity_limiter").get<std::string>();
    if (limiter == "manual_speed" && mode == "setup")
        return "; slower than asked: set-up mode holds the velocity down (manual.setup_velocity of the axis)";
    if (limiter == "manual_speed") return "; slower than asked: manual mode holds the velocity down (manual.fast of the axis)";
    if (limiter == "axis_limit") return "; slower than asked: the axis' limit holds the velocity down (limits.velocity)";
    if (limiter == "override_factor")
        return fmt::format("; slower than asked: the override is {:g} % (MC_SetOverride)", 100 * axis.at("override").get<double>());
    return "";
}

}  // namespace taktwerk::apps
