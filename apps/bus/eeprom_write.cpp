// taktwerk bus eeprom write|alias: changes what a slave says of itself. A backup first, all of it read back, put back when it fails.

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/eeprom/eeprom_write.hpp"
#include "ecat/eeprom/sii_fields.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Survey;

struct Change {
    std::function<Result<EepromImage>(const EepromImage& before)> after;  ///< from what is in the slave to what shall be in it
    std::size_t bytes = 0;                                                ///< of the image that goes into it
    bool asks = false;                                                    ///< somebody has to say yes
    std::string afterwards;                                               ///< when it counts
};

/// Nobody else works with these slaves: what was said over another master's head would be half of two things.
Result<void> may_change_eeprom(BusSession& session, const Survey& survey, std::size_t position) {
    if (auto alone = session.must_be_alone("writing to an EEPROM"); !alone) return alone;
    if (survey.slaves.at(position).found.error) return *survey.slaves[position].found.error;
    if (survey.highest_state >= ecat::AlState::safeop)
        return Error{
            "eeprom.in_operation", session.where(),
            fmt::format("slaves are in {}: an EEPROM is written while nothing works with the bus", ecat::name(survey.highest_state)),
            "taktwerk bus state init takes them down"};
    return {};
}

Result<void> confirm_eeprom(BusSession& session, const EepromOptions& options, const std::string& subject) {
    if (session.simulated() || options.bus->yes) return {};
    if (::isatty(STDIN_FILENO) == 0)
        return Error{"bus.not_confirmed", subject,
                     "a wrong EEPROM makes a slave useless until it is written back; nobody was there to say yes",
                     "see what differs, then say --yes; nothing was written"};
    fmt::print(stderr, "Write that to {}? A wrong EEPROM makes a slave useless until it is written back. [y/N] ", subject);
    std::string answer;
    std::getline(std::cin, answer);
    if (answer == "y" || answer == "Y" || answer == "yes") return {};
    return Error{"bus.not_confirmed", subject, "nothing was written", ""};
}

std::string bus_words(const BusOptions& options) {
    std::string text;
    if (!options.nic.empty()) text += " --nic " + options.nic;
    if (!options.machine.empty()) text += " --machine " + options.machine;
    return text;
}

/// What failed, and in what state the slave is left.
Error in_words(const ecat::EepromWriting& writing, const EepromOptions& options, std::size_t position, const std::string& backup) {
    Error error = *writing.failure;
    if (writing.restored) {
        error.what += "; the EEPROM holds again what it held before";
        return error;
    }
    error.what += fmt::format("; {} had been written, and putting back failed, too: what the EEPROM holds is not known",
                              count_text(writing.words, "word"));
    error.remedy = fmt::format(
        "leave the slave switched on where you can, until then it works as before; then write the backup: taktwerk bus eeprom write {} "
        "{}{} --force",
        position, backup, bus_words(*options.bus));
    return error;
}

int change_eeprom(BusSession& session, const EepromOptions& options, const Survey& survey, std::size_t position, const Change& change) {
    const auto& bus = *options.bus;
    const auto subject = survey.subject(position);
    if (const auto may = may_change_eeprom(session, survey, position); !may) return fail(bus, may.error());
    const auto before = read_eeprom_of(session, survey, position, change.bytes);
    if (!before) return fail(bus, before.error());
    const auto after = change.after(*before);
    if (!after) return fail(bus, after.error());
    if (*after == *before) {
        if (bus.json) print_json(Json{{"ok", true}, {"slave", subject}, {"words", 0}, {"changes", Json::array()}});
        else fmt::print("{}: its EEPROM holds just that; nothing was written\n", subject);
        return exit_ok;
    }
    const auto backup = back_up_eeprom(options.folder, static_cast<std::uint16_t>(position), *before);
    if (!backup) return fail(bus, backup.error());
    // Said before the first word is written: when the power goes now, that is where the way back begins.
    auto* out = bus.json ? stderr : stdout;
    fmt::print(out, "{}: {}backup of what is there: {}\n", subject,
               bus.json ? std::string{} : eeprom_changes_text(*before, *after, colours_of_output()), *backup);
    std::fflush(out);
    if (change.asks)
        if (const auto confirmed = confirm_eeprom(session, options, subject); !confirmed) return fail(bus, confirmed.error());
    session.finish_undisturbed();
    const auto writing =
        session.probe().run(ecat::write_eeprom(session.probe().port(), survey.slaves[position].found.station, *before, *after, subject));
    if (!writing) return fail(bus, writing.error());
    if (writing->failure) return fail(bus, in_words(*writing, options, position, *backup));
    if (bus.json)
        print_json(Json{{"ok", true},
                        {"slave", subject},
                        {"words", writing->words},
                        {"backup", *backup},
                        {"changes", eeprom_changes_json(*before, *after)},
                        {"counts_after", "power_on"}});
    else fmt::print("{} written, and all of the EEPROM read back. {}\n", count_text(writing->words, "word"), change.afterwards);
    return exit_ok;
}

