// The SDO server's transfers of whole objects.
#include <algorithm>
#include <array>

#include "ecat/sim/complete_access.hpp"
#include "ecat/sim/sdo_server.hpp"

namespace taktwerk::ecat::sim {

namespace {

/// Mappings and assignments have as many entries as their sub-index 0 says, other objects all that are there.
bool is_list(std::span<const Entry> object) noexcept { return object.front().role() != EntryRole::plain; }

std::span<const Entry> first_entries(std::span<const Entry> object, std::int64_t count) noexcept {
    if (!is_list(object)) return object;
    return object.first(std::min<std::size_t>(object.size(), static_cast<std::size_t>(count) + 1));
}

}  // namespace

std::uint32_t SdoServer::refuse_complete(std::uint16_t index, std::uint8_t first) const noexcept {
    if (!description_.mailbox || !description_.mailbox->complete_access) return sdo_abort::no_complete_access;
    const auto object = dictionary_.object(index);
    if (object.empty()) return sdo_abort::no_object;
    if (first > 1) return sdo_abort::unsupported_access;
    return object.size() > 1 ? 0 : sdo_abort::no_complete_access;  // a variable has nothing to be complete with
}

std::uint32_t SdoServer::collect(std::uint16_t index, std::uint8_t first, std::span<const std::byte>& value) noexcept {
    if (const auto code = refuse_complete(index, first); code != 0) return code;
    const auto object = dictionary_.object(index);
    const bool readable = std::any_of(object.begin(), object.end(), [](const Entry& e) { return e.sub() > 0 && e.access() != Access::wo; });
    if (!readable) return sdo_abort::write_only;
    const auto entries = first_entries(object, object.front().get());
    const std::size_t size = pack_object(entries, first, value_);
    if (size == 0 && entries.size() > first) return sdo_abort::out_of_memory;
    value = std::span<const std::byte>{value_}.first(size);
    return 0;
}

std::uint32_t SdoServer::store_complete(std::uint16_t index, std::uint8_t first, std::span<const std::byte> data, EsmState state,
                                        Instant now) noexcept {
    auto object = dictionary_.object(index);
    if (first == 0 && data.size() < 2) return sdo_abort::too_short;
    const std::int64_t count = first == 0 ? static_cast<std::int64_t>(data[0]) : object.front().get();
    if (is_list(object) && static_cast<std::size_t>(count) >= object.size()) return sdo_abort::value_too_high;
    object = first_entries(object, count);
    const bool texts = std::any_of(object.begin(), object.end(), [](const Entry& e) { return e.type() == DataType::STRING; });
    if (texts) return sdo_abort::no_complete_access;
    const std::size_t size = (for_each_place(object, first, [](const Entry&, std::size_t) {}) + 7) / 8;
    if (data.size() != size) return data.size() > size ? sdo_abort::too_long : sdo_abort::too_short;

    const auto all = dictionary_.object(index);
    std::array<std::int64_t, 256> before{};
    for (const auto& entry : all) before[entry.sub()] = entry.get();
    const auto code = store_entries(object, first, data, state, now);
    if (code != 0)
        for (const auto& entry : all) dictionary_.find(index, entry.sub())->set(before[entry.sub()]);
    return code;
}

std::uint32_t SdoServer::store_entries(std::span<const Entry> object, std::uint8_t first, std::span<const std::byte> data, EsmState state,
                                       Instant now) noexcept {
    const std::uint16_t index = object.front().index();
    const auto entry_at = [&](std::uint8_t sub) -> Entry& { return *dictionary_.find(index, sub); };
    std::uint32_t code = 0;
    bool any_written = false;
    // The count to 0, the entries, the count: what a list asks of single transfers, the slave does itself here.
    const bool counted = first == 0 && object.front().access() != Access::ro;
    if (counted) code = store_value(entry_at(0), 0, state, now);
    for_each_place(object, first, [&](const Entry& place, std::size_t bit) {
        if (code != 0 || place.sub() == 0 || place.access() == Access::ro) return;  // what cannot be written keeps its value
        code = store_value(entry_at(place.sub()), value_at(place, data, bit), state, now);
        any_written = true;
    });
    if (code == 0 && counted) code = store_value(entry_at(0), static_cast<std::int64_t>(data[0]), state, now);
    if (code == 0 && !any_written && !counted) code = sdo_abort::read_only;
    return code;
}

}  // namespace taktwerk::ecat::sim
