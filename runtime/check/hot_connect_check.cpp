#include "runtime/check/hot_connect_check.hpp"

#include <algorithm>

#include "runtime/check/problems.hpp"
#include "runtime/group_presence.hpp"
#include "runtime/present_slaves.hpp"

namespace taktwerk::runtime {

namespace {

class HotConnectCheck {
public:
    HotConnectCheck(const MachineConfig& config, std::vector<Error>& errors) : config_(config), problems_(errors) {}

    void run() {
        const auto groups = group_names(config_.bus);
        check_simulation(groups);
        if (groups.empty()) return;
        for (const auto& group : groups) check_simulated(group);
        for (const auto& binding : config_.axes) check_axis(binding);
        check_points();
    }

private:
    void add(std::string subject, std::string what, std::string remedy) {
        problems_.add("bus.hot_connect", std::move(subject), std::move(what), std::move(remedy));
    }
    [[nodiscard]] std::string group_of(const std::string& slave) const {
        const auto& slaves = config_.bus.slaves;
        const auto found = std::ranges::find(slaves, slave, &ecat::SlaveConfig::name);
        return found != slaves.end() ? found->hot_connect : std::string{};
    }
    [[nodiscard]] const IoPoint* point(IoDirection direction, const std::string& name) const {
        for (const auto& one : config_.io)
            if (one.direction == direction && one.name == name && !name.empty()) return &one;
        return nullptr;
    }
    static std::string words_of(const std::string& group) {
        return group.empty() ? "is always there" : fmt::format("is in group '{}'", group);
    }

    /// A group is found as a whole. What else its slaves must be, the bus says (ecat/group_check.hpp).
    void check_simulated(const std::string& group) {
        const auto& slaves = config_.bus.slaves;
        const auto there = present_slaves(config_);
        const auto of_group = [&](const auto& all) { return std::ranges::count(all, group, &ecat::SlaveConfig::hot_connect); };
        if (of_group(there) == 0 || of_group(there) == of_group(slaves)) return;
        const auto& head = *std::ranges::find(slaves, group, &ecat::SlaveConfig::hot_connect);
        add(fmt::format("slave '{}'", head.name),
            fmt::format("some axes of group '{}' are `simulated`, and their slaves count as not there: the group is found as a whole only",
                        group),
            "simulate all of its axes, or none");
    }

    /// All that an axis needs comes and goes together.
    void check_axis(const AxisBinding& binding) {
        if (binding.slave.empty()) return;
        const auto subject = "axes." + binding.axis.name;
        const auto own = group_of(binding.slave);
        const auto same = [&](const std::string& key, std::string_view what, const std::string& name, const std::string& slave) {
            if (slave.empty() || group_of(slave) == own) return;
            add(subject + key,
                fmt::format("slave '{}' of the axis {}, and {} '{}' {}", binding.slave, words_of(own), what, name,
                            words_of(group_of(slave))),
                "let all that belongs to an axis be in one group, or none of it");
        };
        same(".gantry.follower", "its follower", binding.follower.slave, binding.follower.slave);
        const auto wired = [&](const std::string& key, IoDirection direction, const std::string& name) {
            if (const auto* found = point(direction, name))
                same(key, direction == IoDirection::input ? "input" : "output", name, found->slave);
        };
        wired(".load_encoder.input", IoDirection::input, binding.load_input);
        wired(".brake.output", IoDirection::output, binding.brake_output);
        if (!binding.analog) return;
        const auto& analog = *binding.analog;
        wired(".analog.setpoint", IoDirection::output, analog.setpoint);
        wired(".analog.enable", IoDirection::output, analog.enable);
        wired(".analog.reset", IoDirection::output, analog.reset);
        wired(".analog.ready", IoDirection::input, analog.ready);
        wired(".analog.fault", IoDirection::input, analog.fault);
        wired(".analog.negative_limit", IoDirection::input, analog.negative_limit);
        wired(".analog.positive_limit", IoDirection::input, analog.positive_limit);
        wired(".analog.home_switch", IoDirection::input, analog.home_switch);
    }

    /// What the whole machine needs is never away.
    void check_points() {
        const auto always = [&](const std::string& subject, IoDirection direction, const std::string& name, std::string_view without) {
            const auto* found = point(direction, name);
            if (found == nullptr || found->presence || group_of(found->slave).empty()) return;
            add(subject, fmt::format("'{}' is at slave '{}' of group '{}': {}", name, found->slave, group_of(found->slave), without),
                "wire it to a slave that is always there");
        };
        always("emergency_stop.input", IoDirection::input, config_.emergency_stop.input, "without the group the machine would not run");
        always("emergency_stop.restart", IoDirection::input, config_.emergency_stop.restart, "without the group nobody could restart");
        for (const auto& line : config_.serial)
            for (const auto& drive : line.drives)
                always(fmt::format("serial.{}.drives.{}.watchdog_output", line.name, drive.drive.name), IoDirection::output,
                       drive.watchdog_output, "without the group its drive would stop");
    }

    void check_simulation(const std::vector<std::string>& groups) {
        std::vector<std::string> outputs, axes;
        for (const auto& one : config_.io)
            if (one.direction == IoDirection::output) outputs.push_back(one.name);
        for (const auto& binding : config_.axes) axes.push_back(binding.axis.name);
        const auto known = [](const std::vector<std::string>& names, const std::string& name) {
            return std::find(names.begin(), names.end(), name) != names.end();
        };
        for (const auto& group : config_.simulation.groups) {
            const auto subject = "simulation.groups." + group.group;
            if (!known(groups, group.group)) problems_.unknown("simulation.unknown_target", subject, "group", group.group, groups);
            if (!group.released_by.empty() && !known(outputs, group.released_by))
                problems_.unknown("simulation.unknown_target", subject + ".released_by", "output", group.released_by, outputs);
            if (!group.axis.empty() && !known(axes, group.axis))
                problems_.unknown("simulation.unknown_target", subject + ".axis", "axis", group.axis, axes);
        }
    }

    const MachineConfig& config_;
    Problems problems_;
};

}  // namespace

void check_hot_connect(const MachineConfig& config, std::vector<Error>& errors) { HotConnectCheck{config, errors}.run(); }

}  // namespace taktwerk::runtime
