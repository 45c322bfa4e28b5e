#include "ecat/diagnosis/dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/diagnosis/object_value.hpp"

namespace taktwerk::ecat {

namespace {

std::uint16_t access_bits(const ObjectEntry& object) noexcept {
    using namespace entry_access;
    constexpr std::uint16_t read = read_preop | read_safeop | read_op, write = write_preop | write_safeop | write_op;
    std::uint16_t bits = object.access == Access::wo   ? write
                         : object.access == Access::ro ? read
                                                       : static_cast<std::uint16_t>(read | write);
    if (object.mappable == Mappable::rx || object.mappable == Mappable::both) bits |= rx_mappable;
    if (object.mappable == Mappable::tx || object.mappable == Mappable::both) bits |= tx_mappable;
    return bits;
}

EntryInfo described_entry(const ObjectEntry& object) {
    EntryInfo info;
    info.index = object.index;
    info.sub = object.sub;
    info.data_type = type_number(object.type);
    info.bits = bit_size(object.type);
    info.access = access_bits(object);
    info.name = object.name;
    return info;
}

std::vector<DictionaryObject> described_objects(const DeviceDescription& device) {
    std::vector<DictionaryObject> objects;
    for (const auto& object : device.objects) {
        if (objects.empty() || objects.back().info.index != object.index) {
            DictionaryObject next;
            next.info.index = object.index;
            next.info.name = object.name;
            objects.push_back(std::move(next));
        }
        DictionaryEntry entry;
        entry.info = described_entry(object);
        objects.back().info.max_sub = std::max(objects.back().info.max_sub, object.sub);
        objects.back().entries.push_back(std::move(entry));
    }
    return objects;
}

Script<void> read_value(Bus& bus, BusSlave& slave, DictionaryEntry& entry) {
    constexpr std::uint16_t any_read = entry_access::read_preop | entry_access::read_safeop | entry_access::read_op;
    if ((entry.info.access & any_read) == 0) co_return;
    Result<std::vector<std::byte>> value = co_await read_object(bus, slave, entry.info.index, entry.info.sub);
    if (value) entry.value = std::move(*value);
    else entry.error = value.error();
}

/// A record may leave sub-indices out: the slave then refuses to describe them.
bool is_gap(const Error& error) noexcept { return error.code == "sdo.abort"; }

Script<Result<DictionaryObject>> read_one(Bus& bus, BusSlave& slave, std::uint16_t index) {
    DictionaryObject object;
    const Result<ObjectInfo> info = co_await describe_object(bus.port, slave.mailbox, index);
    if (!info) {
        if (!is_gap(info.error())) co_return info.error();
        object.info.index = index;
        co_return object;
    }
    object.info = *info;
    for (unsigned sub = 0; sub <= info->max_sub; ++sub) {
        DictionaryEntry entry;
        const Result<EntryInfo> description = co_await describe_entry(bus.port, slave.mailbox, index, static_cast<std::uint8_t>(sub));
        if (!description) {
            if (is_gap(description.error())) continue;
            co_return description.error();
        }
        entry.info = *description;
        if (entry.info.data_type == 0 && entry.info.bits == 0) continue;
        co_await read_value(bus, slave, entry);
        object.entries.push_back(std::move(entry));
    }
    co_return object;
}

}  // namespace

Script<Result<Dictionary>> read_dictionary(Bus& bus, BusSlave& slave) {
    Dictionary dictionary;
    dictionary.subject = slave.subject;
    const Result<std::vector<std::uint16_t>> list = co_await list_objects(bus.port, slave.mailbox, ObjectList::all);
    if (!list) {
        dictionary.from_slave = false;
        dictionary.objects = described_objects(slave.device());
        if (list.error().code != "sdo.no_info" || dictionary.objects.empty()) co_return list.error();
        for (auto& object : dictionary.objects)
            for (auto& entry : object.entries) co_await read_value(bus, slave, entry);
        co_return dictionary;
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
        bus.note(slave, fmt::format("object {} of {}", i + 1, list->size()));
        Result<DictionaryObject> object = co_await read_one(bus, slave, (*list)[i]);
        if (!object) co_return object.error();
        dictionary.objects.push_back(std::move(*object));
    }
    co_return dictionary;
}

std::string access_text(std::uint16_t access) {
    using namespace entry_access;
    const auto state = [&](std::uint16_t reads, std::uint16_t writes) {
        return std::string{(access & reads) != 0 ? "r" : "-"} + ((access & writes) != 0 ? "w" : "-");
    };
    std::string text = state(read_preop, write_preop) + " " + state(read_safeop, write_safeop) + " " + state(read_op, write_op);
    if ((access & rx_mappable) != 0) text += " Rx";
    if ((access & tx_mappable) != 0) text += " Tx";
    return text;
}

Script<Result<std::uint16_t>> find_type(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    for (const auto& object : slave.device().objects)
        if (object.index == index && object.sub == sub) co_return type_number(object.type);
    const Result<EntryInfo> info = co_await describe_entry(bus.port, slave.mailbox, index, sub);
    if (info) co_return info->data_type;
    if (info.error().code == "sdo.no_info" || is_gap(info.error())) co_return coe_type::unknown;
    co_return info.error();
}

}  // namespace taktwerk::ecat
