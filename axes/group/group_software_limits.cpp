#include "axes/group/group_software_limits.hpp"

#include <array>
#include <cmath>

#include "axes/axis/parameters.hpp"

namespace taktwerk::axes {
namespace {

struct Pair {
    double high, low;
};

Pair present(const AxisView& view) noexcept { return {view.parameters[software_limit_positive], view.parameters[software_limit_negative]}; }

ErrorId refuse(const Pair& wanted, const AxisView& view) noexcept {
    const auto now = present(view);
    const double high = std::isfinite(wanted.high) ? wanted.high : now.high, low = std::isfinite(wanted.low) ? wanted.low : now.low;
    if (std::isnan(wanted.high) || std::isnan(wanted.low) || !(low < high)) return ErrorId::invalid_parameter;
    if (view.active != 0 || view.set_velocity != 0) return ErrorId::member_moves;
    if (view.homed && (view.set_position > high || view.set_position < low)) return ErrorId::beyond_software_limit;
    return ErrorId::none;
}

ErrorId write(const Pair& wanted, Axis& axis, Owner owner) noexcept {
    const auto put = [&](std::int32_t number, double value) { return axis.set(WriteParameter{number, value}, owner); };
    // The one first that moves away from the other: at no time is the lower one above the upper one.
    const bool up_first = wanted.high > present(axis.view()).low;
    ErrorId error = ErrorId::none;
    for (const bool upper : {up_first, !up_first}) {
        const double value = upper ? wanted.high : wanted.low;
        if (!std::isfinite(value) || error != ErrorId::none) continue;
        error = put(upper ? software_limit_positive : software_limit_negative, value);
        if (error == ErrorId::none) error = put(upper ? enable_limit_positive : enable_limit_negative, 1);
    }
    return error;
}

}  // namespace

ErrorId write_limits(const WriteSoftwareLimits& limits, GroupMembers& members, Owner owner) noexcept {
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i))
            if (const auto error = refuse({limits.high[i], limits.low[i]}, members.axis(i).view()); error != ErrorId::none) return error;
    struct Before {
        Pair limits;
        std::array<double, 2> enabled;
    };
    std::array<Before, most_members> before{};
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members.has(i)) continue;
        auto& axis = members.axis(i);
        const auto& p = axis.view().parameters;
        before[i] = {present(axis.view()), {p[enable_limit_positive], p[enable_limit_negative]}};
        const auto error = write({limits.high[i], limits.low[i]}, axis, owner);
        if (error == ErrorId::none) continue;
        // Back to what was, also of this one.
        for (std::size_t k = 0; k <= i; ++k) {
            if (!members.has(k)) continue;
            (void)write(before[k].limits, members.axis(k), owner);
            (void)members.axis(k).set(WriteParameter{enable_limit_positive, before[k].enabled[0]}, owner);
            (void)members.axis(k).set(WriteParameter{enable_limit_negative, before[k].enabled[1]}, owner);
        }
        return error;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes
