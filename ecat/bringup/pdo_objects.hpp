#pragma once
// The objects of a slave that hold its PDOs: 16xxh and 1Axxh what each carries, 1C10h + sync manager which are exchanged. Source: ETG.1000.6
// 5.6.7.4. Service side only; errors of slave_objects.hpp.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// The assignment object of a sync manager: 1C12h of the second.
[[nodiscard]] constexpr std::uint16_t assignment_of(std::uint8_t sync_manager) noexcept {
    return static_cast<std::uint16_t>(0x1C10 + sync_manager);
}

/// The number by which 16xxh and 1Axxh name an object.
[[nodiscard]] constexpr std::uint32_t mapped_as(const PdoEntry& entry) noexcept {
    return (std::uint32_t{entry.index} << 16) | (std::uint32_t{entry.sub} << 8) | entry.bits;
}

/// Count 0, entries, count. The PDO must not be assigned meanwhile.
[[nodiscard]] Script<Result<void>> write_mapping(Bus& bus, BusSlave& slave, const PdoDescription& pdo);
/// PDOs, then their count. It was written 0 before.
[[nodiscard]] Script<Result<void>> write_assigned(Bus& bus, BusSlave& slave, std::uint16_t assignment,
                                                  const std::vector<PdoDescription>& pdos);
[[nodiscard]] Script<Result<PdoDescription>> read_mapping(Bus& bus, BusSlave& slave, std::uint16_t index);
/// The numbers of an assignment object, without its empty places.
[[nodiscard]] Script<Result<std::vector<std::uint16_t>>> read_assignment(Bus& bus, BusSlave& slave, std::uint16_t assignment);

}  // namespace taktwerk::ecat
