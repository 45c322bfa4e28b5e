// taktwerk drive alarms, reset: what the drive complains of, in its manual's words, and clearing it.

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/drive/profiles.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/alarm_words.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

constexpr Duration reset_patience = std::chrono::seconds{3};  // several attempts of the port

/// Below 1000h it is no error code of CiA 301 but the vendor's own number, of a drive that has no objects.
std::string code_text(std::uint16_t code) {
    constexpr std::uint16_t lowest_error_code = 0x1000;
    return code < lowest_error_code ? fmt::format("number {}", code) : fmt::format("603Fh = {:04X}h", code);
}

Result<axes::ShownAlarm> read_alarm(DriveAccess& drive) {
    const auto complaint = drive.complaint();
    if (!complaint) return complaint.error();
    axes::ShownAlarm out;
    out.code = complaint->code;
    out.detail = complaint->detail;
    return out;
}

Json alarm_json(const DriveAccess& drive, const axes::ShownAlarm& shown) {
    Json out{{"drive", drive.subject()}, {"code", shown.code}};
    if (shown.detail) out["detail"] = *shown.detail;
    if (const auto* alarm = axes::find_alarm(drive.profile(), shown).row; alarm && shown.code != 0) {
        out["panel"] = alarm->panel;
        out["english"] = alarm->english;
        out["chinese"] = alarm->chinese;
        out["cause"] = alarm->cause;
        out["remedy"] = alarm->remedy;
        out["resettable"] = alarm->resettable;
        out["warning"] = alarm->warning;
    }
    return out;
}

int alarms(const DriveOptions& options) {
    return with_drive(options, [&](DriveAccess& drive) {
        const auto present = read_alarm(drive);
        if (!present) return fail(*options.bus, present.error());
        if (options.bus->json) print_json(alarm_json(drive, *present));
        else fmt::print("{}", alarm_text(drive.subject(), drive.profile(), *present, colours_of_output()));
        return static_cast<int>(exit_ok);
    });
}

int reset(const DriveOptions& options) {
    return with_drive(options, [&](DriveAccess& drive) {
        const auto before = read_alarm(drive);
        if (!before) return fail(*options.bus, before.error());
        if (before->code == 0) {
            if (options.bus->json) print_json(Json{{"ok", true}, {"drive", drive.subject()}, {"cleared", false}});
            else fmt::print("{}: no alarm, nothing to reset\n", drive.subject());
            return static_cast<int>(exit_ok);
        }
        const auto* alarm = axes::find_alarm(drive.profile(), *before).row;
        const auto name = alarm ? fmt::format("{} {}", alarm->panel, alarm->english) : code_text(before->code);
        if (alarm && !alarm->resettable)
            return fail(*options.bus, Error{"drive.not_reset", drive.subject(),
                                            fmt::format("only switching the drive off and on clears {}", name), alarm->remedy});
        const auto done = drive.reset_fault(reset_patience);
        if (!done) return fail(*options.bus, done.error());
        if (!*done)
            return fail(*options.bus,
                        Error{"drive.not_reset", drive.subject(), fmt::format("{} stands again or still: its cause is not gone", name),
                              alarm ? alarm->remedy : "see the drive's manual"});
        if (options.bus->json) print_json(Json{{"ok", true}, {"drive", drive.subject()}, {"cleared", true}, {"alarm", name}});
        else fmt::print("{}: {} cleared\n", drive.subject(), name);
        return static_cast<int>(exit_ok);
    });
}

/// The whole list of a kind of drive.
int list(const DriveOptions& options) {
    const auto profile = profile_named(options, options.profile);
    if (!profile) return fail(*options.bus, profile.error());
    if (options.bus->json) {
        auto out = Json::array();
        for (const auto& alarm : (*profile)->alarms)
            out.push_back(Json{{"code", alarm.code},
                               {"detail", alarm.detail},
                               {"panel", alarm.panel},
                               {"english", alarm.english},
                               {"chinese", alarm.chinese},
                               {"cause", alarm.cause},
                               {"remedy", alarm.remedy},
                               {"resettable", alarm.resettable},
                               {"warning", alarm.warning}});
        print_json(out);
        return exit_ok;
    }
    TextTable table{{{"panel"}, {"603Fh"}, {"name", TextTable::Column::Side::left, 44}, {"名称"}, {"cleared by"}}};
    for (const auto& alarm : (*profile)->alarms)
        table.add({Cell{alarm.panel, Tone::strong}, Cell{fmt::format("{:04X}h", alarm.code)}, Cell{alarm.english}, Cell{alarm.chinese},
                   Cell{alarm.warning      ? "itself (warning)"
                        : alarm.resettable ? "reset"
                                           : "power cycle"}});
    fmt::print("{}: {}\n\n{}", (*profile)->title, count_text((*profile)->alarms.size(), "alarm"), table.text(colours_of_output()));
    return exit_ok;
}

}  // namespace

std::string alarm_text(const std::string& subject, const axes::DriveProfile& profile, const axes::ShownAlarm& alarm, Colours colours) {
    if (alarm.code == 0) return subject + ": " + toned("no alarm", Tone::good, colours) + "\n";
    const auto* row = axes::find_alarm(profile, alarm).row;
    const auto words = axes::words(profile, alarm, "taktwerk drive reset");
    auto out = fmt::format("{}: {}\n", subject, toned(words.english, row && row->warning ? Tone::warning : Tone::bad, colours));
    const auto more = [&](std::string_view before, std::string_view text) {
        if (!text.empty()) out += fmt::format("  {}{}\n", before, wrapped(text, 10));
    };
    if (row) more("        ", row->chinese);
    more("cause:  ", words.cause);
    more("remedy: ", words.remedy);
    more("reset:  ", words.reset);
    return out;
}

void add_drive_alarms(CLI::App& drive, Action& action) {
    auto* sub = drive.add_subcommand("alarms", "the alarm that stands, in the manual's words; without a drive: all of --profile");
    auto options = add_drive_options(*sub);
    sub->add_option("DRIVE", options->drive, "position or name on the bus; none: the manual's list of --profile");
    sub->add_option("--axis", options->axis, "of a drive with several axes, from 1")->check(CLI::Range(1, 8));
    sub->callback([&action, options] {
        action = [options] {
            if (!options->drive.empty()) return alarms(*options);
            if (!options->profile.empty()) return list(*options);
            return fail(*options->bus, Error{"drive.value", "", "say which drive on the bus, or --profile NAME for the manual's list",
                                             "`taktwerk drive identify` lists the drives"});
        };
    });

    auto* resetting = drive.add_subcommand("reset", "clear the drive's fault: brings the bus to OP, with everything disabled");
    auto reset_options = add_drive_options(*resetting);
    add_drive_choice(*resetting, *reset_options);
    resetting->add_flag("--yes", reset_options->bus->yes, "do not ask before outputs are driven");
    resetting->callback([&action, reset_options] { action = [reset_options] { return reset(*reset_options); }; });
}

}  // namespace taktwerk::apps
