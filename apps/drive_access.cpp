#include "apps/drive_access.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/exit_code.hpp"
#include "apps/load.hpp"
#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/port/parameter_text.hpp"
#include "config/drive_library.hpp"
#include "ecat/bringup/slave_match.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"

namespace taktwerk::apps {

namespace {

ecat::Script<Result<std::vector<std::byte>>> upload(ecat::Bus& bus, ecat::BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    if (slave.mailbox.station == 0) {
        const Result<void> opened = co_await ecat::open_mailbox(bus, slave);
        if (!opened) co_return opened.error();
    }
    co_return co_await ecat::read_object(bus, slave, index, sub);
}

ecat::Script<Result<void>> download(ecat::Bus& bus, ecat::BusSlave& slave, std::uint16_t index, std::uint8_t sub,
                                    std::vector<std::byte> value) {
    if (slave.mailbox.station == 0) {
        const Result<void> opened = co_await ecat::open_mailbox(bus, slave);
        if (!opened) co_return opened.error();
    }
    co_return co_await ecat::write_object(bus, slave, index, sub, std::move(value));
}

/// Of the machine file; none when it has no axis on this slave.
std::shared_ptr<const axes::DriveProfile> profile_in_machine(const DriveOptions& options, const std::string& slave) {
    if (options.bus->machine.empty() || slave.empty()) return nullptr;
    auto result = read_machine_without_programs(options.bus->machine, options.bus->simulate);
    if (const auto* loaded = std::get_if<LoadedFile>(&result))
        for (const auto& binding : loaded->machine.axes)
            if (binding.slave == slave) return binding.profile;
    return nullptr;
}

Result<std::shared_ptr<const axes::DriveProfile>> find_profile(const DriveOptions& options, const ecat::Survey& survey,
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

}  // namespace

std::shared_ptr<DriveOptions> add_drive_options(CLI::App& sub) {
    auto options = std::make_shared<DriveOptions>();
    options->bus = add_bus_options(sub);
    sub.add_option("--profile", options->profile, "kind of drive; default: as the machine file or its identity says")->type_name("NAME");
    return options;
}

void add_drive_choice(CLI::App& sub, DriveOptions& options) {
    sub.add_option("DRIVE", options.drive, "position or name on the bus")->required();
    sub.add_option("--axis", options.axis, "of a drive with several axes, from 1")->check(CLI::Range(1, 8));
}

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
    return Error{"drive.no_profile", name, "there is no such kind of drive", fmt::format("there is: {}", fmt::join(library.names(), ", "))};
}

std::vector<std::string> profiles_of(const DriveOptions& options, const ecat::SurveyedSlave& slave) {
    config::DriveLibrary library(drive_folders(options.bus->machine));
    std::vector<std::string> out;
    for (const auto& name : library.names()) {
        const auto* drive = library.find(name);
        if (drive && drive->device && ecat::check_identity("", *drive->device, slave.found.identity)) out.push_back(name);
    }
    return out;
}

std::string DriveAccess::subject() const {
    return profile_->axes > 1 ? fmt::format("{}, axis {} of {}", slave_->subject, axis_, profile_->axes) : slave_->subject;
}

std::uint16_t DriveAccess::index_of(const axes::ParameterAddress& address) const noexcept {
    const bool per_axis = address.index >= 0x2000;
    return static_cast<std::uint16_t>(address.index + (per_axis ? (axis_ - 1) * profile_->object_offset : 0));
}

Result<std::vector<std::byte>> DriveAccess::read_bytes(const axes::ParameterAddress& address) {
    return session_.probe().run(upload(session_.bus(), *slave_, index_of(address), address.sub));
}

Result<std::int64_t> DriveAccess::read(const axes::DriveParameter& parameter) {
    const auto bytes = read_bytes(parameter.address);
    if (!bytes) return bytes.error();
    return axes::from_bytes(parameter, *bytes);
}

Result<void> DriveAccess::write(const axes::DriveParameter& parameter, std::int64_t raw) {
    return session_.probe().run(
        download(session_.bus(), *slave_, index_of(parameter.address), parameter.address.sub, axes::to_bytes(parameter, raw)));
}

Result<bool> DriveAccess::reset_fault(Duration patience) {
    const auto& configured = session_.configured();
    const auto position = slave_->found.position;
    if (configured.slaves.empty())
        return Error{"drive.not_reset", subject(), "a reset needs process data, and no machine file says which", "give --machine FILE"};
    if (auto up = session_.bring_up(survey_); !up) return up.error();
    const auto slave = slave_at(session_, survey_, position);
    if (!slave) return slave.error();
    slave_ = *slave;
    const Duration cycle = configured.cycle;
    axes::cia402::Cia402Drive port(session_.probe().master(), slave_->index, static_cast<std::uint8_t>(axis_ - 1), profile_, cycle);
    if (auto resolved = port.resolve(); !resolved) return resolved.error();
    axes::DriveCommand command;  // power off, at rest
    const auto round = [&](bool reset) -> Result<axes::DriveFeedback> {
        if (auto ran = session_.probe().run_for(cycle); !ran) return ran.error();
        const auto feedback = port.decode(session_.now());
        command.position = feedback.position;
        command.reset_fault = reset;
        port.encode(command, session_.now());
        return feedback;
    };
    for (Duration spent{}; spent < patience; spent += cycle) {
        const auto feedback = round(true);
        if (!feedback) return feedback.error();
        if (feedback->online && feedback->power != axes::PowerState::unknown && !feedback->fault) {
            for (int i = 0; i < 10; ++i) (void)round(false);  // bit 7 back to 0
            return true;
        }
    }
    (void)round(false);
    return false;
}

void DriveAccess::wait(Duration time) { (void)session_.probe().run_for(time); }  // interrupted: the next access says so

int with_drive(const DriveOptions& options, const std::function<int(DriveAccess&)>& work) {
    return with_bus(*options.bus, [&](BusSession& session) {
        const auto refuse = [&](const Error& error) { return fail(*options.bus, error); };
        const Result<ecat::Survey> found = session.look();
        if (!found) return refuse(found.error());
        const Result<std::size_t> position = find_slave(*found, options.drive);
        if (!position) return refuse(position.error());
        const auto profile = find_profile(options, *found, *position);
        if (!profile) return refuse(profile.error());
        if (options.axis > (*profile)->axes)
            return refuse({"drive.no_axis", found->subject(*position),
                           fmt::format("{} has {}", (*profile)->name, count_text((*profile)->axes, "axis")),
                           "leave --axis away, or choose one it has"});
        if (auto allowed = session.may_write(*found, "speaking to its mailboxes"); !allowed) return refuse(allowed.error());
        session.adopt(*found);
        const Result<ecat::BusSlave*> slave = slave_at(session, *found, *position);
        if (!slave) return refuse(slave.error());
        DriveAccess access(session, *found, **slave, *profile, options.axis);
        return work(access);
    });
}

}  // namespace taktwerk::apps
