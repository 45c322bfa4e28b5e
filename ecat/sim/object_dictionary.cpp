#include "ecat/sim/object_dictionary.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::ecat::sim {

std::uint8_t bits_of(DataType type) noexcept {
    switch (type) {
        case DataType::BOOL: return 1;
        case DataType::I8:
        case DataType::U8: return 8;
        case DataType::I16:
        case DataType::U16: return 16;
        case DataType::I32:
        case DataType::U32:
        case DataType::REAL32: return 32;
        case DataType::I64:
        case DataType::U64:
        case DataType::REAL64: return 64;
        case DataType::STRING: return 0;
    }
    return 0;
}

bool type_is_signed(DataType type) noexcept {
    return type == DataType::I8 || type == DataType::I16 || type == DataType::I32 || type == DataType::I64;
}

void Entry::set(std::int64_t value) noexcept {
    if (bits_ == 0 || bits_ >= 64) {
        value_ = bits_ == 0 ? 0 : value;
        return;
    }
    const unsigned drop = 64u - bits_;
    const auto high = static_cast<std::uint64_t>(value) << drop;
    value_ = signed_ ? static_cast<std::int64_t>(high) >> drop : static_cast<std::int64_t>(high >> drop);
}

ObjectDictionary::ObjectDictionary(const DeviceDescription& description) {
    for (const auto& object : description.objects) add(object);
    add_derived(description);
    const auto key = [](const Entry& entry) { return std::pair{entry.index_, entry.sub_}; };
    // The description's own entries came first: they win over derived ones of the same address.
    std::stable_sort(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
    entries_.erase(std::unique(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) { return key(a) == key(b); }),
                   entries_.end());
    entries_.shrink_to_fit();
    reset();
}

void ObjectDictionary::add(const ObjectEntry& object, EntryRole role) {
    Entry entry;
    entry.index_ = object.index;
    entry.sub_ = object.sub;
    entry.type_ = object.type;
    entry.bits_ = bits_of(object.type);
    entry.signed_ = type_is_signed(object.type);
    entry.access_ = object.access;
    entry.mappable_ = object.mappable;
    entry.role_ = role;
    entry.minimum_ = object.minimum;
    entry.maximum_ = object.maximum;
    entry.default_ = object.value;
    entry.default_text_ = object.text;
    entries_.push_back(std::move(entry));
}

namespace {

ObjectEntry number(std::uint16_t index, std::uint8_t sub, DataType type, std::int64_t value, Access access = Access::ro) {
    ObjectEntry object;
    object.index = index;
    object.sub = sub;
    object.type = type;
    object.access = access;
    object.value = value;
    return object;
}

}  // namespace

void ObjectDictionary::add_derived(const DeviceDescription& description) {
    if (!description.device_name.empty()) {
        auto name = number(0x1008, 0, DataType::STRING, 0);
        name.text = description.device_name;
        add(name);
    }
    const Identity& id = description.identity;
    add(number(0x1018, 0, DataType::U8, 4));
    add(number(0x1018, 1, DataType::U32, id.vendor));
    add(number(0x1018, 2, DataType::U32, id.product));
    add(number(0x1018, 3, DataType::U32, id.revision));
    add(number(0x1018, 4, DataType::U32, id.serial));

    add(number(0x1C00, 0, DataType::U8, static_cast<std::int64_t>(description.sync_managers.size())));
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n)  // 1 mailbox out, 2 mailbox in, 3 outputs, 4 inputs
        add(number(0x1C00, static_cast<std::uint8_t>(n + 1), DataType::U8,
                   static_cast<std::int64_t>(description.sync_managers[n].use) + 1));

    add_pdos(description.rx_pdos, description.rx_rules);
    add_pdos(description.tx_pdos, description.tx_rules);
    add_assignment(0x1C12, description.rx_assigned, description.rx_rules);
    add_assignment(0x1C13, description.tx_assigned, description.tx_rules);
    add_synchronisation(0x1C32, description.dc);
    add_synchronisation(0x1C33, description.dc);
}

