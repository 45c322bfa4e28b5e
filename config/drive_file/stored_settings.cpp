#include "config/drive_file/stored_settings.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "axes/port/parameter_text.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

std::string named(const axes::DriveParameter& parameter, const ObjectAddress& at) {
    const auto object = show_object(at.index, at.sub);
    return parameter.parameter.empty() ? fmt::format("{} ({})", object, parameter.name)
                                       : fmt::format("{} ({})", object, parameter.parameter);
}

}  // namespace

DriveObject find_drive_object(const axes::DriveProfile& profile, const ObjectAddress& at) {
    constexpr std::uint16_t first_vendor = 0x2000, first_standard = 0x6000;
    DriveObject out{0, {at.index, at.sub}};
    if (profile.axes > 1 && profile.object_offset != 0 && at.index >= first_vendor) {
        const unsigned base = at.index >= first_standard ? first_standard : first_vendor;
        const unsigned axis = (at.index - base) / profile.object_offset;
        if (axis < profile.axes) {
            out.axis = axis;
            out.object.index = static_cast<std::uint16_t>(at.index - axis * profile.object_offset);
        }
    }
    for (const auto& row : profile.parameters)
        if (row.address == out.object && row.reach == axes::ParameterReach::bus) out.parameter = &row;
    return out;
}

Table<StoredEntry> stored_table() {
    using S = StoredEntry;
    constexpr auto low = std::numeric_limits<std::int64_t>::min(), high = std::numeric_limits<std::int64_t>::max();
    Table<S> table{"stored",
                   "A value that whoever commissions the drive stores in its EEPROM. With another one it is not enabled; a simulated drive "
                   "comes with it.",
                   {
                       required(field("object", &S::object, object_address(), "as the manual prints it: 2000h:02")),
                       required(field("value", &S::value, integer<std::int64_t>(low, high), "raw")),
                       field("comment", &S::comment, text(), "for people"),
                   },
                   {},
                   {}};
    table.before = [](Reader&, const Node& node, S& entry) { entry.where = node.at; };
    // An entry that could not be read says nothing, so nothing follows from it.
    table.after = [](Reader& reader, const Node&, S& entry) {
        if (reader.already_bad(reader.path())) entry.object = {};
    };
    return table;
}

std::vector<AxisStored> resolve_stored(Reader& reader, const std::string& slave, const std::vector<StoredEntry>& entries,
                                       const std::vector<ecat::StartupSdo>& startup, const axes::DriveProfile& profile) {
    std::vector<AxisStored> out;
    for (const auto& entry : entries) {
        if (entry.object.index == 0) continue;  // already reported
        const auto found = find_drive_object(profile, entry.object);
        const auto shown = show_object(entry.object.index, entry.object.sub);
        const auto problem = [&](std::string code, std::string what, std::string remedy) {
            reader.problem(entry.where, std::move(code), std::move(what), std::move(remedy));
        };
        if (!found.parameter) {
            problem("config.stored_unknown", fmt::format("{} has no parameter {}", profile.name, shown),
                    fmt::format("`taktwerk drive params --profile {}` lists them", profile.name));
            continue;
        }
        const auto& parameter = *found.parameter;
        if (!axes::is_setting(parameter)) {
            problem("config.stored_no_setting", fmt::format("{} is nothing that a drive keeps", named(parameter, entry.object)),
                    "remove the line");
            continue;
        }
        if ((parameter.minimum && entry.value < *parameter.minimum) || (parameter.maximum && entry.value > *parameter.maximum)) {
            problem("config.out_of_range", fmt::format("{} is not in the range of {}", entry.value, named(parameter, entry.object)),
                    fmt::format("give {} to {}, raw", parameter.minimum.value_or(0), parameter.maximum.value_or(0)));
            continue;
        }
        const auto earlier = std::find_if(entries.begin(), entries.end(), [&](const StoredEntry& other) {
            return &other == &entry || (other.object.index == entry.object.index && other.object.sub == entry.object.sub);
        });
        if (&*earlier != &entry) {
            problem("config.stored_twice",
                    fmt::format("{} stands under `stored` already, in line {}{}", named(parameter, entry.object), earlier->where.line,
                                earlier->value == entry.value ? std::string{}
                                                              : fmt::format(", with {} instead of {}", earlier->value, entry.value)),
                    "keep the one that the drive really holds (`taktwerk drive get`)");
            continue;
        }
        const auto written = std::find_if(startup.begin(), startup.end(), [&](const ecat::StartupSdo& other) {
            return other.index == entry.object.index && other.sub == entry.object.sub;
        });
        if (written != startup.end()) {
            problem("config.stored_twice",
                    fmt::format("{} is written at each start, too ({})", named(parameter, entry.object), written->origin),
                    "keep `stored` for what the drive keeps, `startup` for what is written each time");
            continue;
        }
        out.push_back({found.axis, {found.object, entry.value, axes::way_to_store(profile, slave, found.axis, parameter, entry.value)}});
    }
    return out;
}

void refuse_late_startup(Reader& reader, const std::string& slave, const std::vector<StartupEntry>& entries,
                         const axes::DriveProfile& profile) {
    for (const auto& entry : entries) {
        if (entry.object.index == 0) continue;
        const auto found = find_drive_object(profile, entry.object);
        if (!found.parameter || !found.parameter->waits_for_restart()) continue;
        const auto& parameter = *found.parameter;
        const bool saved = parameter.effect == axes::ParameterEffect::after_saving;
        reader.problem(
            entry.where, "config.startup_too_late",
            fmt::format("{} counts after {} only: what is written while the drive comes up is not in force when the axis is enabled, "
                        "though it reads back [{} {}]",
                        named(parameter, entry.object), saved ? "saving and a restart" : "a restart", profile.name, parameter.section),
            fmt::format("move the entry to `stored:` of the slave, and once: {}",
                        axes::way_to_store(profile, slave, found.axis, parameter, entry.value)));
    }
}

}  // namespace taktwerk::config
