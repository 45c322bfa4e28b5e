#include "config/machine_file/modbus_server_tables.hpp"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using namespace std::chrono_literals;
using hmi::ModbusPoint;
using hmi::ModbusServerConfig;
using hmi::ShownValue;
using modbus::server::ListenAddress;
using modbus::server::NumberType;
using ServedTable = modbus::server::Table;
using ServedOrder = modbus::server::WordOrder;

Codec<ListenAddress> listen_address() {
    Codec<ListenAddress> c;
    c.shape = text().shape;
    c.read = [](Reader& reader, const Node& node, ListenAddress& out) {
        const auto read = node.kind == Node::Kind::scalar ? modbus::server::parse_listen_address(node.text) : std::nullopt;
        if (read) out = *read;
        else report_wrong_type(reader, node, "an address of this computer and a port", "127.0.0.1:502");
        return read.has_value();
    };
    c.show = [](const ListenAddress& address) { return text_of(address); };
    return c;
}

/// `from` in the unit of the value, `to` what stands in the register.
Codec<PointScale> register_scale() {
    using S = PointScale;
    const Table<S> table{"modbus_server.points.<name>.scale",
                         "What stands in the register: `from: [0 bar, 16 bar], to: [0, 16000]`.",
                         {
                             required(field("from", &S::from, measure_pair(), "two values, in the unit of what is shown")),
                             required(field("to", &S::to, measure_pair(), "the numbers that stand in the register for them")),
                         },
                         {},
                         [](Reader& reader, const Node& node, S& scale) {
                             if (!scale.to.unit.empty())
                                 reader.problem(node.find("to")->at, "config.unit_wrong", "a register holds a number without a unit",
                                                "write `to` as two bare numbers, such as `to: [0, 16000]`");
                         }};
    return section(table);
}

struct SubjectKey {
    const char* key;
    ShownValue::Of of;
    const char* doc;
};
constexpr std::array<SubjectKey, 5> subject_keys{{
    {"input", ShownValue::Of::input, "shows this input: its `value`, in its unit, or whether it is `good`"},
    {"output", ShownValue::Of::output, "shows this output"},
    {"axis", ShownValue::Of::axis, "shows what `shows` names of this axis"},
    {"variable", ShownValue::Of::variable, "shows this variable of a program, as `program.name`"},
    {"parameter", ShownValue::Of::parameter, "shows this parameter of a program, as `program.name`"},
}};

/// What one key means depends on the others.
void check_served(Reader& reader, const Node& node, ModbusPoint& point) {
    auto& place = point.place;
    const auto problem = [&](const char* key, std::string what, std::string remedy) {
        const auto* found = node.find(key);
        reader.problem(found != nullptr ? found->at : node.at, "config.register", std::move(what), std::move(remedy));
    };
    const Node* shown = node.find("machine");
    int subjects = shown != nullptr ? 1 : 0;
    for (const auto& subject : subject_keys)
        if (const auto* found = node.find(subject.key)) ++subjects, shown = found;
    if (subjects != 1)
        problem("", fmt::format("`{}` shows {}", reader.path(), subjects == 0 ? "nothing" : "several values at once"),
                "give exactly one of machine, input, output, axis, variable and parameter");
    if (shown != nullptr) point.where = located(reader.file(), shown->at);
    if (node.find("machine") != nullptr && node.find("shows") != nullptr)
        problem("shows", fmt::format("`{}`: what is shown of the machine stands at `machine` already", reader.path()), "remove `shows`");
    if (node.find("axis") != nullptr && node.find("shows") == nullptr)
        problem("axis", fmt::format("`{}` does not say what of the axis", reader.path()), "add `shows`, such as `shows: position`");
    if (is_bits(place.table)) {
        if (node.find("type") == nullptr) place.type = NumberType::boolean;
        else if (place.type != NumberType::boolean)
            problem("type", fmt::format("`{}` is a single bit: it holds no number", reader.path()),
                    "remove `type`, or choose a table of registers");
        if (node.find("bit") != nullptr)
            problem("bit", fmt::format("`{}` is a single bit already", reader.path()), "remove `bit`, or choose a table of registers");
    } else if ((node.find("bit") != nullptr) != (place.type == NumberType::boolean)) {
        problem("type", fmt::format("`{}`: `type: bool` and `bit` belong together in a register", reader.path()),
                "write both, such as `type: bool, bit: 3`");
    }
    if (node.find("word_order") != nullptr && addresses_of(place.type) == 1)
        problem("word_order", fmt::format("`{}` is one register: there is no order", reader.path()), "remove `word_order`");
    if (end_of(place) > 0x10000)
        problem("address", fmt::format("`{}` ends beyond the last address, 65535", reader.path()), "correct `address`");
}