void ObjectDictionary::add_pdos(const std::vector<PdoDescription>& pdos, const PdoRules& rules) {
    for (const auto& pdo : pdos) {
        const Access access = pdo.fixed ? Access::ro : Access::rw;
        auto count = number(pdo.index, 0, DataType::U8, static_cast<std::int64_t>(pdo.entries.size()), access);
        count.maximum = rules.max_entries;
        add(count, EntryRole::mapping_count);
        const std::size_t subs = pdo.fixed ? pdo.entries.size() : std::max<std::size_t>(pdo.entries.size(), rules.max_entries);
        for (std::size_t n = 0; n < subs; ++n) {
            std::int64_t value = 0;
            if (n < pdo.entries.size()) {
                const PdoEntry& entry = pdo.entries[n];
                value = (std::int64_t{entry.index} << 16) | (std::int64_t{entry.sub} << 8) | entry.bits;
            }
            add(number(pdo.index, static_cast<std::uint8_t>(n + 1), DataType::U32, value, access), EntryRole::mapping_entry);
        }
    }
}

void ObjectDictionary::add_assignment(std::uint16_t index, const std::vector<std::uint16_t>& assigned, const PdoRules& rules) {
    auto count = number(index, 0, DataType::U8, static_cast<std::int64_t>(assigned.size()), Access::rw);
    count.maximum = rules.max_assigned;
    add(count, EntryRole::assign_count);
    for (std::size_t n = 0; n < std::max<std::size_t>(assigned.size(), rules.max_assigned); ++n)
        add(number(index, static_cast<std::uint8_t>(n + 1), DataType::U16, n < assigned.size() ? assigned[n] : 0, Access::rw),
            EntryRole::assign_entry);
}

void ObjectDictionary::add_synchronisation(std::uint16_t index, const DcDescription& dc) {
    // Types: 0 free run, 1 with the sync manager, 2 with SYNC0 (SV33-E manual 7.1 gives type 2 and supported types 0004h).
    add(number(index, 0x00, DataType::U8, 0x20));
    add(number(index, 0x01, DataType::U16, dc.required ? 2 : 1));
    add(number(index, 0x02, DataType::U32, 0));
    add(number(index, 0x04, DataType::U16, dc.required ? 0x0004 : dc.supported ? 0x0006 : 0x0002));
    add(number(index, 0x05, DataType::U32, dc.minimum_cycle.count()));
    add(number(index, 0x06, DataType::U32, 0));
    add(number(index, 0x09, DataType::U32, 0));
    add(number(index, 0x0B, DataType::U16, 0));  // SYNC0 without new outputs, counted by the simulator
    add(number(index, 0x20, DataType::BOOL, 0));
}

Entry* ObjectDictionary::find(std::uint16_t index, std::uint8_t sub) noexcept {
    return const_cast<Entry*>(std::as_const(*this).find(index, sub));  // NOLINT: the entry belongs to *this
}

const Entry* ObjectDictionary::find(std::uint16_t index, std::uint8_t sub) const noexcept {
    const auto wanted = std::pair{index, sub};
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), wanted, [](const Entry& entry, const auto& key) {
        return std::pair{entry.index_, entry.sub_} < key;
    });
    return at != entries_.end() && at->index_ == index && at->sub_ == sub ? &*at : nullptr;
}

bool ObjectDictionary::has_object(std::uint16_t index) const noexcept {
    const auto at =
        std::lower_bound(entries_.begin(), entries_.end(), index, [](const Entry& entry, std::uint16_t key) { return entry.index_ < key; });
    return at != entries_.end() && at->index_ == index;
}

std::int64_t ObjectDictionary::value(std::uint16_t index, std::uint8_t sub, std::int64_t otherwise) const noexcept {
    const Entry* entry = find(index, sub);
    return entry != nullptr ? entry->get() : otherwise;
}

void ObjectDictionary::reset() {
    for (auto& entry : entries_) {
        entry.set(entry.default_);
        entry.text_ = entry.default_text_;
    }
}

}  // namespace taktwerk::ecat::sim
