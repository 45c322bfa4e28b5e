// taktwerk bus eeprom read|show|backup: what is in the EEPROMs of slaves, to look at and to keep.

#include <cstdio>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "ecat/bringup/sii_reader.hpp"
#include "ecat/eeprom/eeprom_write.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Survey;

int read_one(BusSession& session, const EepromOptions& options, const Survey& survey, std::size_t position) {
    const auto image = read_eeprom_of(session, survey, position);
    if (!image) return fail(*options.bus, image.error());
    if (!options.file.empty())
        if (const auto written = write_eeprom_file(options.file, *image); !written) return fail(*options.bus, written.error());
    if (options.bus->json) {
        Json json{{"slave", survey.subject(position)}, {"position", position}};
        json.update(eeprom_json(*image));
        if (!options.file.empty()) json["file"] = options.file;
        print_json(json);
    } else {
        fmt::print("{}", eeprom_text(survey.subject(position), *image, colours_of_output()));
        if (!options.file.empty()) fmt::print("\n{} is written\n", options.file);
    }
    return exit_ok;
}

/// One slave after the other; what cannot be read is told, and the others are kept all the same.
int back_up(BusSession& session, const EepromOptions& options, const Survey& survey, const std::vector<std::size_t>& positions) {
    Json list = Json::array();
    int code = exit_ok;
    for (const auto position : positions) {
        const auto subject = survey.subject(position);
        auto image = read_eeprom_of(session, survey, position);
        auto path =
            image ? back_up_eeprom(options.folder, static_cast<std::uint16_t>(position), *image) : Result<std::string>{image.error()};
        Json one{{"slave", subject}, {"position", position}};
        if (path) one["file"] = *path, one["bytes"] = image->size();
        else one["error"] = error_json(path.error());
        list.push_back(std::move(one));
        if (path && !options.bus->json) fmt::print("{}: {} ({} bytes)\n", subject, *path, image->size());
        if (!path && !options.bus->json) print_error(path.error());
        if (!path && code == exit_ok) code = exit_code_for(path.error());
    }
    if (options.bus->json) print_json(Json{{"ok", code == exit_ok}, {"backups", std::move(list)}});
    return code;
}

int back_up_chosen(BusSession& session, const EepromOptions& options) {
    const auto found = session.look();
    if (!found) return fail(*options.bus, found.error());
    std::vector<std::size_t> positions;
    for (const auto& word : options.slaves) {
        if (word == "all") {
            positions.clear();
            break;
        }
        const auto position = find_slave(*found, word);
        if (!position) return fail(*options.bus, position.error());
        positions.push_back(*position);
    }
    if (positions.empty())
        for (std::size_t i = 0; i < found->slaves.size(); ++i) positions.push_back(i);
    const int code = back_up(session, options, *found, positions);
    give_eeproms_back(session, *found);
    return code;
}

int show_file(const EepromOptions& options, bool json) {
    const auto image = read_eeprom_file(options.file);
    if (!image) {
        BusOptions how;
        how.json = json;
        return fail(how, image.error());
    }
    if (json) print_json(eeprom_json(*image));
    else fmt::print("{}", eeprom_text(options.file, *image, colours_of_output()));
    return exit_ok;
}

}  // namespace

Result<EepromImage> read_eeprom_of(BusSession& session, const Survey& survey, std::size_t position, std::size_t bytes) {
    const auto& found = survey.slaves.at(position).found;
    if (found.error) return *found.error;
    const auto read = [&](std::optional<std::size_t> words) {
        return session.probe().run(ecat::read_eeprom(session.probe().port(), found.station, survey.subject(position), words));
    };
    auto image = read({});
    if (image && image->size() < bytes && ecat::parse_sii(*image).has(ecat::SiiDefect::empty)) return read(bytes / 2);
    return image;
}

void give_eeproms_back(BusSession& session, const Survey& survey) {
    // Then nothing was taken.
    if (survey.highest_state >= ecat::AlState::safeop || !session.must_be_alone("giving EEPROMs back")) return;
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        if (!slave.eeprom_with_pdi || slave.found.error) continue;
        const auto given = session.probe().run(ecat::give_eeprom_back(session.probe().port(), slave.found.station, survey.subject(i)));
        if (!given) print_warning(given.error());
    }
}

int with_eeprom(BusSession& session, const EepromOptions& options, const std::function<int(const Survey&, std::size_t)>& work) {
    const auto found = session.look();
    if (!found) return fail(*options.bus, found.error());
    const auto position = find_slave(*found, options.slave);
    if (!position) return fail(*options.bus, position.error());
    const int code = work(*found, *position);
    give_eeproms_back(session, *found);
    return code;
}

void add_eeprom_read(CLI::App& eeprom, Action& action) {
    auto* sub = eeprom.add_subcommand("read", "all that is in one slave's EEPROM: identity, alias, mailboxes, PDOs, clock, checksum");
    auto options = std::make_shared<EepromOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_option("SLAVE", options->slave, "position or name")->required();
    sub->add_option("-o,--output", options->file, "keep its bytes in this file, too")->type_name("FILE");
    sub->callback([&action, options] {
        action = [options] {
            return with_bus(*options->bus, [&](BusSession& session) {
                return with_eeprom(session, *options, [&](const Survey& survey, std::size_t position) {
                    return read_one(session, *options, survey, position);
                });
            });
        };
    });
}

void add_eeprom_show(CLI::App& eeprom, Action& action) {
    auto* sub = eeprom.add_subcommand("show", "the same of a file; needs no bus");
    auto options = std::make_shared<EepromOptions>();
    auto json = std::make_shared<bool>(false);
    sub->add_option("FILE", options->file, "a binary image")->required();
    sub->add_flag("--json", *json, "the answer as one JSON object");
    sub->callback([&action, options, json] { action = [options, json] { return show_file(*options, *json); }; });
}

void add_eeprom_backup(CLI::App& eeprom, Action& action) {
    auto* sub =
        eeprom.add_subcommand("backup", "keeps the EEPROMs of all slaves, or of those named, in a file each; never over another content");
    auto options = std::make_shared<EepromOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_option("SLAVE", options->slaves, "positions or names; `all`, or none: every slave");
    sub->add_option("-d,--directory", options->folder, "where the files go; is made where it is missing")->type_name("DIR");
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return back_up_chosen(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
