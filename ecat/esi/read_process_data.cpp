// Sync managers and PDOs. ETG.2000: Device/Sm, Device/RxPdo, Device/TxPdo.

#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"

namespace taktwerk::ecat::esi {

namespace {

constexpr std::int64_t most_bits = 1486 * 8;  // of all process data of a frame

/// Register 0804h + 8 n: bits 0 and 1 mailbox (2) or not, bits 2 and 3 written by the master (1) or read (0). ETG.1000.4.
SmUse use_by_control(std::uint8_t control) noexcept {
    const bool mailbox = (control & 0x03u) == 2, written = (control & 0x0Cu) == 4;
    if (mailbox) return written ? SmUse::mailbox_out : SmUse::mailbox_in;
    return written ? SmUse::outputs : SmUse::inputs;
}

std::optional<SmUse> use_of(const std::string& text) {
    if (text == "MBoxOut") return SmUse::mailbox_out;
    if (text == "MBoxIn") return SmUse::mailbox_in;
    if (text == "Outputs") return SmUse::outputs;
    if (text == "Inputs") return SmUse::inputs;
    return std::nullopt;
}

/// "1", "0", and what some files have instead of them: "true".
bool depends_on_slot(const Element& index) { return index.flag("DependOnSlot"); }

EsiEntry read_entry(const Element& entry) {
    entry.knows({"Index", "SubIndex", "BitLen", "Name", "DataType"}, {"Fixed"});
    EsiEntry out;
    const auto index = entry.child("Index");
    if (index) index.knows({}, {"DependOnSlot", "DependOnSlotGroup"});
    out.index = static_cast<std::uint16_t>(entry.required_number_of("Index", 0, u16).value_or(0));
    out.sub = static_cast<std::uint8_t>(entry.number_of("SubIndex", 0, u8).value_or(0));
    out.bits = static_cast<std::uint32_t>(entry.required_number_of("BitLen", 0, most_bits).value_or(0));
    out.name = entry.in_english("Name");
    out.type = entry.text_of("DataType");
    out.depends_on_slot = index && depends_on_slot(index);
    return out;
}

}  // namespace

EsiPdo read_pdo(const Element& pdo) {
    pdo.knows({"Index", "Name", "Exclude", "Entry"},
              {"Fixed", "Mandatory", "Virtual", "Sm", "Su", "OSFac", "OSMin", "OSMax", "OSIndexInc"});
    EsiPdo out;
    out.index = static_cast<std::uint16_t>(pdo.required_number_of("Index", 0, u16).value_or(0));
    out.depends_on_slot = pdo.child("Index") && depends_on_slot(pdo.child("Index"));
    out.name = pdo.in_english("Name");
    if (const auto sm = pdo.number_in("Sm", 0, 15)) out.sync_manager = static_cast<std::uint8_t>(*sm);
    out.fixed = pdo.flag("Fixed");
    out.mandatory = pdo.flag("Mandatory");
    out.is_virtual = pdo.flag("Virtual");
    if (const auto copies = pdo.number_in("OSFac", 0, u16); copies && *copies > 1) out.oversampling = static_cast<unsigned>(*copies);
    for (const auto& other : pdo.children("Exclude"))
        if (const auto index = other.number(0, u16)) out.excludes.push_back(static_cast<std::uint16_t>(*index));
    for (const auto& entry : pdo.children("Entry")) out.entries.push_back(read_entry(entry));
    return out;
}

EsiSyncManager read_sync_manager(const Element& sm) {
    sm.knows({}, {"MinSize", "MaxSize", "DefaultSize", "StartAddress", "ControlByte", "Enable", "Virtual", "OpOnly", "No"});
    EsiSyncManager out;
    out.is_virtual = sm.flag("Virtual");
    out.enable = parse_number(sm.attribute("Enable")).value_or(1) % 2 != 0;  // some files write the whole register
    out.op_only = sm.flag("OpOnly");
    out.start = static_cast<std::uint16_t>(sm.number_in("StartAddress", 0, u16).value_or(0));
    out.size = static_cast<std::uint16_t>(sm.number_in("DefaultSize", 0, u16).value_or(0));
    const auto control = sm.number_in("ControlByte", 0, u8);
    out.control = static_cast<std::uint8_t>(control.value_or(0));
    out.use = use_of(sm.text());
    if (!out.use && control) out.use = use_by_control(out.control);
    return out;
}

}  // namespace taktwerk::ecat::esi
