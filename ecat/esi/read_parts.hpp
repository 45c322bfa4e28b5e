#pragma once
// The parts of a device, each read from its elements. What is wrong is reported to the element. Inside of ecat/esi only.

#include <string>
#include <vector>

#include "ecat/esi/element.hpp"
#include "ecat/esi/esi_device.hpp"

namespace taktwerk::ecat::esi {

/// Of a <Device>: type, names, identity, what it hides. Without its group and whether it is hidden.
[[nodiscard]] EsiHeading read_heading(const Element& device, std::uint32_t vendor);
/// The rest of it but modules.
void read_device(const Element& device, EsiDevice& out);

[[nodiscard]] EsiPdo read_pdo(const Element& pdo);
[[nodiscard]] EsiSyncManager read_sync_manager(const Element& sm);
[[nodiscard]] EsiMailbox read_mailbox(const Element& mailbox);
[[nodiscard]] std::vector<EsiOpMode> read_op_modes(const Element& dc);
[[nodiscard]] EsiSlots read_slots(const Element& slots);
[[nodiscard]] EsiModule read_module(const Element& module);
/// Does one of the slots take it?
[[nodiscard]] bool fits(const EsiSlots& slots, const EsiModule& module);
/// <Profile>: its number, and the objects of its dictionary as single sub-indices.
void read_profile(const Element& profile, std::vector<unsigned>& numbers, std::vector<EsiObject>& objects);

}  // namespace taktwerk::ecat::esi
