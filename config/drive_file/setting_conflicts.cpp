#include "config/drive_file/setting_conflicts.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/port/drive_scale.hpp"
#include "axes/port/parameter_text.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

/// What no start-up list may write, whatever the drive: it would be done again at each start. {0}: the slave.
struct StartupCommand {
    std::uint16_t index;
    std::string_view what, remedy;
};
constexpr StartupCommand startup_commands[] = {
    {0x1010,
     "saves the parameters of '{0}' when it is written: at each start, whatever they are just then; its EEPROM bears some 100,000 writes "
     "[CiA 301, 1010h]",
     "remove the entry; store once, when the drive is commissioned: `taktwerk drive set {0} PARAMETER=VALUE --store`, and name what has to "
     "be there under `stored`"},
    {0x1011, "puts the factory's values of '{0}' back when it is written: each start would undo what was stored [CiA 301, 1011h]",
     "remove the entry; for a known state keep a file: `taktwerk drive save {0} FILE`, `taktwerk drive restore {0} FILE --store`"},
};

/// What the cycle writes in OP, in every drive of CiA 402: a start-up list moves or enables the drive by it before the machine knows, or has no
/// effect, since the next frame overwrites it.
struct CyclicCommand {
    std::uint16_t index;
    std::string_view name, instead;
};
constexpr CyclicCommand cyclic_commands[] = {
    {0x6040, "control word", "the axis enables its drive: `taktwerk enable`, MC_Power"},
    {0x6071, "target torque", "MC_TorqueControl gives it"},
    {0x607A, "target position", "the axis gives it: `taktwerk move`, MC_MoveAbsolute"},
    {0x60B0, "position offset", "the axis gives it"},
    {0x60B1, "velocity offset", "the axis gives it"},
    {0x60B2, "torque offset", "the axis gives it"},
    {0x60FF, "target velocity", "the axis gives it: MC_MoveVelocity"},
};

/// What the machine file says that an object holds.
struct Said {
    axes::ParameterAddress object;
    std::int64_t value = 0;
    Position where;
};

enum class Counts : std::uint8_t { always, after_restart_never };  ///< what waits for a restart, in a start-up list

/// Without the entries that are reported for themselves.
template <class Entry>
void collect(std::vector<Said>& out, const std::vector<Entry>& entries, Counts counts, const axes::DriveProfile& profile,
             std::size_t axis) {
    for (const auto& entry : entries) {
        if (entry.object.index == 0) continue;
        const auto found = find_drive_object(profile, entry.object);
        const auto* p = found.parameter;
        if (!p || found.axis != axis || (p->minimum && entry.value < *p->minimum) || (p->maximum && entry.value > *p->maximum)) continue;
        if (counts == Counts::after_restart_never && p->waits_for_restart()) continue;
        out.push_back({found.object, entry.value, entry.where});
    }
}

std::string named(const axes::DriveProfile& profile, axes::ParameterAddress object) {
    for (const auto& row : profile.parameters)
        if (row.address == object) return fmt::format("{} ({})", axes::name_of(row), row.name);
    return axes::object_text(object);
}

std::string either_of(const std::vector<std::int64_t>& values) {
    std::string out;
    for (const auto value : values) out += (out.empty() ? "" : " or ") + std::to_string(value);
    return out;
}

void hold_up_to_gearing(Reader& reader, const std::string& slave, const std::vector<Said>& said, const axes::DriveProfile& profile,
                        const DriveAxis& axis) {
    if (axis.counts_per_revolution <= 0) return;  // already reported
    const auto& scale = profile.scale;
    const Said* first = nullptr;
    const auto found = axes::scale_of(scale, [&](axes::ParameterAddress object) -> std::optional<std::int64_t> {
        for (const auto& one : said) {
            if (one.object != object) continue;
            if (!first) first = &one;
            return one.value;
        }
        // A ratio that the file does not name is not one that it sets to something else.
        const bool ratio = std::find(scale.only_one.begin(), scale.only_one.end(), object) != scale.only_one.end();
        return ratio ? std::optional<std::int64_t>{1} : std::nullopt;
    });
    if (!found || !first || found->is(axis.counts_per_revolution)) return;
    reader.problem(first->where, "config.setting_contradicts",
                   fmt::format("with {} = {} a turn of the motor of '{}' is {:.10g} counts, and axis '{}' has `gearing: {{ "
                               "counts_per_revolution: {} }}`: it would travel {:.4g} times as far as it shows, and is not enabled [{} {}]",
                               named(profile, first->object), first->value, slave, found->value(), axis.name, axis.counts_per_revolution,
                               static_cast<double>(axis.counts_per_revolution) / found->value(), profile.name, scale.section),
                   "make the two agree: write the value that the drive really has to have, or correct `gearing`");
}

