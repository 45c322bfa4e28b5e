#include "axes/sim/parameter_store.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::axes::sim {

namespace {

constexpr auto key = [](const ParameterAddress& at) { return std::pair{at.index, at.sub}; };

/// SV33-E P05.10: bit 0 stores the maker's objects, bit 1 those of the standard. A drive with a plain switch has 1 or 3 for "all".
constexpr std::int64_t switch_bit(const ParameterAddress& at) noexcept { return at.index < 0x6000 ? 1 : 2; }

}  // namespace

ParameterStore::ParameterStore(const DriveProfile& profile, std::span<const ParameterAddress> transient)
    : storage_(profile.storage.way), storage_switch_(profile.storage.switched_by), recent_(often + 1) {
    for (unsigned axis = 0; axis < profile.axes; ++axis)
        for (const auto& row : profile.parameters) {
            if (row.bits == 0) continue;
            // What the drive has once (identity, 2000h of the whole drive) has no copy for the further axes.
            const auto index = static_cast<std::uint16_t>(row.address.index + axis * profile.object_offset);
            Cell cell;
            cell.address = {index, row.address.sub};
            cell.factory = cell.ram = cell.eeprom = cell.acting = row.value;
            cell.minimum = row.minimum;
            cell.maximum = row.maximum;
            cell.effect = row.effect;
            cell.change = row.change;
            cell.transient = row.action || std::find(transient.begin(), transient.end(), row.address) != transient.end();
            cells_.push_back(cell);
        }
    const auto before = [](const Cell& a, const Cell& b) { return key(a.address) < key(b.address); };
    std::stable_sort(cells_.begin(), cells_.end(), before);
    const auto same = [](const Cell& a, const Cell& b) { return a.address == b.address; };
    cells_.erase(std::unique(cells_.begin(), cells_.end(), same), cells_.end());
}

const ParameterStore::Cell* ParameterStore::find(ParameterAddress at) const noexcept {
    const auto cell = std::lower_bound(cells_.begin(), cells_.end(), at,
                                       [](const Cell& c, const ParameterAddress& wanted) { return key(c.address) < key(wanted); });
    return cell != cells_.end() && cell->address == at ? &*cell : nullptr;
}

ParameterStore::Refusal ParameterStore::refuse(ParameterAddress at, std::int64_t value, bool enabled) const noexcept {
    const Cell* cell = find(at);
    if (!cell) return Refusal::unknown;
    if (cell->change == ParameterChange::never) return Refusal::read_only;
    if (cell->maximum && value > *cell->maximum) return Refusal::too_high;
    if (cell->minimum && value < *cell->minimum) return Refusal::too_low;
    return cell->change == ParameterChange::disabled && enabled ? Refusal::enabled : Refusal::none;
}

bool ParameterStore::stores_writes_to(const Cell& cell) const noexcept {
    // Where the manual is silent a written value is kept: an engineer finds it again after switching on (SV-DA200).
    const bool kept = storage_ == ParameterStorage::each_write || storage_ == ParameterStorage::not_stated;
    if (!kept || cell.transient) return false;
    return storage_switch_.index == 0 || (value(storage_switch_).value_or(0) & switch_bit(cell.address)) != 0;
}

void ParameterStore::burn(Cell& cell, std::int64_t value, Instant now) noexcept {
    cell.eeprom = value;
    ++eeprom_writes_;
    recent_[next_recent_] = now;
    next_recent_ = (next_recent_ + 1) % recent_.size();
}

void ParameterStore::write(ParameterAddress at, std::int64_t value, Instant now) noexcept {
    auto* cell = const_cast<Cell*>(find(at));  // NOLINT: the cell belongs to *this
    if (!cell || cell->change == ParameterChange::never) return;
    cell->ram = value;
    const bool waits = cell->effect == ParameterEffect::after_restart || cell->effect == ParameterEffect::after_saving;
    if (!waits) cell->acting = value;
    if (stores_writes_to(*cell)) burn(*cell, value, now);
}

void ParameterStore::commission(ParameterAddress at, std::int64_t value) noexcept {
    auto* cell = const_cast<Cell*>(find(at));  // NOLINT: the cell belongs to *this
    if (cell) cell->eeprom = value;
}

void ParameterStore::power_on() noexcept {
    for (auto& cell : cells_) cell.ram = cell.acting = cell.eeprom;
}

void ParameterStore::save(Instant now) noexcept {
    for (auto& cell : cells_)
        if (!cell.transient && cell.change != ParameterChange::never && cell.eeprom != cell.ram) burn(cell, cell.ram, now);
}

void ParameterStore::restore_factory(Instant now) noexcept {
    for (auto& cell : cells_)
        if (cell.eeprom != cell.factory) burn(cell, cell.factory, now);
}

std::optional<std::int64_t> ParameterStore::value(ParameterAddress at) const noexcept {
    const Cell* cell = find(at);
    return cell ? std::optional{cell->ram} : std::nullopt;
}

std::optional<std::int64_t> ParameterStore::acting(ParameterAddress at) const noexcept {
    const Cell* cell = find(at);
    return cell ? std::optional{cell->acting} : std::nullopt;
}

bool ParameterStore::restart_pending() const noexcept {
    return std::any_of(cells_.begin(), cells_.end(), [](const Cell& c) { return c.ram != c.acting; });
}

bool ParameterStore::writes_too_often(Instant now) const noexcept {
    return eeprom_writes_ > often && now - recent_[next_recent_] < window;  // the oldest of the last `often` + 1
}

}  // namespace taktwerk::axes::sim
