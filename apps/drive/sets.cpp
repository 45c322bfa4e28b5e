// taktwerk drive save, restore, diff: all settings of a drive as a file.

#include <fstream>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using config::ParameterSet;

struct SetFileOptions {
    std::shared_ptr<DriveOptions> drive;
    std::string file;
    bool all = false;
};

void print_left_out(const std::vector<LeftOut>& left_out) {
    if (left_out.empty()) return;
    fmt::print(stderr, "{} left out:\n", left_out.size() == 1 ? "1 parameter is" : count_text(left_out.size(), "parameter") + " are");
    for (const auto& out : left_out) fmt::print(stderr, "  {} ({}): {}\n", axes::name_of(*out.parameter), out.parameter->name, out.why);
}

Json left_out_json(const std::vector<LeftOut>& left_out) {
    auto out = Json::array();
    for (const auto& one : left_out) out.push_back(Json{{"parameter", axes::name_of(*one.parameter)}, {"why", one.why}});
    return out;
}

int save(const SetFileOptions& options) {
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto read = kept_settings(drive, options.all ? Kept::all : Kept::unlike_factory);
        if (!read) return fail(*options.drive->bus, read.error());
        const auto& kept = *read;
        std::ofstream file(options.file);
        file << (options.all ? "# All settings.\n"
                             : "# Settings that differ from the factory value in the drive's manual, and all of which it prints none; "
                               "--all saves every one.\n")
             << text_of(kept);
        file.close();
        if (!file) return fail(*options.drive->bus, Error{"capture.write", options.file, "cannot be written", "choose another file"});
        if (options.drive->bus->json) {
            print_json(
                Json{{"ok", true}, {"file", options.file}, {"values", kept.set.values.size()}, {"left_out", left_out_json(kept.left_out)}});
        } else {
            print_left_out(kept.left_out);
            fmt::print("{}: {} in {}\n", drive.subject(), count_text(kept.set.values.size(), "value"), options.file);
        }
        return static_cast<int>(exit_ok);
    });
}

int bad_file(const SetFileOptions& options, const std::vector<Error>& errors) {
    if (options.drive->bus->json) {
        auto all = Json::array();
        for (const auto& error : errors) all.push_back(error_json(error));
        print_json(Json{{"ok", false}, {"errors", all}});
    } else {
        print_errors(errors);
    }
    return exit_bad_file;
}

int restore(const SetFileOptions& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto read = config::read_parameter_set(options.file, drive.profile());
        if (const auto* errors = std::get_if<std::vector<Error>>(&read)) return bad_file(options, *errors);
        const auto written = write_values(drive, std::get<ParameterSet>(read).values, options.drive->storing);
        return report_written(bus, drive, written);
    });
}

int print_difference(const SetFileOptions& options, const DriveAccess& drive, const SetDifference& difference) {
    const auto& changes = difference.changes;
    if (options.drive->bus->json) {
        auto json = Json{{"drive", drive.subject()},
                         {"same", changes.empty()},
                         {"not_compared", difference.not_stated + difference.left_out.size()},
                         {"differences", Json::array()}};
        for (const auto& change : changes) json["differences"].push_back(change_json(change));
        if (!difference.left_out.empty()) json["left_out"] = left_out_json(difference.left_out);
        print_json(json);
        return exit_ok;
    }
    const auto other = options.file.empty() ? std::string("the factory's values, as far as the manual states them") : options.file;
    print_left_out(difference.left_out);
    if (changes.empty()) fmt::print("{}: as {}\n", drive.subject(), other);
    else
        fmt::print("{}: {} from {} (was) to the drive (is)\n{}", drive.subject(), count_text(changes.size(), "difference"), other,
                   changes_text(changes, colours_of_output()));
    if (difference.not_stated > 0)
        fmt::print("{} not compared: the manual states no factory value\n", count_text(difference.not_stated, "parameter"));
    return exit_ok;
}

int diff(const SetFileOptions& options) {
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto read = options.file.empty() ? std::variant<ParameterSet, std::vector<Error>>{}
                                               : config::read_parameter_set(options.file, drive.profile());
        if (const auto* errors = std::get_if<std::vector<Error>>(&read)) return bad_file(options, *errors);
        const auto found = options.file.empty() ? difference_from_factory(drive) : difference_from(drive, std::get<ParameterSet>(read));
        return found ? print_difference(options, drive, *found) : fail(*options.drive->bus, found.error());
    });
}

}  // namespace

void add_drive_sets(CLI::App& drive, Action& action) {
    auto* saving = drive.add_subcommand("save", "the drive's settings into a file; reads only");
    auto options = std::make_shared<SetFileOptions>();
    options->drive = add_drive_options(*saving);
    add_drive_choice(*saving, *options->drive);
    saving->add_option("FILE", options->file, "is overwritten")->required();
    saving->add_flag("--all", options->all, "also those that are as the manual says that they left the factory");
    saving->callback([&action, options] { action = [options] { return save(*options); }; });

    auto* restoring = drive.add_subcommand("restore", "write what differs from a file");
    auto restore_options = std::make_shared<SetFileOptions>();
    restore_options->drive = add_drive_options(*restoring);
    add_drive_choice(*restoring, *restore_options->drive);
    restoring->add_option("FILE", restore_options->file, "as `save` wrote it")->required();
    add_store_option(*restoring, *restore_options->drive);
    restoring->callback([&action, restore_options] { action = [restore_options] { return restore(*restore_options); }; });

    auto* comparing = drive.add_subcommand("diff", "how the drive differs from a file, or from the factory's values");
    auto diff_options = std::make_shared<SetFileOptions>();
    diff_options->drive = add_drive_options(*comparing);
    add_drive_choice(*comparing, *diff_options->drive);
    comparing->add_option("FILE", diff_options->file, "as `save` wrote it; default: the factory's values");
    comparing->callback([&action, diff_options] { action = [diff_options] { return diff(*diff_options); }; });
}

}  // namespace taktwerk::apps