void hold_up_to_required(Reader& reader, const std::vector<Said>& said, const axes::DriveProfile& profile, const DriveAxis& axis) {
    for (const auto& row : profile.required_settings) {
        const bool counts = row.when == axes::SettingApplies::always || (row.when == axes::SettingApplies::with_clocks) == axis.clocks;
        if (!counts) continue;
        for (const auto& one : said) {
            if (one.object != row.object) continue;
            const auto place = static_cast<std::size_t>(one.value);
            const bool by_cycle = row.values.empty();
            const bool known_cycle = by_cycle && one.value >= 0 && place < row.cycles.size();
            const bool fits = by_cycle ? known_cycle && row.cycles[place] == axis.cycle
                                       : std::find(row.values.begin(), row.values.end(), one.value) != row.values.end();
            if (fits) continue;
            const auto why = known_cycle ? fmt::format("{} means {} us, the bus exchanges every {} us", one.value,
                                                       row.cycles[place].count() / 1000, axis.cycle.count() / 1000)
                             : by_cycle  ? fmt::format("{} is no cycle", one.value)
                                         : fmt::format("it must be {}", either_of(row.values));
            reader.problem(one.where, "config.setting_contradicts",
                           fmt::format("{} = {}: {}; axis '{}' would not be enabled: {} [{} {}]", named(profile, one.object), one.value,
                                       why, axis.name, row.text, profile.name, row.section),
                           row.remedy);
        }
    }
}

}  // namespace

void refuse_startup_commands(Reader& reader, const std::string& slave, const std::vector<StartupEntry>& entries,
                             const axes::DriveProfile* profile) {
    for (const auto& entry : entries) {
        if (entry.object.index == 0) continue;
        const auto shown = show_object(entry.object.index, entry.object.sub);
        const auto refuse = [&](std::string what, std::string remedy) {
            reader.problem(entry.where, "config.startup_command", std::move(what), std::move(remedy));
        };
        const auto command = std::find_if(std::begin(startup_commands), std::end(startup_commands),
                                          [&](const StartupCommand& row) { return row.index == entry.object.index; });
        if (command != std::end(startup_commands)) {
            refuse(fmt::format("{} {}", shown, fmt::format(fmt::runtime(command->what), slave)),
                   fmt::format(fmt::runtime(command->remedy), slave));
            continue;
        }
        const auto standard = profile ? find_drive_object(*profile, entry.object).object.index : entry.object.index;
        const auto cyclic = std::find_if(std::begin(cyclic_commands), std::end(cyclic_commands),
                                         [&](const CyclicCommand& row) { return row.index == standard; });
        if (profile && cyclic != std::end(cyclic_commands)) {
            refuse(fmt::format(
                       "{} ({}) is no setting but a command of the cycle: at a start it would act on the drive of '{}' before its axis "
                       "is there, and the first process data overwrite it [CiA 402]",
                       shown, cyclic->name, slave),
                   fmt::format("remove the entry; {}", cyclic->instead));
            continue;
        }
        if (profile)
            if (const auto documented = axes::check_homing_method(*profile, {standard, entry.object.sub}, entry.value); !documented)
                reader.problem(entry.where, "config.homing_method", fmt::format("{}: {}", shown, documented.error().what),
                               documented.error().remedy);
        const auto* parameter = profile ? find_drive_object(*profile, entry.object).parameter : nullptr;
        if (!parameter || !parameter->action) continue;
        refuse(fmt::format("{} ({}) is no setting: writing it does something{}, and a start-up list does it at each start [{} {}]", shown,
                           parameter->name, parameter->meaning.empty() ? std::string{} : fmt::format(" ({})", parameter->meaning),
                           profile->name, parameter->section),
               "remove the entry; do it by hand when it is wanted (`taktwerk drive --help`, `taktwerk bus sdo write`)");
    }
}

void refuse_contradictions(Reader& reader, const std::string& slave, const std::vector<StoredEntry>& stored,
                           const std::vector<StartupEntry>& startup, const axes::DriveProfile& profile, const DriveAxis& axis) {
    std::vector<Said> said;
    collect(said, stored, Counts::always, profile, axis.axis);
    collect(said, startup, Counts::after_restart_never, profile, axis.axis);
    hold_up_to_gearing(reader, slave, said, profile, axis);
    hold_up_to_required(reader, said, profile, axis);
}

}  // namespace taktwerk::config
