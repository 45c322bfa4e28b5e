// taktwerk drive save, restore, diff: all settings of a drive as a file.

#include <fstream>

#include <fmt/format.h>

#include "apps/drive.hpp"
#include "apps/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using config::ParameterSet;

struct Options {
    std::shared_ptr<DriveOptions> drive;
    std::string file;
    bool all = false;
};

/// Every setting that the drive answers. What it does not have is left out and counted.
struct Present {
    ParameterSet set;
    std::vector<std::string> missing;
};

Present read_all(DriveAccess& drive) {
    Present out;
    out.set.drive = drive.profile().name;
    out.set.comment = fmt::format("{} on {}", drive.subject(), drive.where());
    for (const auto& parameter : drive.profile().parameters) {
        if (!axes::is_setting(parameter)) continue;
        if (const auto raw = drive.read(parameter)) out.set.values.push_back({&parameter, *raw});
        else out.missing.push_back(axes::name_of(parameter));
    }
    return out;
}

void print_missing(const std::vector<std::string>& missing) {
    if (missing.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < missing.size() && i < 8; ++i) names += (i ? ", " : "") + missing[i];
    fmt::print(stderr, "{} did not answer and {} left out: {}{}\n", count_text(missing.size(), "parameter"),
               missing.size() == 1 ? "is" : "are", names, missing.size() > 8 ? ", ..." : "");
}

int save(const Options& options) {
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        auto present = read_all(drive);
        if (!options.all)
            std::erase_if(present.set.values, [](const auto& value) { return value.parameter->is_stated_factory(value.raw); });
        std::ofstream file(options.file);
        file << (options.all ? "# All settings.\n"
                             : "# Settings that differ from the factory value in the drive's manual, and all of which it prints none; "
                               "--all saves every one.\n")
             << config::text_of(present.set);
        file.close();
        if (!file) return fail(*options.drive->bus, Error{"capture.write", options.file, "cannot be written", "choose another file"});
        print_missing(present.missing);
        if (options.drive->bus->json)
            print_json(Json{{"ok", true}, {"file", options.file}, {"values", present.set.values.size()}, {"missing", present.missing}});
        else fmt::print("{}: {} in {}\n", drive.subject(), count_text(present.set.values.size(), "value"), options.file);
        return static_cast<int>(exit_ok);
    });
}

int bad_file(const Options& options, const std::vector<Error>& errors) {
    if (options.drive->bus->json) {
        auto all = Json::array();
        for (const auto& error : errors) all.push_back(error_json(error));
        print_json(Json{{"ok", false}, {"errors", all}});
    } else {
        print_errors(errors);
    }
    return exit_bad_file;
}

int restore(const Options& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto read = config::read_parameter_set(options.file, drive.profile());
        if (const auto* errors = std::get_if<std::vector<Error>>(&read)) return bad_file(options, *errors);
        const auto written = write_values(drive, std::get<ParameterSet>(read).values, options.drive->storing);
        return report_written(bus, drive, written);
    });
}

/// Against a file, or against the factory's values.
int diff(const Options& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        std::vector<Change> changes;
        std::size_t unknown = 0;  // whether they are as the factory left them, nobody can say
        if (options.file.empty()) {
            for (const auto& value : read_all(drive).set.values) {
                if (value.parameter->factory != axes::FactoryValue::stated) ++unknown;
                else if (value.raw != value.parameter->value) changes.push_back({value.parameter, value.parameter->value, value.raw});
            }
        } else {
            const auto read = config::read_parameter_set(options.file, drive.profile());
            if (const auto* errors = std::get_if<std::vector<Error>>(&read)) return bad_file(options, *errors);
            for (const auto& value : std::get<ParameterSet>(read).values) {
                const auto now = drive.read(*value.parameter);
                if (!now) return fail(bus, now.error());
                if (*now != value.raw) changes.push_back({value.parameter, value.raw, *now});
            }
        }
        if (bus.json) {
            auto json =
                Json{{"drive", drive.subject()}, {"same", changes.empty()}, {"not_compared", unknown}, {"differences", Json::array()}};
            for (const auto& change : changes) json["differences"].push_back(change_json(change));
            print_json(json);
        } else {
            const auto other = options.file.empty() ? std::string("the factory's values, as far as the manual states them") : options.file;
            if (changes.empty()) fmt::print("{}: as {}\n", drive.subject(), other);
            else
                fmt::print("{}: {} from {} (was) to the drive (is)\n{}", drive.subject(), count_text(changes.size(), "difference"), other,
                           changes_text(changes, colours_of_output()));
            if (unknown > 0) fmt::print("{} not compared: the manual states no factory value\n", count_text(unknown, "parameter"));
        }
        return static_cast<int>(exit_ok);
    });
}

}  // namespace

void add_drive_sets(CLI::App& drive, Action& action) {
    auto* saving = drive.add_subcommand("save", "the drive's settings into a file; reads only");
    auto options = std::make_shared<Options>();
    options->drive = add_drive_options(*saving);
    add_drive_choice(*saving, *options->drive);
    saving->add_option("FILE", options->file, "is overwritten")->required();
    saving->add_flag("--all", options->all, "also those that are as the manual says that they left the factory");
    saving->callback([&action, options] { action = [options] { return save(*options); }; });

    auto* restoring = drive.add_subcommand("restore", "write what differs from a file");
    auto restore_options = std::make_shared<Options>();
    restore_options->drive = add_drive_options(*restoring);
    add_drive_choice(*restoring, *restore_options->drive);
    restoring->add_option("FILE", restore_options->file, "as `save` wrote it")->required();
    add_store_option(*restoring, *restore_options->drive);
    restoring->callback([&action, restore_options] { action = [restore_options] { return restore(*restore_options); }; });

    auto* comparing = drive.add_subcommand("diff", "how the drive differs from a file, or from the factory's values");
    auto diff_options = std::make_shared<Options>();
    diff_options->drive = add_drive_options(*comparing);
    add_drive_choice(*comparing, *diff_options->drive);
    comparing->add_option("FILE", diff_options->file, "as `save` wrote it; default: the factory's values");
    comparing->callback([&action, diff_options] { action = [diff_options] { return diff(*diff_options); }; });
}

}  // namespace taktwerk::apps
