#include "axes/sim/stop_order.hpp"

#include <algorithm>
#include <cstddef>

#include "axes/sim/mode_codes.hpp"

namespace taktwerk::axes::sim {

namespace {

bool fits(const StopWay& way, DriveMode mode) noexcept {
    return way.modes.empty() || std::find(way.modes.begin(), way.modes.end(), mode) != way.modes.end();
}

StopOrder undocumented_stop(const DriveProfile& profile, StopCause cause, std::int64_t in_mode, const AxisInputs& settings) noexcept {
    const StopOrder braked{StopBy::zero_speed, StopThen::free};
    const StopOrder let_go{StopBy::coast, StopThen::free};
    switch (cause) {
        case StopCause::quick_stop: return {braked.by, profile.stops.quick_stop_leaves ? StopThen::free : StopThen::lock};
        case StopCause::fault: return profile.stops.fault == DriveStop::ramp ? braked : let_go;
        case StopCause::off:
        case StopCause::shutdown:
        case StopCause::disable: return profile.stops.off == DriveStop::ramp ? braked : let_go;
        case StopCause::halt: {
            const double by_6084 = stop_ramp(profile, StopBy::ramp, in_mode, settings);
            return {by_6084 > 0 ? StopBy::ramp : StopBy::zero_speed, StopThen::lock, by_6084, by_6084 <= 0};
        }
        case StopCause::overtravel: return {StopBy::zero_speed, StopThen::lock};
    }
    return braked;
}

}  // namespace

double stop_ramp(const DriveProfile& profile, StopBy by, std::int64_t in_mode, const AxisInputs& settings) noexcept {
    switch (by) {
        case StopBy::ramp:
            return in_mode == mode::homing ? settings.homing.acceleration
                                           : static_cast<double>(in_mode == mode::profile_position && profile.has(Quirk::pp_shared_ramp)
                                                                     ? settings.profile_acceleration
                                                                     : settings.profile_deceleration);
        case StopBy::quick_ramp: return static_cast<double>(settings.quick_stop_deceleration);
        default: return 0;
    }
}

StopOrder stop_order(const DriveProfile& profile, StopCause cause, std::int64_t in_mode, const AxisInputs& settings) noexcept {
    const auto& stops = profile.stops.options;
    const auto of = [&](StopCause wanted) {
        return std::find_if(stops.begin(), stops.end(), [&](const auto& s) { return s.cause == wanted; });
    };
    auto option = of(cause);
    if (option == stops.end() && (cause == StopCause::shutdown || cause == StopCause::disable)) option = of(StopCause::off);
    if (option == stops.end()) return undocumented_stop(profile, cause, in_mode, settings);
    const auto place = static_cast<std::size_t>(option - stops.begin());
    const auto value = place < most_stop_options ? settings.stop_values[place] : 0;
    const StopWay* chosen = nullptr;
    for (const auto& way : option->ways) {
        if (!fits(way, mode::meaning(in_mode))) continue;
        if (!chosen) chosen = &way;
        if (option->object.index == 0 || way.value == value) {
            chosen = &way;
            break;
        }
    }
    if (!chosen) return undocumented_stop(profile, cause, in_mode, settings);
    const bool at_once = chosen->by != StopBy::ramp && chosen->by != StopBy::quick_ramp;
    return {chosen->by, chosen->then, stop_ramp(profile, chosen->by, in_mode, settings), at_once};
}

}  // namespace taktwerk::axes::sim
