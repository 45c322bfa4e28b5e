#include "ecat/sim/object_dictionary.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "ecat/sim/process_data.hpp"

namespace taktwerk::ecat::sim {

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
    add_counts();
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
    entry.bits_ = bit_size(object.type);
    entry.signed_ = is_signed(object.type);
    entry.access_ = object.access;
    entry.mappable_ = object.mappable;
    entry.role_ = role;
    entry.minimum_ = object.minimum;
    entry.maximum_ = object.maximum;
    entry.default_ = object.value;
    entry.default_text_ = object.text;
    entry.name_ = object.name;
    entries_.push_back(std::move(entry));
}

namespace {

constexpr const char* count_name = "number of entries";

ObjectEntry number(std::uint16_t index, std::uint8_t sub, DataType type, std::int64_t value, std::string name, Access access = Access::ro) {
    ObjectEntry object;
    object.name = std::move(name);
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
        auto name = number(0x1008, 0, DataType::STRING, 0, "device name");
        name.text = description.device_name;
        add(name);
    }
    const Identity& id = description.identity;
    add(number(0x1018, 0, DataType::U8, 4, count_name));
    add(number(0x1018, 1, DataType::U32, id.vendor, "vendor ID"));
    add(number(0x1018, 2, DataType::U32, id.product, "product code"));
    add(number(0x1018, 3, DataType::U32, id.revision, "revision number"));
    add(number(0x1018, 4, DataType::U32, id.serial, "serial number"));

    add(number(0x1C00, 0, DataType::U8, static_cast<std::int64_t>(description.sync_managers.size()), count_name));
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n)  // 1 mailbox out, 2 mailbox in, 3 outputs, 4 inputs
        add(number(0x1C00, static_cast<std::uint8_t>(n + 1), DataType::U8, static_cast<std::int64_t>(description.sync_managers[n].use) + 1,
                   "type of sync manager " + std::to_string(n)));

    add_pdos(description.rx_pdos, description.rx_rules);
    add_pdos(description.tx_pdos, description.tx_rules);
    bool outputs = false, inputs = false;
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n) {
        const SmUse use = description.sync_managers[n].use;
        if (use != SmUse::outputs && use != SmUse::inputs) continue;
        const bool rx = use == SmUse::outputs;
        (rx ? outputs : inputs) = true;
        std::vector<std::uint16_t> assigned;  // of those the description assigns, what goes through this sync manager
        for (const auto index : rx ? description.rx_assigned : description.tx_assigned)
            for (const auto& pdo : rx ? description.rx_pdos : description.tx_pdos)
                if (pdo.index == index && belongs_to(description, pdo, static_cast<unsigned>(n))) assigned.push_back(index);
        add_assignment(assignment_object(n), assigned, rx ? description.rx_rules : description.tx_rules);
    }
    // The usual two are there also where a direction has no sync manager of its own.
    if (!outputs) add_assignment(0x1C12, {}, description.rx_rules);
    if (!inputs) add_assignment(0x1C13, {}, description.tx_rules);
    add_synchronisation(0x1C32, description.dc);
    add_synchronisation(0x1C33, description.dc);
}

void ObjectDictionary::add_pdos(const std::vector<PdoDescription>& pdos, const PdoRules& rules) {
    for (const auto& pdo : pdos) {
        const Access access = pdo.fixed ? Access::ro : Access::rw;
        auto count = number(pdo.index, 0, DataType::U8, static_cast<std::int64_t>(pdo.entries.size()), count_name, access);
        count.maximum = rules.max_entries;
        add(count, EntryRole::mapping_count);
        const std::size_t subs = pdo.fixed ? pdo.entries.size() : std::max<std::size_t>(pdo.entries.size(), rules.max_entries);
        for (std::size_t n = 0; n < subs; ++n) {
            std::int64_t value = 0;
            if (n < pdo.entries.size()) {
                const PdoEntry& entry = pdo.entries[n];
                value = (std::int64_t{entry.index} << 16) | (std::int64_t{entry.sub} << 8) | entry.bits;
            }
            add(number(pdo.index, static_cast<std::uint8_t>(n + 1), DataType::U32, value, "mapped object " + std::to_string(n + 1), access),
                EntryRole::mapping_entry);
        }
    }
}

