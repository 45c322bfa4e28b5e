// Slots and the modules that they take. ETG.2000: Device/Slots, Descriptions/Modules; ETG.5001 says what the increments mean.

#include <algorithm>

#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"

namespace taktwerk::ecat::esi {

namespace {

EsiSlot read_slot(const Element& slot) {
    slot.knows({"Name", "ModuleIdent", "ModuleClass"}, {"MinInstances", "MaxInstances", "SlotPdoIncrement", "SlotIndexIncrement"});
    EsiSlot out;
    out.name = slot.in_english("Name");
    out.minimum = static_cast<unsigned>(slot.number_in("MinInstances", 0, u16).value_or(0));
    out.maximum = static_cast<unsigned>(slot.number_in("MaxInstances", 0, u16).value_or(1));
    if (const auto step = slot.number_in("SlotPdoIncrement", 0, u16)) out.pdo_increment = static_cast<std::uint16_t>(*step);
    if (const auto step = slot.number_in("SlotIndexIncrement", 0, u16)) out.index_increment = static_cast<std::uint16_t>(*step);
    for (const auto& ident : slot.children("ModuleIdent")) {
        ident.knows({}, {"Default"});
        const auto number = ident.number(0, u32);
        if (!number) continue;
        out.idents.push_back(static_cast<std::uint32_t>(*number));
        if (ident.flag("Default")) out.default_ident = out.idents.back();
    }
    for (const auto& one : slot.children("ModuleClass")) {
        one.knows({"Class", "Name", "VendorId"});
        const auto name = one.text_of("Class");
        out.classes.push_back(name.empty() ? one.text() : name);
    }
    return out;
}

template <class T>
bool contains(const std::vector<T>& list, const T& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

EsiSlots read_slots(const Element& slots) {
    slots.knows({"Slot"}, {"MaxSlotCount", "SlotPdoIncrement", "SlotIndexIncrement", "IdentifyModuleBy", "DownloadModuleIdentList"});
    EsiSlots out;
    out.maximum = static_cast<unsigned>(slots.number_in("MaxSlotCount", 0, u16).value_or(0));
    out.pdo_increment = static_cast<std::uint16_t>(slots.number_in("SlotPdoIncrement", 0, u16).value_or(0));
    out.index_increment = static_cast<std::uint16_t>(slots.number_in("SlotIndexIncrement", 0, u16).value_or(0));
    out.identify_by = slots.attribute("IdentifyModuleBy");
    out.download_idents = slots.flag("DownloadModuleIdentList");
    for (const auto& slot : slots.children("Slot")) out.slots.push_back(read_slot(slot));
    return out;
}

EsiModule read_module(const Element& module) {
    module.knows({"Type", "Name", "RxPdo", "TxPdo", "Mailbox", "Profile"});
    EsiModule out;
    const auto type = module.child("Type");
    type.knows({}, {"ModuleIdent", "ModuleClass"});
    out.type = type.text();
    out.ident = static_cast<std::uint32_t>(type.number_in("ModuleIdent", 0, u32).value_or(0));
    out.module_class = type.attribute("ModuleClass");
    out.name = module.in_english("Name");
    for (const auto& pdo : module.children("RxPdo")) out.rx.push_back(read_pdo(pdo));
    for (const auto& pdo : module.children("TxPdo")) out.tx.push_back(read_pdo(pdo));
    if (const auto mailbox = module.child("Mailbox")) out.init_commands = read_mailbox(mailbox).init_commands;
    std::vector<unsigned> profiles;
    for (const auto& profile : module.children("Profile")) read_profile(profile.can_do_without(), profiles, out.objects);
    return out;
}

bool fits(const EsiSlots& slots, const EsiModule& module) {
    return std::any_of(slots.slots.begin(), slots.slots.end(), [&](const EsiSlot& slot) {
        return contains(slot.idents, module.ident) || (!module.module_class.empty() && contains(slot.classes, module.module_class));
    });
}

}  // namespace taktwerk::ecat::esi