Table<ModbusPoint> served_table() {
    using P = ModbusPoint;
    using What = ShownValue::What;
    Table<P> table{"modbus_server.points.<name>",
                   "A coil, an input or registers that show one value of the machine. The name is for people.",
                   {
                       required(field_at<P>(
                           "table", [](P & p) -> auto& { return p.place.table; },
                           choice<ServedTable>({{"coil", ServedTable::coil},
                                                {"discrete_input", ServedTable::discrete_input},
                                                {"holding", ServedTable::holding},
                                                {"input", ServedTable::input}}),
                           "which of the protocol's four tables")),
                       required(field_at<P>(
                           "address", [](P & p) -> auto& { return p.place.address; }, integer<std::uint16_t>(0, 65535),
                           "as on the wire, from 0: what a manual calls 40001, 30001, 10001 or 1 is address 0 of its table")),
                       with_default(field_at<P>(
                                        "type", [](P & p) -> auto& { return p.place.type; },
                                        choice<NumberType>({{"bool", NumberType::boolean},
                                                            {"uint16", NumberType::uint16},
                                                            {"int16", NumberType::int16},
                                                            {"uint32", NumberType::uint32},
                                                            {"int32", NumberType::int32},
                                                            {"float32", NumberType::float32}}),
                                        "its number; the wide ones take two registers"),
                                    "bool for coil and discrete_input, else uint16"),
                       field_at<P>(
                           "word_order", [](P & p) -> auto& { return p.place.order; },
                           choice<ServedOrder>({{"high_first", ServedOrder::high_first}, {"low_first", ServedOrder::low_first}}),
                           "of the two registers of a wide number: which half comes first"),
                       with_default(field_at<P>(
                                        "bit", [](P & p) -> auto& { return p.place.bit; }, integer<std::uint8_t>(0, 15),
                                        "of `type: bool` in a register; 0 is the lowest. Several points may share the register"),
                                    "none"),
                       with_default(field_at<P>(
                                        "writable", [](P & p) -> auto& { return p.place.writable; }, boolean(),
                                        "clients may write it: an output while people may set it by hand, a parameter of a program"),
                                    "false"),
                       with_default(field_via<P>(
                                        "scale", register_scale(),
                                        [](P& p, const PointScale& s) {
                                            p.scaled = true;
                                            p.unit = s.from.unit;
                                            p.register_low = s.to.first, p.register_high = s.to.second;
                                            p.factor = (s.to.second - s.to.first) / (s.from.second - s.from.first);
                                            p.offset = s.to.first - s.from.first * p.factor;
                                        },
                                        "what stands in the register, where that is not the value in its unit"),
                                    "the value in its unit"),
                       field_via<P>(
                           "machine",
                           choice<What>({{"heartbeat", What::heartbeat},
                                         {"phase", What::phase},
                                         {"mode", What::mode},
                                         {"emergency_stop", What::emergency_stop},
                                         {"alarm", What::alarm},
                                         {"alarms", What::alarms}}),
                           [](P& p, const What& what) {
                               p.shows = {ShownValue::Of::machine, what, {}};
                           },
                           "shows the machine: `heartbeat` counts its cycles; `alarm` and `alarms`: whether and how many stand"),
                   },
                   {},
                   check_served};
    for (const auto& subject : subject_keys)
        table.fields.push_back(field_via<P>(
            subject.key, text(),
            [of = subject.of](P& p, const std::string& called) {
                p.shows.of = of;
                p.shows.name = called;
            },
            subject.doc));
    table.fields.push_back(with_default(field_at<P>(
                                            "shows", [](P & p) -> auto& { return p.shows.what; },
                                            choice<What>({{"value", What::value},
                                                          {"good", What::good},
                                                          {"position", What::position},
                                                          {"velocity", What::velocity},
                                                          {"set_position", What::set_position},
                                                          {"set_velocity", What::set_velocity},
                                                          {"torque", What::torque},
                                                          {"following_error", What::following_error},
                                                          {"state", What::state},
                                                          {"error", What::error},
                                                          {"powered", What::powered},
                                                          {"homed", What::homed},
                                                          {"in_position", What::in_position},
                                                          {"alarm", What::alarm}}),
                                            "of an input: value, good; of an axis: the others"),
                                        "value"));
    return table;
}

Table<ModbusServerConfig> served_machine_table() {
    using S = ModbusServerConfig;
    return {
        "modbus_server",
        "Values of this machine for Modbus TCP clients, such as a visualisation. Modbus knows no users: whoever reaches the address reads "
        "them.",
        {
            field_at<S>(
                "listen", [](S & s) -> auto& { return s.server.listen; }, listen_address(),
                "address of this computer and TCP port; 127.0.0.1 serves this computer alone, 0.0.0.0 everybody"),
            field_at<S>(
                "unit", [](S & s) -> auto& { return s.server.unit; }, integer<std::uint8_t>(0, 255),
                "unit identifier that is answered, 1 to 247; 0 and 255 are answered, too"),
            field_at<S>(
                "max_age", [](S & s) -> auto& { return s.server.max_age; }, duration(1ms, 1h),
                "of the cycle that an answer shows; when the cycle has stood for longer, every request is refused (exception 4)"),
            field_at<S>(
                "idle", [](S & s) -> auto& { return s.server.idle; }, duration(1s, 1h),
                "a client that asks nothing for so long is let go, and outputs that it has set become safe"),
            field_at<S>(
                "clients", [](S & s) -> auto& { return s.server.clients; }, integer<std::uint8_t>(1, 16), "at once; more are sent away"),
            required(field("points", &S::points,
                           by_name(section(served_table()), [](ModbusPoint& p) -> std::string& { return p.place.name; }),
                           "what is offered, by name")),
        },
        {},
        {}};
}

}  // namespace

Field<MachineFile> modbus_server_field() {
    using F = MachineFile;
    return with_default(field_at<F>(
                            "modbus_server", [](F & m) -> auto& { return m.hmi.modbus_server; }, maybe(section(served_machine_table())),
                            "values of this machine for Modbus TCP clients"),
                        "none");
}

}  // namespace taktwerk::config
