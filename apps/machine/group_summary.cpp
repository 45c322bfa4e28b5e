#include "apps/machine/group_summary.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/group_presence.hpp"

namespace taktwerk::apps {

namespace {

using runtime::IoDirection;
using runtime::IoPoint;

bool in_group(const runtime::MachineConfig& config, const std::string& group, const std::string& slave) {
    return std::ranges::any_of(config.bus.slaves, [&](const auto& s) { return s.name == slave && s.hot_connect == group; });
}

/// "clamp (0), vent (1)": an output with the value that it carries while nobody may believe the group.
std::string safe_values(const std::vector<const IoPoint*>& outputs) {
    std::vector<std::string> words;
    for (const auto* point : outputs)
        words.push_back(point->unit.empty()
                            ? fmt::format("{} = {}", point->name, point->safe_value)
                            : fmt::format("{} = {:g} {}", point->name, point->line.value_of(point->safe_value), point->unit));
    return fmt::format("{}", fmt::join(words, ", "));
}

/// Cams of the file that are meant for a slave elsewhere. What programs couple, the file does not know.
std::vector<std::string> cams_out_of(const runtime::MachineConfig& config, const GroupSummary& group) {
    std::vector<std::string> out;
    const auto own = [&](const std::string& axis) { return std::ranges::find(group.axes, axis) != group.axes.end(); };
    for (const auto& cam : config.cams)
        if (own(cam.master) && !cam.slave.empty() && !own(cam.slave)) out.push_back(fmt::format("{} (cam {})", cam.slave, cam.name));
    return out;
}

}  // namespace

std::vector<GroupSummary> group_summaries(const runtime::MachineConfig& config) {
    std::vector<GroupSummary> out;
    for (const auto& name : runtime::group_names(config.bus)) {
        GroupSummary group;
        group.name = name;
        for (const auto& slave : config.bus.slaves) {
            if (slave.hot_connect != name) continue;
            if (group.slaves.empty()) group.known_by = place_of(slave);
            group.slaves.push_back(slave.name);
        }
        for (const auto& binding : config.axes)
            if (in_group(config, name, binding.slave)) group.axes.push_back(binding.axis.name);
        std::vector<const IoPoint*> outputs;
        for (const auto& point : config.io) {
            if (point.presence || !in_group(config, name, point.slave)) continue;
            if (point.direction == IoDirection::output) outputs.push_back(&point);
            (point.direction == IoDirection::input ? group.inputs : group.outputs).push_back(point.name);
        }
        if (!group.inputs.empty())
            group.when_absent.push_back(fmt::format("inputs {} keep their last value and are not good", fmt::join(group.inputs, ", ")));
        if (!outputs.empty())
            group.when_absent.push_back(fmt::format("outputs are kept safe ({}), and take what the program wrote once {}.present is TRUE",
                                                    safe_values(outputs), name));
        if (!group.axes.empty()) {
            group.when_absent.push_back(fmt::format("axes {} are Disabled, and refuse with not_connected", fmt::join(group.axes, ", ")));
            group.when_absent.push_back(
                "taken away under power: alarm group_pulled, its own axes stop, the others run on; an axis elsewhere that follows one of "
                "them "
                "stops with master_lost");
        }
        if (const auto followers = cams_out_of(config, group); !followers.empty())
            group.when_absent.push_back(fmt::format("{} outside of the group follow its axes", fmt::join(followers, ", ")));
        out.push_back(std::move(group));
    }
    return out;
}

std::string place_of(const ecat::SlaveConfig& slave) {
    if (slave.position) return fmt::format("position {}", *slave.position);
    if (slave.alias) return fmt::format("alias {}", *slave.alias);
    if (slave.device_id) return fmt::format("device id {}", *slave.device_id);
    return fmt::format("in {}", slave.hot_connect);
}

}  // namespace taktwerk::apps