int write_file(BusSession& session, const EepromOptions& options, const EepromImage& file) {
    return with_eeprom(session, options, [&](const Survey& survey, std::size_t position) {
        Change change;
        change.after = [&](const EepromImage& before) { return eeprom_after(survey.subject(position), before, file, options.bus->force); };
        change.bytes = file.size();
        change.asks = true;
        change.afterwards = "The slave loads it at its next power-on: switch it off and on.";
        return change_eeprom(session, options, survey, position, change);
    });
}

/// Two slaves with one alias are found by neither.
Result<void> alias_is_free(const Survey& survey, std::size_t position, std::uint16_t alias) {
    for (std::size_t i = 0; i < survey.slaves.size() && alias != 0; ++i) {
        const auto& other = survey.slaves[i].found;
        if (i == position || other.error || (other.alias != alias && other.sii.alias != alias)) continue;
        return Error{"eeprom.alias_taken", survey.subject(position), fmt::format("{} has alias {} already", survey.subject(i), alias),
                     "choose another number, or give that one another alias first; with --force it is written all the same"};
    }
    return {};
}

int write_alias(BusSession& session, const EepromOptions& options) {
    return with_eeprom(session, options, [&](const Survey& survey, std::size_t position) {
        if (const auto unused = alias_is_free(survey, position, options.alias); !unused && !options.bus->force)
            return fail(*options.bus, unused.error());
        Change change;
        change.after = [&](const EepromImage& before) {
            return eeprom_with_alias(survey.subject(position), before, options.alias, options.bus->force);
        };
        change.afterwards = options.alias == 0
                                ? std::string{"From the next power-on of the slave it has no alias."}
                                : fmt::format(
                                      "The alias counts from the next power-on of the slave: switch it off and on. `alias: {}` instead "
                                      "of a position then names it in the machine file.",
                                      options.alias);
        return change_eeprom(session, options, survey, position, change);
    });
}

std::shared_ptr<EepromOptions> add_writing(CLI::App& sub, const char* force) {
    auto options = std::make_shared<EepromOptions>();
    options->bus = add_bus_options(sub);
    sub.get_option("--force")->description(force);
    sub.add_option("SLAVE", options->slave, "position or name")->required();
    sub.add_option("-d,--directory", options->folder, "where the backup goes; default: this one")->type_name("DIR");
    return options;
}

}  // namespace

void add_eeprom_write(CLI::App& eeprom, Action& action) {
    auto* sub = eeprom.add_subcommand("write", "an image into a slave's EEPROM: backup, what differs, write, read back");
    auto options = add_writing(*sub, "also the image of another device, or a damaged one (never beside another master)");
    sub->add_option("FILE", options->file, "a binary image, such as read -o, backup and make write")->required();
    sub->add_flag("--yes", options->bus->yes, "do not ask before it is written");
    sub->callback([&action, options] {
        action = [options]() -> int {
            const auto file = read_eeprom_file(options->file);
            if (!file) return fail(*options->bus, file.error());
            return with_bus(*options->bus, [&](BusSession& session) { return write_file(session, *options, *file); });
        };
    });
}

void add_eeprom_alias(CLI::App& eeprom, Action& action) {
    auto* sub = eeprom.add_subcommand("alias", "sets the number by which a machine file names a slave wherever it is plugged in");
    auto options =
        add_writing(*sub, "also an alias that another slave has, or into an EEPROM whose checksum is wrong (never beside another master)");
    sub->add_option("ALIAS", options->alias, "1 to 65535; 0: none")->required();
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return write_alias(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
