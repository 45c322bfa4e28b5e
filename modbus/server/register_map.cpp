#include "modbus/server/register_map.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::modbus::server {

RegisterMap::RegisterMap(std::vector<ServedRegister> registers) : registers_(std::move(registers)) {
    for (std::size_t i = 0; i < registers_.size(); ++i)
        places_[static_cast<std::size_t>(registers_[i].table)].push_back({registers_[i].address, static_cast<std::uint16_t>(i)});
    for (auto& places : places_) std::ranges::stable_sort(places, {}, &Place::address);
}

std::optional<std::span<const RegisterMap::Place>> RegisterMap::find(Table table, std::uint16_t address,
                                                                     std::uint16_t count) const noexcept {
    const auto& places = places_[static_cast<std::size_t>(table)];
    const auto first = std::ranges::lower_bound(places, address, {}, &Place::address);
    const std::uint32_t end = std::uint32_t{address} + count;
    std::uint32_t covered = address;  // up to here
    auto last = first;
    for (; last != places.end() && last->address < end; ++last) {
        const auto& one = registers_[last->index];
        if (last->address > covered) return std::nullopt;
        covered = std::max(covered, end_of(one));
    }
    if (covered != end) return std::nullopt;  // too few, or the last one is cut
    return std::span<const Place>(first, last);
}

}  // namespace taktwerk::modbus::server
