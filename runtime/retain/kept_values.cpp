#include "runtime/retain/kept_values.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "fb_library/block_type.hpp"
#include "runtime/retain/value_type.hpp"

namespace taktwerk::runtime {

namespace {

using What = RetainNote::What;

constexpr std::uint64_t hash_begin = 0xcbf29ce484222325;  // FNV-1a
constexpr Unclaimed most_starts = 0xFFFF;

std::uint64_t layout_of(const fb::BlockType& type) noexcept { return fb::layout_hash(hash_begin, type); }
bool is_kept(const fb::Pin& pin) noexcept { return size_of(pin.type.kind) != 0; }

std::uint64_t bits_at(const std::byte* place, std::size_t size) noexcept {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) bits |= std::to_integer<std::uint64_t>(place[i]) << (8 * i);
    return bits;
}
void put(std::byte* place, std::size_t size, std::uint64_t bits) noexcept {
    for (std::size_t i = 0; i < size; ++i) place[i] = static_cast<std::byte>(bits >> (8 * i) & 0xFF);
}
/// What a pin of the type can hold: a TRUE that is 2, or a fifth of four modes, no block has ever had.
bool possible(const fb::Pin& pin, std::uint64_t bits) noexcept {
    if (pin.type.kind == fb::PinKind::BOOL) return bits <= 1;
    return pin.type.kind != fb::PinKind::ENUM || bits < pin.type.values.size();
}

/// By name.
template <class T>
class Index {
public:
    explicit Index(const std::vector<T>& items) {
        for (const auto& item : items) sorted_.push_back(&item);
        std::sort(sorted_.begin(), sorted_.end(), [](const T* a, const T* b) { return a->name < b->name; });
    }
    [[nodiscard]] const T* find(std::string_view name) const {
        const auto found =
            std::lower_bound(sorted_.begin(), sorted_.end(), name, [](const T* item, std::string_view n) { return item->name < n; });
        return found == sorted_.end() || (*found)->name != name ? nullptr : *found;
    }

private:
    std::vector<const T*> sorted_;
};
std::string name_of(const MachineLayout::ParameterInfo& info) { return info.program + "." + info.name; }
std::string shown(const KeptValue& kept) { return fmt::format("{} {}", word(kept.type), text_of(kept.type, kept.bits)); }

/// Not in a cold start: what is no persistent.
bool survives(RetainKind kind, RetainStart start) noexcept {
    return start == RetainStart::warm || (start == RetainStart::cold && kind == RetainKind::persistent);
}

}  // namespace

struct KeptValues::Found {
    explicit Found(const Kept& kept) : values(kept.values), blocks(kept.blocks), parameters(kept.parameters) {}
    Index<KeptValue> values;
    Index<KeptBlock> blocks;
    Index<KeptParameter> parameters;
};

RetainNote KeptValues::restore_value(const RetainedItem& item, const KeptValue* kept, std::span<const RetainBound> bounds) {
    if (kept == nullptr) return {What::added, item.name, {}};
    const auto value = converted(kept->type, kept->bits, item.type);
    if (!value)
        return {What::refused, item.name,
                fmt::format("'{}' was {}, which is no {}: it begins with its first value", item.name, shown(*kept), word(item.type))};
    for (const auto& bound : bounds) {
        if (bound.address != item.address) continue;
        const auto as_number = converted(item.type, value->bits, fb::PinKind::LREAL);
        double number = 0;
        if (as_number) std::memcpy(&number, &as_number->bits, sizeof number);
        if (!as_number || !bound.variable->takes(number))
            return {What::refused, item.name,
                    fmt::format("'{}' was {}, and people may write {} to {}: it begins with its first value", item.name, shown(*kept),
                                bound.variable->minimum, bound.variable->maximum)};
    }
    put(static_cast<std::byte*>(item.address), item.size, value->bits);
    if (kept->type == item.type) return {What::kept, item.name, {}};
    return {What::converted, item.name,
            fmt::format("'{}' was {} and is {} now: {}{}", item.name, shown(*kept), word(item.type), text_of(item.type, value->bits),
                        value->rounded ? " (rounded)" : "")};
}

RetainNote KeptValues::restore_block(const RetainedItem& item, const Found& kept, const KeptBlock* block) {
    const auto& type = *item.block;
    auto* place = static_cast<std::byte*>(item.address);
    if (block != nullptr && block->type == type.name && block->layout == layout_of(type) && block->bytes.size() == type.size) {
        const bool whole = std::all_of(type.pins.begin(), type.pins.end(), [&](const fb::Pin& pin) {
            return !is_kept(pin) || possible(pin, bits_at(block->bytes.data() + pin.offset, pin.size));
        });
        if (whole) {
            auto bytes = block->bytes;
            for (const auto& pin : type.pins)  // a handle is what the program of today has declared
                if (!is_kept(pin)) std::memcpy(bytes.data() + pin.offset, place + pin.offset, pin.size);
            std::memcpy(place, bytes.data(), bytes.size());
            return {What::kept, item.name, {}};
        }
    }
    std::size_t found = 0;
    for (const auto& pin : type.pins) {
        const auto* value = is_kept(pin) ? kept.values.find(fmt::format("{}.{}", item.name, pin.name)) : nullptr;
        const auto fits = value != nullptr ? converted(value->type, value->bits, pin.type.kind) : std::nullopt;
        if (!fits || !possible(pin, fits->bits)) continue;
        put(place + pin.offset, pin.size, fits->bits);
        ++found;
    }
    if (found == 0) return {What::added, item.name, {}};
    return {What::converted, item.name,
            fmt::format("'{}' was another block and is {} now: {} of its pins have their values, the rest of it begins anew", item.name,
                        type.name, found)};
}

