#include "runtime/measure_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "axes/axis/direction_limits.hpp"

namespace taktwerk::runtime {

std::string_view name(MeasureEnd end) noexcept {
    static constexpr std::array<std::string_view, 6> words{"none", "done", "stopped", "lease", "alarm", "refused"};
    const auto i = static_cast<std::size_t>(end);
    return i < words.size() ? words[i] : words[0];
}

double velocity_override(const axes::AxisView& view) noexcept {
    return std::clamp(view.override_factors.velocity * view.operators_override, 0.0, 1.0);
}

axes::ExcitationBounds measure_bounds(const axes::AxisConfig& config, const axes::AxisView& view, Mode mode, Duration cycle) noexcept {
    const auto& limits = config.limits;
    const auto either_way = [](double a, double b) { return std::min(a, b); };
    axes::ExcitationBounds bounds;
    bounds.start = view.set_position;
    const double setup = config.manual.setup_velocity > 0 ? config.manual.setup_velocity : view.manual_slow;
    const double of_mode = mode == Mode::manual ? view.manual_fast : mode == Mode::setup ? setup : limits.velocity;
    bounds.velocity = std::min(axes::slowest(limits), of_mode) * velocity_override(view);
    bounds.usual_velocity = std::min(view.manual_slow, bounds.velocity);
    bounds.stop = either_way(limits.deceleration_towards(1), limits.deceleration_towards(-1));
    if (config.defaults.deceleration > 0) bounds.stop = std::min(bounds.stop, config.defaults.deceleration);
    bounds.acceleration = std::min(
        {limits.acceleration_towards(1), limits.acceleration_towards(-1), limits.deceleration_towards(1), limits.deceleration_towards(-1)});
    bounds.jerk = limits.jerk;
    if (config.defaults.jerk > 0) bounds.stop_jerk = config.defaults.jerk;
    if (config.modulo == 0) {
        bounds.position_min = limits.position_min;
        bounds.position_max = limits.position_max;
    }
    const auto& gearing = config.gearing;
    bounds.revolution = gearing.feed * static_cast<double>(gearing.load_revolutions) / static_cast<double>(gearing.motor_revolutions);
    bounds.cycle = to_seconds(cycle);
    return bounds;
}

}  // namespace taktwerk::runtime
