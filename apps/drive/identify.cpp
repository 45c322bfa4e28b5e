// taktwerk drive identify: which kind of drive each slave is, and what its file assumes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/drive/drive.hpp"
#include "apps/drive/in_machine.hpp"
#include "apps/drive/over_line.hpp"
#include "apps/drive/profiles.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::apps {

namespace {

struct Identified {
    std::string subject, found, device;
    std::vector<std::string> fitting;
};

int show_identified(const DriveOptions& options, const std::vector<Identified>& slaves) {
    const auto profiles = known_profiles(options);
    const auto profile_of = [&](const std::string& name) -> const axes::DriveProfile* {
        for (const auto& profile : profiles)
            if (profile->name == name) return profile.get();
        return nullptr;
    };
    if (options.bus->json) {
        auto out = Json::array();
        for (const auto& slave : slaves) out.push_back(Json{{"slave", slave.subject}, {"says", slave.device}, {"profiles", slave.fitting}});
        print_json(out);
        return exit_ok;
    }
    const auto colours = colours_of_output();
    for (const auto& slave : slaves) {
        fmt::print("{}: {}{}\n", toned(slave.subject, Tone::strong, colours), slave.found,
                   slave.device.empty() ? "" : fmt::format(", says '{}'", slave.device));
        if (slave.fitting.empty()) fmt::print("  no drive file has this identity\n");
        for (const auto& name : slave.fitting) {
            const auto* profile = profile_of(name);
            fmt::print("  {}: {}, {}\n", toned(name, Tone::good, colours), profile->title, profile->vendor);
            if (slaves.size() > 1) continue;
            if (!profile->assumed.empty()) fmt::print("  its file assumes, because the manual leaves it open:\n");
            for (const auto& sentence : profile->assumed) fmt::print("    {}\n", wrapped(sentence, 4));
        }
    }
    return exit_ok;
}

/// What the running machine was configured with; nobody is asked anything on its bus.
int identify_in_machine(const DriveOptions& options) {
    const auto machine = drives_of_machine(options.socket);
    if (!machine) return fail(*options.bus, machine.error());
    std::vector<MachineDrive> drives = machine->drives;
    if (!options.drive.empty()) {
        const auto drive = find_drive(*machine, options.drive, options.axis);
        if (!drive) return fail(*options.bus, drive.error());
        drives = {*drive};
    }
    std::vector<Identified> out;
    for (const auto& drive : drives)
        out.push_back({fmt::format("axis {} ('{}')", drive.axis, drive.drive),
                       fmt::format("as machine '{}' is configured", machine->machine),
                       "",
                       {drive.profile}});
    return show_identified(options, out);
}

/// Drives on serial lines: those of the machine file, or the one that is meant.
Result<std::vector<Identified>> on_lines(const DriveOptions& options) {
    const auto found = identify_on_lines(options);
    if (!found) return found.error();
    std::vector<Identified> out;
    for (const auto& drive : *found) out.push_back({drive.subject, drive.says, "", {drive.profile}});
    return out;
}

int identify(const DriveOptions& options) {
    if (options.through_machine()) return identify_in_machine(options);
    if (is_on_line(options)) {
        const auto drives = on_lines(options);
        return drives ? show_identified(options, *drives) : fail(*options.bus, drives.error());
    }
    return with_bus(*options.bus, [&](BusSession& session) {
        const Result<ecat::Survey> found = session.look();
        if (!found) return fail(*options.bus, found.error());
        std::vector<std::size_t> positions;
        if (options.drive.empty()) {
            for (std::size_t i = 0; i < found->slaves.size(); ++i) positions.push_back(i);
        } else {
            const auto position = find_slave(*found, options.drive);
            if (!position) return fail(*options.bus, position.error());
            positions.push_back(*position);
        }
        std::vector<Identified> slaves;
        for (const auto position : positions) {
            const auto& slave = found->slaves[position];
            slaves.push_back({found->subject(position), ecat::found_text(slave.found), slave.device_name, profiles_of(options, slave)});
        }
        // Their ports are opened only where nobody else can have them: simulated ones, or one that is named.
        if (options.bus->simulate && options.drive.empty()) {
            const auto others = on_lines(options);
            if (!others) return fail(*options.bus, others.error());
            slaves.insert(slaves.end(), others->begin(), others->end());
        }
        return show_identified(options, slaves);
    });
}

}  // namespace

void add_drive_identify(CLI::App& drive, Action& action) {
    auto* sub = drive.add_subcommand("identify", "which kind of drive each slave is");
    auto options = add_drive_options(*sub);
    sub->add_option("DRIVE", options->drive, "position or name on the bus; default: all");
    sub->callback([&action, options] { action = [options] { return identify(*options); }; });
}

}  // namespace taktwerk::apps
