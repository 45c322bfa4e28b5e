// taktwerk drive clear-turns: an absolute encoder forgets its turns. Guarded: asked for by name, at a motor without power, and the axis has no
// reference until it is homed again.

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {

namespace {

int clear_turns(const DriveOptions& options) {
    return with_drive(options, [&](DriveAccess& drive) {
        const Error refusal{"drive.not_confirmed", drive.subject(),
                            "the encoder forgets its turns: the position becomes another, and the axis must be homed",
                            "say --yes if that is meant"};
        if (const auto sure = confirm(drive, refusal, options.bus->yes); !sure) return fail(*options.bus, sure.error());
        if (const auto done = drive.clear_turns(); !done) return fail(*options.bus, done.error());
        if (options.bus->json) print_json(Json{{"ok", true}, {"drive", drive.subject()}});
        else fmt::print("{}: the turns are cleared; home the axis before it moves to positions\n", drive.subject());
        return static_cast<int>(exit_ok);
    });
}

}  // namespace

void add_drive_turns(CLI::App& drive, Action& action) {
    auto* sub = drive.add_subcommand("clear-turns", "an absolute encoder forgets its turns; the axis must be homed afterwards");
    auto options = add_drive_options(*sub);
    add_drive_choice(*sub, *options);
    sub->add_flag("--yes", options->bus->yes, "do not ask before");
    sub->callback([&action, options] { action = [options] { return clear_turns(*options); }; });
}

}  // namespace taktwerk::apps
