#include "apps/drive/profiles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/machine/load.hpp"
#include "config/drive_file/drive_library.hpp"
#include "core/nearest_name.hpp"
#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::apps {

namespace {

/// Of the machine file; none when it has no axis on this slave.
std::shared_ptr<const axes::DriveProfile> profile_in_machine(const DriveOptions& options, const std::string& slave) {
    if (options.bus->machine.empty() || slave.empty()) return nullptr;
    auto result = read_machine_without_programs(options.bus->machine, options.bus->simulate);
    if (const auto* loaded = std::get_if<LoadedFile>(&result))
        for (const auto& binding : loaded->machine.axes)
            if (binding.slave == slave) return binding.profile;
    return nullptr;
}

}  // namespace

std::vector<std::shared_ptr<const axes::DriveProfile>> known_profiles(const DriveOptions& options) {
    config::DriveLibrary library(drive_folders(options.bus->machine));
    std::vector<std::shared_ptr<const axes::DriveProfile>> out;
    for (const auto& name : library.names())
        if (const auto* drive = library.find(name)) out.push_back(drive->profile);
    return out;
}

Result<std::shared_ptr<const axes::DriveProfile>> profile_named(const DriveOptions& options, const std::string& name) {
    config::DriveLibrary library(drive_folders(options.bus->machine));
    if (const auto* drive = library.find(name)) return drive->profile;
    if (!library.errors().empty()) return library.errors().front();
    const auto names = library.names();
    const auto near = nearest_name(name, names);
    if (names.empty())
        return Error{"drive.no_profile", name, "no drive description was found at all",
                     "name the machine file, whose `drives:` are looked through, or install Taktwerk with its own"};
    return Error{
        "drive.no_profile", name, "there is no such kind of drive",
        fmt::format("{}there is: {}", near.empty() ? std::string{} : fmt::format("did you mean {}? ", near), fmt::join(names, ", "))};
}

std::vector<std::string> profiles_of(const DriveOptions& options, const ecat::SurveyedSlave& slave) {
    config::DriveLibrary library(drive_folders(options.bus->machine));
    std::vector<std::string> out;
    for (const auto& name : library.names()) {
        const auto* drive = library.find(name);
        if (drive && drive->device && ecat::recognises(*drive->device, slave.found.identity)) out.push_back(name);
    }
    return out;
}

Result<std::shared_ptr<const axes::DriveProfile>> profile_of_slave(const DriveOptions& options, const ecat::Survey& survey,
                                                                   std::size_t position) {
    if (!options.profile.empty()) return profile_named(options, options.profile);
    const auto& slave = survey.slaves.at(position);
    if (auto profile = profile_in_machine(options, slave.name)) return profile;
    const auto fitting = profiles_of(options, slave);
    if (fitting.size() == 1) return profile_named(options, fitting.front());
    if (fitting.empty())
        return Error{"drive.no_profile", survey.subject(position), fmt::format("no drive file has {}", ecat::found_text(slave.found)),
                     "say which it is: --profile NAME"};
    return Error{"drive.no_profile", survey.subject(position), fmt::format("it may be {}", fmt::join(fitting, " or ")),
                 "say which it is: --profile NAME"};
}

}  // namespace taktwerk::apps
