#include "config/machine_file/modbus_tables.hpp"

#include <fmt/format.h>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using namespace std::chrono_literals;
using modbus::tcp::Channel;
using modbus::tcp::DeviceConfig;
using modbus::tcp::NumberType;
using RegisterTable = modbus::tcp::Table;
using modbus::tcp::WordOrder;

/// What one key means depends on the others.
void check_register(Reader& reader, const Node& node, Channel& channel) {
    const auto problem = [&](const char* key, std::string what, std::string remedy) {
        const auto* found = node.find(key);
        reader.problem(found != nullptr ? found->at : node.at, "config.register", std::move(what), std::move(remedy));
    };
    if (is_bits(channel.table)) {
        if (node.find("type") == nullptr) channel.type = NumberType::boolean;
        else if (channel.type != NumberType::boolean)
            problem("type", fmt::format("`{}` is a single bit: it has no number", reader.path()),
                    "remove `type`, or choose a table of registers");
        if (node.find("bit") != nullptr)
            problem("bit", fmt::format("`{}` is a single bit already", reader.path()), "remove `bit`, or choose a table of registers");
    } else if ((node.find("bit") != nullptr) != (channel.type == NumberType::boolean)) {
        problem("type", fmt::format("`{}`: `type: bool` and `bit` belong together in a register", reader.path()),
                "write both, such as `type: bool, bit: 3`");
    }
    if (node.find("word_order") != nullptr && addresses_of(channel.type) == 1)
        problem("word_order", fmt::format("`{}` is one register: there is no order", reader.path()), "remove `word_order`");
    if (channel.address + 0u + addresses_of(channel.type) > 0x10000)
        problem("address", fmt::format("`{}` ends beyond the last address, 65535", reader.path()), "correct `address`");
}

Table<Channel> channel_table() {
    using C = Channel;
    return {
        "modbus_tcp.<name>.registers.<name>",
        "A coil, an input or registers of the device, by the name that `channel` of a point uses.",
        {
            required(field("table", &C::table,
                           choice<RegisterTable>({{"coil", RegisterTable::coil},
                                                  {"discrete_input", RegisterTable::discrete_input},
                                                  {"holding", RegisterTable::holding},
                                                  {"input", RegisterTable::input}}),
                           "which of the protocol's four tables")),
            required(field("address", &C::address, integer<std::uint16_t>(0, 65535),
                           "as on the wire, from 0: what a manual calls 40001, 30001, 10001 or 1 is address 0 of its table")),
            with_default(field("type", &C::type,
                               choice<NumberType>({{"bool", NumberType::boolean},
                                                   {"uint16", NumberType::uint16},
                                                   {"int16", NumberType::int16},
                                                   {"uint32", NumberType::uint32},
                                                   {"int32", NumberType::int32},
                                                   {"float32", NumberType::float32}}),
                               "its number; the wide ones take two registers"),
                         "bool for coil and discrete_input, else uint16"),
            field("word_order", &C::order, choice<WordOrder>({{"high_first", WordOrder::high_first}, {"low_first", WordOrder::low_first}}),
                  "of the two registers of a wide number: which half comes first"),
            with_default(field("bit", &C::bit, integer<std::uint8_t>(0, 15), "of `type: bool` in a register; 0 is the lowest. Inputs only"),
                         "none"),
        },
        {},
        check_register};
}

Table<DeviceConfig> device_table() {
    using D = DeviceConfig;
    return {
        "modbus_tcp.<name>",
        "A device that speaks Modbus TCP. It is asked beside the cycle, by a thread of its own; points name it as their `slave`.",
        {
            required(field("host", &D::host, text(), "its address, such as 192.168.1.50; no name: looking one up may take any time")),
            field("port", &D::port, integer<std::uint16_t>(1, 65535), "TCP port"),
            field("unit", &D::unit, integer<std::uint8_t>(0, 255), "unit identifier: 1 to 247, or 255 for a device without a gateway"),
            field("poll", &D::poll, duration(1ms, 1h), "from one reading of its inputs to the next"),
            field("timeout", &D::timeout, duration(1ms, D::longest_timeout), "for a connection, and for each answer as a whole"),
            field("max_age", &D::max_age, duration(1ms, 1h),
                  "of an input: older ones keep their value but are not good, and an alarm says why"),
            field("refresh", &D::refresh, duration(1ms, 1h), "outputs are written when they change, and so often although they do not"),
            field("gap", &D::gap, integer<std::uint16_t>(0, 100),
                  "so many addresses that nobody named may lie inside of one read; writes span none"),
            required(field("registers", &D::channels, by_name(section(channel_table()), [](Channel& c) -> std::string& { return c.name; }),
                           "its channels, by name")),
        },
        {},
        {}};
}

}  // namespace

Field<MachineFile> modbus_field() {
    using F = MachineFile;
    return field_at<F>(
        "modbus_tcp", [](F & m) -> auto& { return m.machine.modbus; },
        by_name(section(device_table()), [](DeviceConfig& d) -> std::string& { return d.name; }), "Modbus TCP devices, beside the bus");
}

}  // namespace taktwerk::config