std::vector<RetainNote> KeptValues::restore(const Kept& kept, RetainStart start, std::span<double> values,
                                            std::span<const RetainBound> bounds) {
    std::vector<RetainNote> notes;
    const Found found(kept);
    configured_.assign(values.begin(), values.end());
    for (const auto& item : items_) {
        const auto* value = found.values.find(item.name);
        const auto* block = found.blocks.find(item.name);
        if (!survives(item.kind, start)) {
            if (value != nullptr || block != nullptr) notes.push_back({What::cold, item.name, {}});
            continue;
        }
        notes.push_back(item.block != nullptr ? restore_block(item, found, block) : restore_value(item, value, bounds));
        if (item.block != nullptr && notes.back().what == What::kept) warm_.push_back(static_cast<std::size_t>(&item - items_.data()));
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const auto name = name_of(parameters_[i]);
        const auto* set = found.parameters.find(name);
        if (set == nullptr) continue;
        if (start == RetainStart::origin) notes.push_back({What::cold, name, {}});
        else if (set->configured != configured_[i])
            notes.push_back(
                {What::configured, name,
                 fmt::format(
                     "parameter '{}' was set to {} when {} was configured; the machine file or the program says {} now, and that holds",
                     name, set->value, set->configured, configured_[i])});
        else if (!parameters_[i].takes(set->value))
            notes.push_back({What::refused, name,
                             fmt::format("parameter '{}' was set to {}, and takes {} to {} now: it is {} as configured", name, set->value,
                                         parameters_[i].minimum, parameters_[i].maximum, configured_[i])});
        else {
            values[i] = set->value;
            notes.push_back({What::kept, name, {}});
        }
    }
    keep_unclaimed(kept, start, notes);
    return notes;
}

void KeptValues::keep_unclaimed(const Kept& kept, RetainStart start, std::vector<RetainNote>& notes) {
    std::vector<std::string> claimed;
    for (const auto& item : items_) {
        claimed.push_back(item.name);
        if (item.block == nullptr) continue;
        for (const auto& pin : item.block->pins) claimed.push_back(fmt::format("{}.{}", item.name, pin.name));
    }
    for (const auto& parameter : parameters_) claimed.push_back(name_of(parameter));
    std::sort(claimed.begin(), claimed.end());
    const auto take = [&](const auto& from, auto& to, auto lives, auto told) {
        for (const auto& one : from) {
            if (std::binary_search(claimed.begin(), claimed.end(), one.name)) continue;
            if (!lives(one)) continue;
            to.push_back(one);
            if (to.back().unclaimed < most_starts) ++to.back().unclaimed;
            if (one.unclaimed == 0) notes.push_back({What::unclaimed, one.name, told(one)});  // once, not at each start
        }
        // Those that somebody had last stay the longest.
        std::stable_sort(to.begin(), to.end(), [](const auto& a, const auto& b) { return a.unclaimed < b.unclaimed; });
        const auto most = std::is_same_v<std::decay_t<decltype(to)>, std::vector<KeptBlock>> ? most_unclaimed_blocks : most_unclaimed;
        if (to.size() > most) to.resize(most);
    };
    const auto by_kind = [&](const auto& one) { return survives(one.kind, start); };
    take(kept.values, aside_.values, by_kind, [](const KeptValue& one) {
        return fmt::format("'{}' ({}) belongs to no program any more: it is kept aside for one that has it again", one.name, shown(one));
    });
    take(kept.blocks, aside_.blocks, by_kind, [](const KeptBlock& one) {
        return fmt::format("block '{}' ({}) belongs to no program any more: it is kept aside for one that has it again", one.name,
                           one.type);
    });
    take(
        kept.parameters, aside_.parameters, [&](const KeptParameter&) { return start != RetainStart::origin; },
        [](const KeptParameter& one) {
            return fmt::format("parameter '{}' ({}) belongs to no program any more: it is kept aside for one that has it again", one.name,
                               one.value);
        });
}

void KeptValues::write(std::span<const std::byte> image, std::span<const double> values, Kept& out) const {
    const auto* place = image.data();
    for (const auto& item : items_) {
        if (item.block == nullptr) {
            out.values.push_back({item.name, item.kind, item.type, bits_at(place, item.size), 0});
        } else {
            out.blocks.push_back(
                {item.name, item.kind, std::string(item.block->name), layout_of(*item.block), {place, place + item.size}, 0});
            for (const auto& pin : item.block->pins)
                if (is_kept(pin))
                    out.values.push_back(
                        {fmt::format("{}.{}", item.name, pin.name), item.kind, pin.type.kind, bits_at(place + pin.offset, pin.size), 0});
        }
        place += item.size;
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i)
        if (values[i] != configured_[i]) out.parameters.push_back({name_of(parameters_[i]), values[i], configured_[i], 0});
    out.values.insert(out.values.end(), aside_.values.begin(), aside_.values.end());
    out.blocks.insert(out.blocks.end(), aside_.blocks.begin(), aside_.blocks.end());
    out.parameters.insert(out.parameters.end(), aside_.parameters.begin(), aside_.parameters.end());
}

}  // namespace taktwerk::runtime