void ObjectDictionary::add_assignment(std::uint16_t index, const std::vector<std::uint16_t>& assigned, const PdoRules& rules) {
    const Access access = rules.assignment_fixed ? Access::ro : Access::rw;
    auto count = number(index, 0, DataType::U8, static_cast<std::int64_t>(assigned.size()), count_name, access);
    count.maximum = rules.max_assigned;
    add(count, EntryRole::assign_count);
    for (std::size_t n = 0; n < std::max<std::size_t>(assigned.size(), rules.max_assigned); ++n)
        add(number(index, static_cast<std::uint8_t>(n + 1), DataType::U16, n < assigned.size() ? assigned[n] : 0,
                   "assigned PDO " + std::to_string(n + 1), access),
            EntryRole::assign_entry);
}

void ObjectDictionary::add_synchronisation(std::uint16_t index, const DcDescription& dc) {
    // Types: 0 free run, 1 with the sync manager, 2 with SYNC0 (SV33-E manual 7.1 gives type 2 and supported types 0004h).
    add(number(index, 0x00, DataType::U8, 0x20, count_name));
    add(number(index, 0x01, DataType::U16, dc.required ? 2 : 1, "synchronisation type"));
    add(number(index, 0x02, DataType::U32, 0, "cycle time"));
    add(number(index, 0x04, DataType::U16, dc.required ? 0x0004 : dc.supported ? 0x0006 : 0x0002, "synchronisation types supported"));
    add(number(index, 0x05, DataType::U32, dc.minimum_cycle.count(), "minimum cycle time"));
    add(number(index, 0x06, DataType::U32, 0, "calculate and copy time"));
    add(number(index, 0x09, DataType::U32, 0, "delay time"));
    add(number(index, 0x0B, DataType::U16, 0, "missed SYNC0 events"));  // SYNC0 without new outputs, counted by the simulator
    add(number(index, 0x20, DataType::BOOL, 0, "synchronisation error"));
}

void ObjectDictionary::add_counts() {
    std::map<std::uint16_t, std::uint8_t> last;  // of each object
    for (const auto& entry : entries_) last[entry.index_] = std::max(last[entry.index_], entry.sub_);
    for (const auto& [index, sub] : last)
        if (sub > 0) add(number(index, 0, DataType::U8, sub, count_name));  // goes again where the description has its own
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

std::span<const Entry> ObjectDictionary::object(std::uint16_t index) const noexcept {
    const auto before = [](const Entry& entry, std::uint16_t key) { return entry.index_ < key; };
    const auto first = std::lower_bound(entries_.begin(), entries_.end(), index, before);
    const auto end = std::find_if(first, entries_.end(), [&](const Entry& entry) { return entry.index_ != index; });
    return {first, end};
}

ObjectShape ObjectDictionary::shape(std::uint16_t index) const noexcept {
    const auto entries = object(index);
    if (entries.size() <= 1) return {};
    if (entries.back().role_ == EntryRole::mapping_entry) return {ObjectCode::record, coe_type::pdo_mapping};
    if (index == 0x1018) return {ObjectCode::record, coe_type::identity};
    if (index == 0x1C32 || index == 0x1C33) return {ObjectCode::record, coe_type::sm_synchronisation};
    const bool alike = std::all_of(entries.begin() + 1, entries.end(), [&](const Entry& e) { return e.type_ == entries.back().type_; });
    return alike ? ObjectShape{ObjectCode::array, 0} : ObjectShape{ObjectCode::record, coe_type::record};
}

std::string_view ObjectDictionary::object_name(std::uint16_t index) const noexcept {
    const auto entries = object(index);
    if (entries.empty()) return {};
    switch (index) {
        case 0x1018: return "identity";
        case 0x1C00: return "sync manager types";
        case 0x1C12: return "assigned RxPDOs";
        case 0x1C13: return "assigned TxPDOs";
        case 0x1C32: return "synchronisation of the outputs";
        case 0x1C33: return "synchronisation of the inputs";
        default: break;
    }
    if (entries.back().role_ == EntryRole::mapping_entry || entries.front().role_ == EntryRole::mapping_count)
        return index < 0x1800 ? "RxPDO mapping" : "TxPDO mapping";
    if (entries.size() == 1 || entries.front().name_ != count_name) return entries.front().name_;
    std::string_view common = entries[1].name_;
    for (const auto& entry : entries.subspan(1)) {
        const std::string_view name = entry.name_;
        const auto differs = std::mismatch(common.begin(), common.end(), name.begin(), name.end());
        common = common.substr(0, static_cast<std::size_t>(differs.first - common.begin()));
    }
    if (entries.size() > 2) common = common.substr(0, std::min(common.size(), common.find_last_of(" :,") + 1));  // whole words
    while (!common.empty() && (common.back() == ' ' || common.back() == ':' || common.back() == ',')) common.remove_suffix(1);
    return common.empty() ? std::string_view{entries[1].name_} : common;
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
