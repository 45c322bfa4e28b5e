#include "config/drive_file/startup_entry.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

using ecat::DataType;
using ecat::Transition;

Codec<DataType> data_type() {
    return choice<DataType>({{"BOOL", DataType::BOOL},
                             {"I8", DataType::I8},
                             {"I16", DataType::I16},
                             {"I32", DataType::I32},
                             {"I64", DataType::I64},
                             {"U8", DataType::U8},
                             {"U16", DataType::U16},
                             {"U32", DataType::U32},
                             {"U64", DataType::U64},
                             {"REAL32", DataType::REAL32},
                             {"REAL64", DataType::REAL64},
                             {"STRING", DataType::STRING}});
}

Table<StartupEntry> startup_table() {
    using S = StartupEntry;
    Table<S> table{
        "startup",
        "One SDO that the master writes while it brings the slave up.",
        {
            field("at", &S::at, choice<Transition>({{"preop", Transition::PreopToSafeop}, {"safeop", Transition::SafeopToOp}}),
                  "preop: before SAFEOP, the usual place · safeop: before OP"),
            required(field("object", &S::object, object_address(),
                           "as the manual prints it: 2005h:0B (sub in hexadecimal), or 0x2005:11 (sub in decimal)")),
            field("type", &S::type, maybe(data_type()), "needed only where the profile does not list the object"),
            required(field("value", &S::value,
                           integer<std::int64_t>(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()),
                           "what is written")),
            with_default(field("verify", &S::verify, maybe(boolean()), "read back and compare"), "true, except for write-only objects"),
            field("if_changed", &S::if_changed, boolean(), "read first and write only another value: spares the drive's EEPROM"),
            field("comment", &S::comment, text(), "for people"),
        },
        {},
        {}};
    table.before = [](Reader&, const Node& node, S& entry) { entry.where = node.at; };
    // An entry that could not be read says nothing, so nothing follows from it.
    table.after = [](Reader& reader, const Node&, S& entry) {
        if (reader.already_bad(reader.path())) entry.object = {};
    };
    return table;
}

const ecat::ObjectEntry* find_object(const ecat::DeviceDescription& device, std::uint16_t index, std::uint8_t sub) noexcept {
    for (const auto& object : device.objects)
        if (object.index == index && object.sub == sub) return &object;
    return nullptr;
}

std::vector<ecat::StartupSdo> resolve_startup(Reader& reader, const std::string& file, const std::vector<StartupEntry>& entries,
                                              const ecat::DeviceDescription& device) {
    std::vector<ecat::StartupSdo> out;
    const auto problem = [&](const StartupEntry& entry, std::string code, std::string what, std::string remedy) {
        reader.errors().push_back({std::move(code), located(file, entry.where), std::move(what), std::move(remedy)});
    };
    // A PDO's count is written 0, its entries, then its count: there, and only there, twice has a meaning.
    constexpr std::uint16_t first_of_drive = 0x2000;
    for (const auto& entry : entries) {
        if (entry.object.index == 0) continue;  // already reported
        const auto earlier = std::find_if(entries.begin(), entries.end(), [&](const StartupEntry& other) {
            return &other == &entry ||
                   (other.object.index == entry.object.index && other.object.sub == entry.object.sub && other.at == entry.at);
        });
        if (&*earlier != &entry && entry.object.index >= first_of_drive)
            problem(entry, "config.startup_twice",
                    fmt::format("{} stands in the list already, in line {}{}", show_object(entry.object.index, entry.object.sub),
                                earlier->where.line,
                                earlier->value == entry.value
                                    ? std::string{}
                                    : fmt::format(", with {} instead of {}: only the last would count", earlier->value, entry.value)),
                    "keep the one that is meant");
        const auto shown = show_object(entry.object.index, entry.object.sub);
        if (!device.mailbox) {
            problem(entry, "config.startup_no_mailbox", fmt::format("{} has no mailbox: nothing can be written to it", device.name),
                    "remove its `startup` list");
            continue;
        }
        const auto* known = find_object(device, entry.object.index, entry.object.sub);
        if (!known && !entry.type) {
            problem(entry, "config.startup_type",
                    fmt::format("the profile of {} does not list {}, so its type is not known", device.name, shown),
                    "add `type:` as in the manual, such as `type: U16`");
            continue;
        }
        const auto type = entry.type.value_or(known ? known->type : DataType::U32);
        if (known && known->access == ecat::Access::ro) {
            problem(entry, "config.startup_read_only", fmt::format("{} of {} is read-only", shown, device.name), "remove the entry");
            continue;
        }
        const auto bits = ecat::bit_size(type);
        if (bits > 0 && bits < 64) {
            const std::int64_t low = ecat::is_signed(type) ? -(std::int64_t{1} << (bits - 1)) : 0;
            const std::int64_t high = ecat::is_signed(type) ? (std::int64_t{1} << (bits - 1)) - 1 : (std::int64_t{1} << bits) - 1;
            if (entry.value < low || entry.value > high) {
                problem(entry, "config.out_of_range", fmt::format("{} does not fit into {}", entry.value, shown),
                        fmt::format("give {} to {}", low, high));
                continue;
            }
        }
        ecat::StartupSdo sdo;
        sdo.at = entry.at;
        sdo.index = entry.object.index;
        sdo.sub = entry.object.sub;
        sdo.type = type;
        sdo.value = entry.value;
        sdo.verify = entry.verify.value_or(!known || known->access != ecat::Access::wo);
        sdo.if_changed = entry.if_changed;
        sdo.origin = located(file, entry.where);
        out.push_back(std::move(sdo));
    }
    return out;
}

}  // namespace taktwerk::config
