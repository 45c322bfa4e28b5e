// taktwerk drive: one drive by its manual's names and units: who it is, its parameters, sets of them, its alarm.

#include "apps/drive/drive.hpp"

namespace taktwerk::apps {

void add_drive(CLI::App& app, Action& action) {
    auto* drive = app.add_subcommand("drive", "one drive by its manual's names: identify, parameters, sets of them, alarms");
    drive->require_subcommand(1);
    add_drive_identify(*drive, action);
    add_drive_params(*drive, action);
    add_drive_values(*drive, action);
    add_drive_sets(*drive, action);
    add_drive_alarms(*drive, action);
    add_drive_turns(*drive, action);
}

}  // namespace taktwerk::apps
