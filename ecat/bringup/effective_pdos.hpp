#pragma once
// Which PDOs a slave has, from the three who may know: the slave itself (CoE), its EEPROM, the configuration. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

/// The PDOs that an EEPROM assigns, with their sync managers.
[[nodiscard]] std::vector<PdoDescription> assigned_in_eeprom(const std::vector<SiiPdo>& pdos);
/// An image whose categories break off lists fewer PDOs than the slave has.
[[nodiscard]] bool lists_all_pdos(const Sii& sii) noexcept;
/// The PDOs of a description that are assigned by factory default; all where it names none.
[[nodiscard]] std::vector<PdoDescription> assigned_by_default(const std::vector<PdoDescription>& pdos,
                                                              const std::vector<std::uint16_t>& assigned);

/// The process data of one direction of a slave that cannot be asked, and where it comes from.
struct EffectivePdos {
    std::vector<PdoDescription> pdos;
    std::string remark;  ///< worth a note; empty: EEPROM and configuration say the same
};
/// The layout (bits after bits) is the EEPROM's where it has one; the objects keep the configuration's names where both lay
/// out the same bits. `direction` for the remark: "outputs", "inputs".
[[nodiscard]] EffectivePdos without_coe(const std::vector<PdoDescription>& eeprom, const std::vector<PdoDescription>& configured,
                                        const std::string& direction);

/// The sync managers of an EEPROM as a description has them.
[[nodiscard]] std::vector<SyncManagerDescription> sync_managers_in_eeprom(const Sii& sii);

/// What was asked for and what the slave says. Error bus.pdo_mismatch shows the first difference and both sizes.
[[nodiscard]] Result<void> compare_pdos(const std::string& subject, std::uint16_t assignment, const std::vector<PdoDescription>& wanted,
                                        const std::vector<PdoDescription>& got);

/// The one with this index; null: none.
[[nodiscard]] const PdoDescription* find_pdo(const std::vector<PdoDescription>& pdos, std::uint16_t index) noexcept;

}  // namespace taktwerk::ecat
