// taktwerk bus file read|write: files of a slave.

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "apps/bus/foe.hpp"
#include "apps/bus/kept_file.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"

namespace taktwerk::apps {

namespace {

using FileBytes = std::vector<std::byte>;

/// Finds the slave, opens its mailbox, and lets `work` speak to it.
int with_file_slave(BusSession& session, const FoeOptions& options, const std::function<int(ecat::BusSlave&)>& work) {
    const auto& bus = *options.bus;
    const auto found = session.look();
    if (!found) return fail(bus, found.error());
    const auto position = find_slave(*found, options.slave);
    if (!position) return fail(bus, position.error());
    if (auto allowed = session.may_write(*found, "speaking to its mailboxes"); !allowed) return fail(bus, allowed.error());
    session.adopt(*found);
    const auto slave = slave_at(session, *found, *position);
    if (!slave) return fail(bus, slave.error());
    if (const auto offered = offers_files(**slave, bus); !offered) return fail(bus, offered.error());
    if (const auto opened = session.probe().run(ecat::open_mailbox_for(session.bus(), **slave, ecat::MailboxType::foe)); !opened)
        return fail(bus, opened.error());
    return work(**slave);
}

/// Ctrl-C in the middle: the slave is told, so that the next transfer begins with the first request.
int fail_transfer(BusSession& session, ecat::BusSlave& slave, const BusOptions& options, const Error& error) {
    if (error.code == "bus.interrupted") {
        session.finish_undisturbed();
        if (const auto told = session.probe().run(ecat::abandon_file(session.probe().port(), slave.mailbox)); !told)
            print_warning(told.error());
    }
    return fail(options, error);
}

bool is_text(const FileBytes& bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) {
        const auto c = static_cast<unsigned char>(byte);
        return c == '\n' || c == '\r' || c == '\t' || c >= 0x20;
    });
}

int keep_file(const FoeOptions& options, const std::string& subject, const FileBytes& bytes) {
    const auto& bus = *options.bus;
    if (options.file.empty() && !bus.json && !is_text(bytes))
        return fail(bus, Error{"foe.file", options.name, fmt::format("the file has {} bytes that are no text", bytes.size()),
                               "say where to put it: -o FILE"});
    if (!options.file.empty())
        if (const auto written = write_new_file(options.file, bytes, "foe.file", "foe.exists"); !written) return fail(bus, written.error());
    if (bus.json) {
        Json json{{"ok", true}, {"slave", subject}, {"name", options.name}, {"bytes", bytes.size()}};
        if (!options.file.empty()) json["file"] = options.file;
        print_json(json);
    } else if (options.file.empty()) {
        std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    } else {
        fmt::print("{}: file '{}' has {} bytes; {} is written\n", subject, options.name, bytes.size(), options.file);
    }
    return exit_ok;
}

int read_from_slave(BusSession& session, const FoeOptions& options, std::uint32_t password) {
    return with_file_slave(session, options, [&](ecat::BusSlave& slave) {
        FoeProgressLine line{*options.bus};
        const auto bytes = session.probe().run(
            ecat::read_file(session.probe().port(), slave.mailbox, {options.name, password}, foe_settings(options, line)));
        line.end();
        if (!bytes) return fail_transfer(session, slave, *options.bus, bytes.error());
        return keep_file(options, slave.subject, *bytes);
    });
}

int write_to_slave(BusSession& session, const FoeOptions& options, std::uint32_t password, const FileBytes& content) {
    return with_file_slave(session, options, [&](ecat::BusSlave& slave) {
        const auto& bus = *options.bus;
        FoeProgressLine line{bus};
        const auto written = session.probe().run(
            ecat::write_file(session.probe().port(), slave.mailbox, {options.name, password}, content, foe_settings(options, line)));
        line.end();
        if (!written) return fail_transfer(session, slave, bus, written.error());
        if (written->failure) {
            Error error = *written->failure;
            if (written->begun)
                error.what += fmt::format("; {} of {} bytes had been taken, and what the slave holds under this name now is not known",
                                          written->acknowledged, content.size());
            return fail(bus, error);
        }
        if (bus.json) print_json(Json{{"ok", true}, {"slave", slave.subject}, {"name", options.name}, {"bytes", content.size()}});
        else fmt::print("{}: file '{}' is written, {} bytes\n", slave.subject, options.name, content.size());
        return static_cast<int>(exit_ok);
    });
}

std::shared_ptr<FoeOptions> add_file_command(CLI::App& sub) {
    auto options = std::make_shared<FoeOptions>();
    options->bus = add_bus_options(sub);
    sub.get_option("--force")->description("also where its EEPROM says that it has no FoE, or beside another master");
    sub.add_option("SLAVE", options->slave, "position or name")->required();
    sub.add_option("NAME", options->name, "of the file, as the slave's maker writes it")->required();
    add_foe_options(sub, *options);
    return options;
}

}  // namespace

void add_bus_file(CLI::App& bus, Action& action) {
    auto* file = bus.add_subcommand("file", "read and write files of a slave (FoE)");
    file->require_subcommand(1);
    auto* reading = file->add_subcommand("read", "a file out of a slave");
    auto options = add_file_command(*reading);
    reading->add_option("-o,--output", options->file, "where it goes; default: a text to standard output")->type_name("FILE");
    reading->callback([&action, options] {
        action = [options]() -> int {
            const auto password = password_of(options->password);
            if (!password) return fail(*options->bus, password.error());
            if (const auto named = check_slave_file_name(options->name, "NAME"); !named) return fail(*options->bus, named.error());
            if (!options->file.empty())
                if (const auto free = expect_no_file(options->file, "foe.file", "foe.exists"); !free)
                    return fail(*options->bus, free.error());
            return with_bus(*options->bus, [&](BusSession& session) { return read_from_slave(session, *options, *password); });
        };
    });
    auto* writing = file->add_subcommand("write", "a file into a slave, in the state that it is in (firmware: bus firmware)");
    auto write_options = add_file_command(*writing);
    writing->add_option("FILE", write_options->file, "on this computer")->required();
    writing->callback([&action, options = write_options] {
        action = [options]() -> int {
            const auto password = password_of(options->password);
            if (!password) return fail(*options->bus, password.error());
            if (const auto named = check_slave_file_name(options->name, "NAME"); !named) return fail(*options->bus, named.error());
            const auto content = read_whole_file(options->file, ecat::largest_slave_file, "foe.file");
            if (!content) return fail(*options->bus, content.error());
            return with_bus(*options->bus, [&](BusSession& session) { return write_to_slave(session, *options, *password, *content); });
        };
    });
}

}  // namespace taktwerk::apps
