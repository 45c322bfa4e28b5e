// taktwerk bus firmware: new firmware into a slave, over BOOT, and what it is left with.

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "apps/bus/foe.hpp"
#include "apps/bus/kept_file.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/wire/al_status.hpp"

namespace taktwerk::apps {

namespace {

using ecat::FirmwareLeft;
using ecat::FirmwareOutcome;
using ecat::FirmwareStage;

/// Nobody else works with these slaves: the one that is written is gone for a while, and so may be what is behind it.
Result<void> may_write_firmware(BusSession& session, const ecat::Survey& survey, std::size_t position) {
    if (auto alone = session.must_be_alone("writing firmware"); !alone) return alone;
    if (survey.slaves.at(position).found.error) return *survey.slaves[position].found.error;
    if (survey.highest_state >= ecat::AlState::safeop)
        return Error{
            "firmware.in_operation", session.where(),
            fmt::format("slaves are in {}: firmware is written while nothing works with the bus", ecat::name(survey.highest_state)),
            "taktwerk bus state init takes them down"};
    return {};
}

/// Of simulated slaves, too: a rehearsal goes as the thing itself.
Result<void> confirm_firmware(const FoeOptions& options, const std::string& subject, std::size_t bytes) {
    if (options.bus->yes) return {};
    const std::string what = fmt::format("{} ({} bytes) goes into {} as '{}'", options.file, bytes, subject, options.name);
    if (::isatty(STDIN_FILENO) == 0)
        return Error{"bus.not_confirmed", subject, fmt::format("{}; nobody was there to say yes, and nothing was written", what),
                     "a wrong file, or a power cut meanwhile, can leave the slave without firmware: check, then say --yes"};
    fmt::print(stderr, "{}. A wrong file, or a power cut meanwhile, can leave it without firmware. Write it? [y/N] ", what);
    std::string answer;
    std::getline(std::cin, answer);
    if (answer == "y" || answer == "Y" || answer == "yes") return {};
    return Error{"bus.not_confirmed", subject, "nothing was written", ""};
}

const char* stage_text(FirmwareStage stage) {
    switch (stage) {
        case FirmwareStage::looking: return "";
        case FirmwareStage::entering_boot: return "to BOOT";
        case FirmwareStage::writing: return "writing; leave cable and power alone, Ctrl-C has no effect until it is over";
        case FirmwareStage::leaving_boot: return "all of it is in the slave; to INIT, its application starts anew";
        case FirmwareStage::comparing:
        case FirmwareStage::done: return "";
    }
    return "";
}

Json version_json(const ecat::DeviceVersion& version) {
    Json json{{"vendor", version.eeprom.vendor},
              {"product", version.eeprom.product},
              {"revision", version.eeprom.revision},
              {"serial", version.eeprom.serial}};
    if (version.revision) json["object_revision"] = *version.revision;
    if (!version.hardware.empty()) json["hardware"] = version.hardware;
    if (!version.software.empty()) json["software"] = version.software;
    return json;
}

const char* word(FirmwareLeft left) {
    switch (left) {
        case FirmwareLeft::untouched: return "untouched";
        case FirmwareLeft::broken: return "broken";
        case FirmwareLeft::complete: return "complete";
    }
    return "";
}

void say_done(const std::string& subject, std::size_t bytes, const FirmwareOutcome& outcome) {
    fmt::print("{}: {} bytes written; it is back, in {}\n", subject, bytes, ecat::name(outcome.left.state));
    const auto differs = ecat::changes(*outcome.before, *outcome.after);
    for (const auto& line : differs) fmt::print("  {}\n", line);
    if (differs.empty())
        fmt::print("  it says the same of itself as before: {}. Some slaves start new firmware only when they are switched on\n",
                   ecat::text(*outcome.after));
}

int write_firmware(BusSession& session, const FoeOptions& options, std::uint32_t password, const std::vector<std::byte>& content) {
    const auto& bus = *options.bus;
    const auto found = session.look();
    if (!found) return fail(bus, found.error());
    const auto position = find_slave(*found, options.slave);
    if (!position) return fail(bus, position.error());
    if (const auto may = may_write_firmware(session, *found, *position); !may) return fail(bus, may.error());
    session.adopt(*found);
    const auto slave = slave_at(session, *found, *position);
    if (!slave) return fail(bus, slave.error());
    const std::string& subject = (*slave)->subject;
    if (const auto offered = offers_files(**slave, bus); !offered) return fail(bus, offered.error());
    if (const auto confirmed = confirm_firmware(options, subject, content.size()); !confirmed) return fail(bus, confirmed.error());
    session.finish_undisturbed();
    FoeProgressLine line{bus};
    ecat::FirmwareSettings settings;
    settings.foe = foe_settings(options, line);
    settings.stage = [&](FirmwareStage stage) {
        line.end();
        const std::string text = stage_text(stage);
        if (!text.empty() && !bus.json) fmt::print(stderr, "{}: {}\n", subject, text);
    };
    const auto outcome = session.probe().run(ecat::update_firmware(session.bus(), **slave, {options.name, password}, content, settings));
    line.end();
    if (!outcome) return fail(bus, outcome.error());
    if (bus.json) print_json(firmware_json(subject, content.size(), *outcome));
    if (outcome->failure) return bus.json ? exit_code_for(*outcome->failure) : fail(bus, firmware_error(*outcome));
    if (!bus.json) say_done(subject, content.size(), *outcome);
    return exit_ok;
}

}  // namespace

Error firmware_error(const FirmwareOutcome& outcome) {
    Error error = *outcome.failure;
    error.what += "; " + ecat::left_text(outcome.left, outcome.firmware());
    const std::string back = ecat::way_back(outcome.left, outcome.firmware());
    if (outcome.firmware() != FirmwareLeft::untouched && !error.remedy.empty()) error.remedy += "; then: " + back;
    if (error.remedy.empty()) error.remedy = back;
    return error;
}

Json firmware_json(const std::string& subject, std::size_t bytes, const FirmwareOutcome& outcome) {
    Json json{{"ok", !outcome.failure.has_value()}, {"slave", subject}, {"bytes", bytes}, {"acknowledged", outcome.acknowledged}};
    json["firmware"] = word(outcome.firmware());
    json["state"] = outcome.left.silent ? "silent" : std::string{ecat::name(outcome.left.state)};
    if (outcome.left.code != 0) json["al_status_code"] = outcome.left.code;
    if (outcome.before) json["before"] = version_json(*outcome.before);
    if (outcome.after) json["after"] = version_json(*outcome.after);
    if (outcome.before && outcome.after) json["changes"] = ecat::changes(*outcome.before, *outcome.after);
    if (outcome.failure) json["error"] = error_json(firmware_error(outcome));
    return json;
}

void add_bus_firmware(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("firmware", "new firmware into a slave (FoE in BOOT); says what it is left with whatever happens");
    auto options = std::make_shared<FoeOptions>();
    options->bus = add_bus_options(*sub);
    sub->get_option("--force")->description("also where its EEPROM says that it has no FoE (never beside another master)");
    sub->add_option("SLAVE", options->slave, "position or name")->required();
    sub->add_option("FILE", options->file, "on this computer, as the slave's maker delivers it")->required();
    const auto* name = sub->add_option("--name", options->name, "what the slave calls it; default: the file's name without its ending");
    add_foe_options(*sub, *options);
    sub->add_flag("--yes", options->bus->yes, "do not ask before it is written");
    sub->callback([&action, options, name] {
        if (name->count() == 0) options->name = std::filesystem::path(options->file).stem().string();
        action = [options]() -> int {
            const auto password = password_of(options->password);
            if (!password) return fail(*options->bus, password.error());
            if (const auto named = check_slave_file_name(options->name, "--name"); !named) return fail(*options->bus, named.error());
            // All of it, before the slave is spoken to: a disk that cannot be read leaves no slave without firmware.
            const auto content = read_whole_file(options->file, ecat::largest_slave_file, "foe.file");
            if (!content) return fail(*options->bus, content.error());
            if (content->empty()) return fail(*options->bus, Error{"foe.file", options->file, "is empty", "give the firmware's file"});
            return with_bus(*options->bus, [&](BusSession& session) { return write_firmware(session, *options, *password, *content); });
        };
    });
}

}  // namespace taktwerk::apps
