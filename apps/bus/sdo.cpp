// taktwerk bus sdo read|write|dump: the objects of a slave.

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "config/reading/quantity.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/diagnosis/object_value.hpp"

namespace taktwerk::apps {

namespace {

using Bytes = std::vector<std::byte>;

struct SdoOptions {
    std::shared_ptr<BusOptions> bus;
    std::string slave, object, value, type;
    bool complete = false;  ///< the whole object in one transfer
};

struct Target {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::optional<std::uint16_t> type;  ///< as the user said
    ecat::SdoAccess access = ecat::SdoAccess::entry;
};

/// "6041h", "2000h:02", "0x2000:2", and "6041" as manuals and colleagues say it.
Result<Target> target_of(const SdoOptions& options) {
    auto object = config::parse_object(options.object);
    if (!object) {
        const auto colon = options.object.find(':');
        const auto index = options.object.substr(0, colon);
        object = config::parse_object(index + "h" + (colon == std::string::npos ? std::string{} : options.object.substr(colon)));
    }
    if (!object) return Error{"sdo.value", options.object, "is not an object", "write it as 6041h or 2000h:02 (both hexadecimal)"};
    Target target;
    target.index = object->index;
    target.sub = object->sub;
    if (options.complete) {  // all entries one after the other: no type fits but bytes
        target.access = ecat::SdoAccess::complete;
        target.type = ecat::coe_type::octet_string;
    }
    if (options.type.empty()) return target;
    target.type = ecat::type_number(options.type);
    if (!target.type) return Error{"sdo.value", options.type, "is not a type", "types are " + ecat::known_types()};
    return target;
}

std::string name_of(const ecat::BusSlave& slave, const Target& target) {
    for (const auto& object : slave.device().objects)
        if (object.index == target.index && object.sub == target.sub) return object.name;
    return {};
}

struct Answer {
    std::uint16_t type = 0;
    Bytes value;
};

ecat::Script<Result<void>> open(ecat::Bus& bus, ecat::BusSlave& slave) {
    if (slave.mailbox.station != 0) co_return Result<void>{};  // the bring-up has opened it
    co_return co_await ecat::open_mailbox(bus, slave);
}

ecat::Script<Result<Answer>> read(ecat::Bus& bus, ecat::BusSlave& slave, Target target) {
    const Result<void> opened = co_await open(bus, slave);
    if (!opened) co_return opened.error();
    Answer answer;
    if (target.type) {
        answer.type = *target.type;
    } else {
        const Result<std::uint16_t> type = co_await ecat::find_type(bus, slave, target.index, target.sub);
        if (!type) co_return type.error();
        answer.type = *type;
    }
    Result<Bytes> value = co_await ecat::read_object(bus, slave, target.index, target.sub, target.access);
    if (!value) co_return value.error();
    answer.value = std::move(*value);
    co_return answer;
}

/// Writes and reads back: what the slave made of it is the answer.
ecat::Script<Result<Answer>> write(ecat::Bus& bus, ecat::BusSlave& slave, Target target, std::string text) {
    const Result<void> opened = co_await open(bus, slave);
    if (!opened) co_return opened.error();
    std::uint16_t type = target.type.value_or(ecat::coe_type::unknown);
    if (!target.type) {
        const Result<std::uint16_t> found = co_await ecat::find_type(bus, slave, target.index, target.sub);
        if (!found) co_return found.error();
        type = *found;
    }
    if (type == ecat::coe_type::unknown)
        co_return Error{"sdo.value", ecat::object_text(target.index, target.sub), "the slave does not say of which type this object is",
                        "give it: --type, one of " + ecat::known_types()};
    Result<Bytes> bytes = ecat::parse_value(type, text);
    if (!bytes) co_return bytes.error();
    const Bytes wanted = *bytes;
    const Result<void> written = co_await ecat::write_object(bus, slave, target.index, target.sub, wanted, target.access);
    if (!written) co_return written.error();
    target.type = type;
    co_return co_await read(bus, slave, target);
}

Json answer_json(const ecat::BusSlave& slave, const Target& target, const Answer& answer) {
    std::string hex;
    for (const std::byte b : answer.value) hex += fmt::format("{:02X}", static_cast<unsigned>(b));
    return Json{{"slave", slave.subject},
                {"position", slave.found.position},
                {"index", target.index},
                {"sub", target.sub},
                {"name", name_of(slave, target)},
                {"type", ecat::type_name(answer.type)},
                {"value", ecat::value_text(answer.type, answer.value)},
                {"bytes", hex}};
}

/// Finds the slave, opens the bus for writing to mailboxes, and lets `ask` work on it.
int with_slave(BusSession& session, const SdoOptions& options, const std::function<int(ecat::BusSlave&)>& ask) {
    const Result<ecat::Survey> found = session.look();
    if (!found) return fail(*options.bus, found.error());
    const Result<std::size_t> position = find_slave(*found, options.slave);
    if (!position) return fail(*options.bus, position.error());
    if (auto allowed = session.may_write(*found, "speaking to its mailboxes"); !allowed) return fail(*options.bus, allowed.error());
    if (options.bus->operational) {
        if (auto up = session.bring_up(*found); !up) return fail(*options.bus, up.error());
    } else {
        session.adopt(*found);
    }
    const Result<ecat::BusSlave*> slave = slave_at(session, *found, *position);
    if (!slave) return fail(*options.bus, slave.error());
    return ask(**slave);
}

/// Runs what `script` makes of the slave and shows its answer; `verb` stands before the value.
int show_answer(BusSession& session, const SdoOptions& options, const char* verb,
                const std::function<ecat::Script<Result<Answer>>(ecat::BusSlave&, const Target&)>& script) {
    const Result<Target> target = target_of(options);
    if (!target) return fail(*options.bus, target.error());
    return with_slave(session, options, [&](ecat::BusSlave& slave) {
        const Result<Answer> answer = session.probe().run(script(slave, *target));
        if (!answer) return fail(*options.bus, answer.error());
        if (options.bus->json) {
            print_json(answer_json(slave, *target, *answer));
        } else {
            const std::string name = name_of(slave, *target);
            fmt::print("{}{}{} ({}) {} {}\n", ecat::object_text(target->index, target->sub), name.empty() ? "" : " ", name,
                       ecat::type_name(answer->type), verb, ecat::value_text(answer->type, answer->value));
        }
        return static_cast<int>(exit_ok);
    });
}

int read_command(BusSession& session, const SdoOptions& options) {
    return show_answer(session, options, "=",
                       [&](ecat::BusSlave& slave, const Target& target) { return read(session.bus(), slave, target); });
}

int write_command(BusSession& session, const SdoOptions& options) {
    return show_answer(session, options, "reads back",
                       [&](ecat::BusSlave& slave, const Target& target) { return write(session.bus(), slave, target, options.value); });
}

Json dictionary_json(const ecat::Dictionary& dictionary) {
    Json objects = Json::array();
    for (const auto& object : dictionary.objects) {
        Json entries = Json::array();
        for (const auto& entry : object.entries) {
            Json one{{"sub", entry.info.sub},
                     {"name", entry.info.name},
                     {"type", ecat::type_name(entry.info.data_type)},
                     {"bits", entry.info.bits},
                     {"access", ecat::access_text(entry.info.access)}};
            if (entry.value) one["value"] = ecat::value_text(entry.info.data_type, *entry.value);
            if (entry.error) one["unreadable"] = entry.error->what;
            entries.push_back(std::move(one));
        }
        objects.push_back(Json{{"index", object.info.index}, {"name", object.info.name}, {"entries", std::move(entries)}});
    }
    return Json{{"slave", dictionary.subject}, {"from_slave", dictionary.from_slave}, {"objects", std::move(objects)}};
}

int dump(BusSession& session, const SdoOptions& options) {
    return with_slave(session, options, [&](ecat::BusSlave& slave) {
        if (auto opened = session.probe().run(open(session.bus(), slave)); !opened) return fail(*options.bus, opened.error());
        const Result<ecat::Dictionary> dictionary = session.probe().run(ecat::read_dictionary(session.bus(), slave));
        if (!dictionary) return fail(*options.bus, dictionary.error());
        if (options.bus->json) print_json(dictionary_json(*dictionary));
        else fmt::print("{}", dictionary_text(*dictionary, colours_of_output()));
        return static_cast<int>(exit_ok);
    });
}

void add_slave(CLI::App& sub, SdoOptions& options) { sub.add_option("SLAVE", options.slave, "position or name")->required(); }

void add_object(CLI::App& sub, SdoOptions& options) {
    sub.add_option("OBJECT", options.object, "6041h, 2000h:02 (index and sub-index hexadecimal)")->required();
    sub.add_flag("--complete", options.complete, "the whole object by complete access, as bytes; not every slave can");
    sub.add_option("--type", options.type,
                   "BOOL, I8 .. I64, U8 .. U64, REAL32, REAL64, STRING, BYTES; default: as the slave or its profile says");
}

}  // namespace

std::string dictionary_text(const ecat::Dictionary& dictionary, Colours colours) {
    using Side = TextTable::Column::Side;
    TextTable table{{{"object"}, {"name", Side::left, 30}, {"type"}, {"access"}, {"value", Side::left, 40}}};
    for (const auto& object : dictionary.objects) {
        const bool single = object.entries.size() == 1 && object.entries.front().info.sub == 0;
        if (!single) table.add({Cell{fmt::format("{:04X}h", object.info.index), Tone::strong}, Cell{object.info.name, Tone::strong}});
        for (const auto& entry : object.entries) {
            const std::string name = !entry.info.name.empty() ? entry.info.name : single ? object.info.name : std::string{};
            const Cell value = entry.value   ? Cell{ecat::value_text(entry.info.data_type, *entry.value)}
                               : entry.error ? Cell{entry.error->what, Tone::bad}
                                             : Cell{""};
            table.add({single ? fmt::format("{:04X}h", object.info.index) : fmt::format("    :{:02X}", entry.info.sub), name,
                       ecat::type_name(entry.info.data_type), ecat::access_text(entry.info.access), value});
        }
    }
    std::string out = toned(dictionary.subject, Tone::strong, colours) + ": " + count_text(dictionary.objects.size(), "object") + "\n";
    if (!dictionary.from_slave) out += "The slave has no SDO information: names and types are those of its profile.\n";
    return out + "\n" + table.text(colours) + "\naccess: read and write in PREOP, SAFEOP, OP; Rx, Tx: can be mapped to outputs, inputs\n";
}

void add_bus_sdo(CLI::App& bus, Action& action) {
    auto* sdo = bus.add_subcommand("sdo", "read, write or list the objects of a slave");
    sdo->require_subcommand(1);

    auto* reading = sdo->add_subcommand("read", "one object");
    auto options = std::make_shared<SdoOptions>();
    options->bus = add_bus_options(*reading);
    add_slave(*reading, *options);
    add_object(*reading, *options);
    add_operational(*reading, *options->bus);
    reading->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return read_command(session, *options); }); };
    });

    auto* writing = sdo->add_subcommand("write", "one object; then it is read back");
    auto write_options = std::make_shared<SdoOptions>();
    write_options->bus = add_bus_options(*writing);
    add_slave(*writing, *write_options);
    add_object(*writing, *write_options);
    writing->add_option("VALUE", write_options->value, "12, -5, 1234h, 1.5, text")->required();
    add_operational(*writing, *write_options->bus);
    writing->callback([&action, write_options] {
        action = [write_options] {
            return with_bus(*write_options->bus, [&](BusSession& session) { return write_command(session, *write_options); });
        };
    });

    auto* dumping = sdo->add_subcommand("dump", "every object with name, type, access and value");
    auto dump_options = std::make_shared<SdoOptions>();
    dump_options->bus = add_bus_options(*dumping);
    add_slave(*dumping, *dump_options);
    add_operational(*dumping, *dump_options->bus);
    dumping->callback([&action, dump_options] {
        action = [dump_options] { return with_bus(*dump_options->bus, [&](BusSession& session) { return dump(session, *dump_options); }); };
    });
}

}  // namespace taktwerk::apps
