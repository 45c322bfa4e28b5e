#pragma once
// The sub-commands of `taktwerk drive`, by idea; what they share is in drive_access.hpp. Their texts are made by pure functions, so that
// tests read them.

#include <string>
#include <vector>

#include "apps/drive/access.hpp"
#include "axes/port/find_alarm.hpp"
#include "config/drive_file/parameter_set.hpp"

namespace taktwerk::apps {

void add_drive_identify(CLI::App& drive, Action& action);
void add_drive_params(CLI::App& drive, Action& action);
void add_drive_values(CLI::App& drive, Action& action);  ///< get, set
void add_drive_sets(CLI::App& drive, Action& action);    ///< save, restore, diff
void add_drive_alarms(CLI::App& drive, Action& action);  ///< alarms, reset
void add_drive_turns(CLI::App& drive, Action& action);   ///< clear-turns

/// What of these is no setting but does something when it is written: stores, restores, tunes, commands. Nothing: all are settings.
[[nodiscard]] std::optional<Error> needs_a_yes(const DriveAccess& drive, const std::vector<config::ParameterSet::Value>& values);
/// Asks on the terminal; without one only `yes` counts, and `refusal` is the answer.
[[nodiscard]] Result<void> confirm(const DriveAccess& drive, const Error& refusal, bool yes);
/// "P05.13=300 ms": the words of `drive set`. Errors: drive.value, drive.twice, those of axes::find_parameter and axes::parse_value.
[[nodiscard]] Result<std::vector<config::ParameterSet::Value>> parsed_assignments(const axes::DriveProfile& profile,
                                                                                  const std::vector<std::string>& words);

struct Change {
    const axes::DriveParameter* parameter = nullptr;
    std::optional<std::int64_t> from;  ///< nothing: the drive does not say what it was
    std::int64_t to = 0;
};

struct Written {
    std::vector<Change> changes;     ///< those before an error, too
    std::vector<std::string> notes;  ///< for the user: EEPROM, restarts
    std::size_t acts = 0;            ///< written that are no settings; the notes say which
    std::optional<Error> error;
};
/// Writes what differs and reads each back. With storing asked everything is stored, whether it differs or not: what is in force may never
/// have been. The drive's storage switch (SV33-E P05.10) is afterwards as it was, also after an error and Ctrl-C.
[[nodiscard]] Written write_values(DriveAccess& drive, const std::vector<config::ParameterSet::Value>& values, Storing storing);
/// Prints it as the options want; returns the exit code.
int report_written(const BusOptions& options, const DriveAccess& drive, const Written& written);

/// A setting that is not in a set or not compared, and why.
struct LeftOut {
    const axes::DriveParameter* parameter = nullptr;
    std::string why;
};
enum class Kept : std::uint8_t { all, unlike_factory };
/// What `save` keeps: settings that `restore` and `diff` take back. A drive shows values which its own manual does not allow (SE-808X 2000h:07
/// reads 0, least is 1), and some cannot be read: those are left out, and the file says so.
struct KeptSettings {
    config::ParameterSet set;
    std::vector<LeftOut> left_out;
};
/// Errors: those of the way to the drive; half a set is none.
[[nodiscard]] Result<KeptSettings> kept_settings(DriveAccess& drive, Kept kept);
[[nodiscard]] std::string text_of(const KeptSettings& settings);

struct SetDifference {
    std::vector<Change> changes;    ///< from the set to the drive
    std::vector<LeftOut> left_out;  ///< the drive does not let read them (SE-808X 6098h)
    std::size_t not_stated = 0;     ///< against the factory: what its manual does not state, nobody can compare
};
/// Errors: those of the way to the drive.
[[nodiscard]] Result<SetDifference> difference_from(DriveAccess& drive, const config::ParameterSet& set);
[[nodiscard]] Result<SetDifference> difference_from_factory(DriveAccess& drive);

/// A table of parameters; `values` empty or as many as parameters.
[[nodiscard]] std::string params_text(const std::vector<const axes::DriveParameter*>& parameters,
                                      const std::vector<std::optional<std::int64_t>>& values, Colours colours);
/// "P05.13 (brake release)  250 ms -> 300 ms".
[[nodiscard]] std::string changes_text(const std::vector<Change>& changes, Colours colours);
[[nodiscard]] Json change_json(const Change& change);
[[nodiscard]] Json parameter_json(const axes::DriveParameter& parameter);

/// What stands on the drive, in its manual's words; code 0: no alarm.
[[nodiscard]] std::string alarm_text(const std::string& subject, const axes::DriveProfile& profile, const axes::ShownAlarm& alarm,
                                     Colours colours);

}  // namespace taktwerk::apps
