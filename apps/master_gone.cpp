#include "apps/master_gone.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "axes/drives/xp200/registers.hpp"

namespace taktwerk::apps {
namespace {

/// A reaction object of CiA 402 and what its standard values mean (CiA 402-2, clause 6). Vendors differ: the manual decides.
struct ReactionObject {
    std::uint16_t index;
    const char* name;
    struct Value {
        std::int64_t value;
        const char* words;
    };
    std::array<Value, 6> values;
};
constexpr std::array<ReactionObject, 3> reactions{{
    {0x6007, "connection lost", {{{0, "no action"}, {1, "fault"}, {2, "power off"}, {3, "quick stop"}, {-1, nullptr}, {-1, nullptr}}}},
    {0x605A,
     "quick stop",
     {{{0, "power off, the motor coasts"},
       {1, "slow-down ramp, then off"},
       {2, "quick-stop ramp (6085h), then off"},
       {3, "current limit, then off"},
       {5, "slow-down ramp, stays in quick stop"},
       {6, "quick-stop ramp (6085h), stays in quick stop"}}}},
    {0x605E,
     "fault",
     {{{0, "power off, the motor coasts"},
       {1, "slow-down ramp"},
       {2, "quick-stop ramp (6085h)"},
       {3, "current limit"},
       {-1, nullptr},
       {-1, nullptr}}}},
}};

struct Setting {
    std::int64_t value = 0;
    std::string from;
};

std::optional<Setting> setting(const ecat::SlaveConfig& slave, std::uint16_t index) {
    for (const auto& sdo : slave.startup)
        if (sdo.index == index && sdo.sub == 0) return Setting{sdo.value, sdo.origin.empty() ? "start-up list" : sdo.origin};
    if (slave.device)
        for (const auto& object : slave.device->objects)
            if (object.index == index && object.sub == 0) return Setting{object.value, "the drive's default, nobody writes it"};
    return std::nullopt;
}

std::string words(const ReactionObject& reaction, std::int64_t value) {
    for (const auto& entry : reaction.values)
        if (entry.words && entry.value == value) return entry.words;
    return "see the drive's manual";
}

std::optional<std::int64_t> parameter(const axes::xp200::DriveConfig& drive, std::uint16_t number) {
    for (const auto& p : drive.parameters)
        if (p.number == number) return p.value;
    if (drive.profile)
        for (const auto& row : drive.profile->parameters)
            if (row.address.index == number) return row.value;
    return std::nullopt;
}

/// A drive on a serial line: it does not notice that nobody speaks any more.
std::vector<std::string> line_gone(const runtime::MachineConfig& config, const runtime::AxisBinding& axis) {
    namespace pr = axes::xp200::pr;
    std::vector<std::string> out{"its line falls silent, which the drive does not notice: it goes on at the speed selected last [XP200 9]"};
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives) {
            if (entry.drive.name != axis.drive) continue;
            if (entry.watchdog_output.empty()) {
                out.push_back("nothing stops it here: `unsupervised_line: accepted` says that something else does");
                continue;
            }
            Duration watchdog{};
            for (const auto& point : config.io)
                for (const auto& slave : config.bus.slaves)
                    if (point.name == entry.watchdog_output && point.direction == runtime::IoDirection::output && slave.name == point.slave)
                        watchdog = runtime::sm_watchdog(config, slave);
            out.push_back(
                fmt::format("output '{}' falls {:g} ms after the last process data by its terminal's own watchdog; when only the line is "
                            "silent, the runtime drops it after {:g} ms",
                            entry.watchdog_output, to_seconds(watchdog) * 1e3, to_seconds(entry.drive.silence) * 1e3));
            const bool ramps = parameter(entry.drive, pr::emergency_mode) == 1;
            out.push_back(
                ramps ? fmt::format("that is EMG: it stays enabled and brakes in {} ms for 1000 r/min (Pr164 = 1, Pr063) [XP200 5.4]",
                                    parameter(entry.drive, pr::stop_time).value_or(0))
                      : "that is EMG: the current is cut and it coasts (Pr164 = 0) [XP200 5.4.2]");
        }
    return out;
}

}  // namespace

std::vector<std::string> master_gone(const runtime::MachineConfig& config, const runtime::AxisBinding& axis) {
    std::vector<std::string> out;
    if (axis.slave.empty() && axis.drive.empty()) return {"no drive: nothing moves"};
    if (axis.axis.disabled) return {"left out: its drive is never enabled"};
    if (!axis.drive.empty()) return line_gone(config, axis);
    const auto slave =
        std::find_if(config.bus.slaves.begin(), config.bus.slaves.end(), [&](const auto& s) { return s.name == axis.slave; });
    if (slave == config.bus.slaves.end()) return out;
    out.push_back(fmt::format("after {:g} ms without process data the slave's watchdog takes it out of OP",
                              to_seconds(runtime::sm_watchdog(config, *slave)) * 1e3));
    for (const auto& reaction : reactions) {
        const auto found = setting(*slave, reaction.index);
        if (found)
            out.push_back(fmt::format("{} ({:04X}h) = {}: {} [{}]", reaction.name, reaction.index, found->value,
                                      words(reaction, found->value), found->from));
        else out.push_back(fmt::format("{} ({:04X}h): not in the drive's description; its manual decides", reaction.name, reaction.index));
    }
    return out;
}

}  // namespace taktwerk::apps
