#include "hmi_bridge/words/place_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace taktwerk::hmi {
namespace {

using axes::ErrorId;
using axes::PathHindrance;
using GroupInfo = runtime::MachineLayout::GroupInfo;

/// Never "-0.000".
double shown(double value) { return std::abs(value) < 0.0005 ? 0.0 : value; }

std::string what_stands_there(const axes::PathPlace& place, const runtime::MachineLayout& layout, const GroupInfo& group,
                              const std::array<axes::AxisRef, axes::most_members>& axes) {
    const auto& at = place.at;
    if (at.room < group.rooms.size()) {
        const auto& room = group.rooms[at.room];
        return room.kept_free ? fmt::format("it enters the kept-free room '{}'", room.name)
                              : fmt::format("it leaves the room '{}'", room.name);
    }
    const auto axis = at.place < axes.size() ? axes[at.place] : axes::AxisRef{};
    if (!axis.valid() || axis.index >= layout.axes.size()) return {};
    const auto& info = layout.axes[axis.index];
    if (place.error == ErrorId::not_powered) return fmt::format("axis {} has no power", info.name);
    if (place.error == ErrorId::not_homed) return fmt::format("axis {} is not homed", info.name);
    if (!at.limit_known) return fmt::format("axis {} would be beyond its limit", info.name);
    if (at.position == at.limit) return fmt::format("axis {} comes to its limit of {:.3f} {}", info.name, shown(at.limit), info.unit);
    return fmt::format("axis {} would go to {:.3f} {}, its limit is {:.3f} {}", info.name, shown(at.position), info.unit, shown(at.limit),
                       info.unit);
}

}  // namespace

std::string place_text(const axes::PathPlace& place, const runtime::MachineLayout& layout, std::size_t group,
                       const std::array<axes::AxisRef, axes::most_members>& axes) {
    if (group >= layout.groups.size()) return {};
    const auto& info = layout.groups[group];
    const auto& at = place.at;
    std::string out = what_stands_there(place, layout, info, axes);
    const auto add = [&](const std::string& part) { out += (out.empty() ? "" : "; ") + part; };
    if (at.in_space)
        add(fmt::format("at X {:.3f} Y {:.3f} Z {:.3f} {} (MCS)", shown(at.point[0]), shown(at.point[1]), shown(at.point[2]), info.unit));
    if (at.on_path && at.length > 0)
        add(fmt::format("after {:.3f} of {:.3f} {} of its way", shown(at.part * at.length), at.length, info.unit));
    else if (at.on_path) add(fmt::format("after {:.1f} % of its way", 100 * at.part));
    if (place.line != 0 && place.column != 0) add(fmt::format("line {}, column {} of its text", place.line, place.column));
    else if (place.line != 0) add(fmt::format("line {} of its text", place.line));
    return out;
}

std::string_view room_name(std::uint8_t room, const runtime::MachineLayout& layout, std::size_t group) {
    if (group >= layout.groups.size() || room >= layout.groups[group].rooms.size()) return {};
    return layout.groups[group].rooms[room].name;
}

std::array<axes::AxisRef, axes::most_members> members_of(const runtime::MachineLayout& layout, std::size_t group) {
    std::array<axes::AxisRef, axes::most_members> axes{};
    if (group < layout.groups.size())
        for (std::size_t i = 0; i < axes.size() && i < layout.groups[group].members.size(); ++i)
            axes[i] = {layout.groups[group].members[i]};
    return axes;
}

}  // namespace taktwerk::hmi
