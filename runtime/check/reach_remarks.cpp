#include "runtime/check/reach_remarks.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::runtime {

std::optional<axes::ArmReach> reach_of(const MachineConfig& config, const axes::AxisGroupConfig& group) {
    std::vector<axes::AxisTravel> travels;
    for (const auto& member : group.members) {
        const auto binding = std::find_if(config.axes.begin(), config.axes.end(), [&](const auto& b) { return b.axis.name == member; });
        if (binding == config.axes.end()) return std::nullopt;
        travels.push_back({binding->axis.limits.position_min, binding->axis.limits.position_max});
    }
    return axes::arm_reach(group, travels);
}

namespace {

/// With the other tools of the file, which a program may select.
std::vector<axes::ArmReach> with_other_tools(const MachineConfig& config, axes::AxisGroupConfig group) {
    std::vector<axes::ArmReach> out;
    const auto begun = group.equipment.selected_tool;
    for (std::uint8_t i = 1; i < axes::tool_numbers; ++i) {
        if (i == begun || group.equipment.tools.find(i) == nullptr) continue;
        group.equipment.selected_tool = i;
        if (auto reach = reach_of(config, group)) out.push_back(std::move(*reach));
    }
    return out;
}

}  // namespace

std::vector<Error> reach_remarks(const MachineConfig& config) {
    std::vector<Error> found;
    for (const auto& group : config.axis_groups) {
        const auto reach = reach_of(config, group);
        if (!reach) continue;
        if (reach->points.empty()) {
            found.push_back({"remark.reach", fmt::format("groups.{}", group.name),
                             fmt::format("of {} places of its axes, over all of their travels, none has a pose inside its joints' limits: "
                                         "nothing can be commanded in a frame",
                                         reach->looked_at),
                             "compare the arm's lengths, signs, zeros and joint limits with the axes' limits"});
            continue;
        }
        if (!group.workspace) continue;
        const auto comes_to = fmt::format("the point comes to {} {}", reach->text(), group.unit);
        std::optional<std::vector<axes::ArmReach>> others;
        const auto with_all_tools = [&](const auto& missed) {
            if (!missed(*reach)) return false;
            if (!others) others = with_other_tools(config, group);
            return std::all_of(others->begin(), others->end(), missed);
        };
        bool told = false;
        for (const auto& room : group.workspace->rooms) {
            if (room.kept_free || !with_all_tools([&](const axes::ArmReach& of) { return of.far_from(room); })) continue;
            told = true;
            found.push_back({"remark.reach", fmt::format("groups.{}.workspace.{}", group.name, room.name),
                             fmt::format("its tool's point comes no nearer to this room than {} {}, wherever its axes stand",
                                         reach->shown(reach->distance_to(room)), group.unit),
                             comes_to + ": is the room, the arm's base, the tool or an axis' limit another?"});
        }
        if (!told && with_all_tools([&](const axes::ArmReach& of) { return of.outside_of(*group.workspace); }))
            found.push_back(
                {"remark.reach", fmt::format("groups.{}.workspace", group.name),
                 "wherever its axes stand, its tool's point is where it may not be: in a room that is kept free, or in none of the others",
                 comes_to + ": compare the rooms with that"});
    }
    return found;
}

}  // namespace taktwerk::runtime
