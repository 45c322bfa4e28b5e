#pragma once
// The parts of a device that become parts of a device file. Each adds what it cannot carry to the leftovers. Inside of config/esi_import only.

#include "config/esi_import/esi_import.hpp"

namespace taktwerk::config {

/// Sync managers, PDOs, and whether they can be exchanged like this. Error esi.unusable.
[[nodiscard]] Result<void> import_process_data(const ecat::esi::EsiDevice& from, EsiImport& to);
/// The dictionary, with the objects of PDOs that it does not list.
void import_objects(const ecat::esi::EsiDevice& from, EsiImport& to);
/// Names for what the PDOs carry.
void import_channels(const ecat::esi::EsiDevice& from, EsiImport& to);
/// Init commands as start-up values.
void import_startup(const ecat::esi::EsiDevice& from, EsiImport& to);
void import_clock(const ecat::esi::EsiDevice& from, EsiImport& to);
[[nodiscard]] Result<void> import_slots(const ecat::esi::EsiDevice& from, EsiImport& to);

/// A PDO of the device or of a module. Error esi.unusable for a number that is none of a PDO.
[[nodiscard]] Result<ecat::PdoDescription> import_pdo(const ecat::esi::EsiPdo& from, const ecat::esi::EsiDevice& device, EsiImport& to);

}  // namespace taktwerk::config
