// Mailbox, protocols, init commands, clock. ETG.2000: Device/Mailbox, Device/Dc.

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"

namespace taktwerk::ecat::esi {

namespace {

EsiInitCommand read_init_command(const Element& command) {
    command.knows({"Transition", "Index", "SubIndex", "Data", "Comment"}, {"Fixed", "CompleteAccess"});
    EsiInitCommand out;
    for (const auto& transition : command.children("Transition")) out.transitions.push_back(transition.text());
    out.index = static_cast<std::uint16_t>(command.required_number_of("Index", 0, u16).value_or(0));
    out.sub = static_cast<std::uint8_t>(command.number_of("SubIndex", 0, u8).value_or(0));
    out.complete_access = command.flag("CompleteAccess");
    out.comment = command.in_english("Comment");
    const auto data = command.child("Data");
    if (auto bytes = parse_bytes(data.text())) out.data = std::move(*bytes);
    else
        data.problem("esi.bytes", fmt::format("Data is '{}', which are no bytes in hexadecimal", data.text().substr(0, 40)),
                     "write pairs of digits, the least byte first: 0A00");
    return out;
}

}  // namespace

EsiMailbox read_mailbox(const Element& mailbox) {
    mailbox.knows({"CoE", "EoE", "FoE", "SoE", "AoE", "VoE"}, {"DataLinkLayer"});
    EsiMailbox out;
    out.data_link_layer = mailbox.flag("DataLinkLayer");
    for (const char* protocol : {"EoE", "FoE", "SoE", "AoE", "VoE"})
        if (mailbox.child(protocol)) out.other_protocols.emplace_back(protocol);
    const auto soe = mailbox.child("SoE");
    if (soe) soe.knows({});  // its init commands and its mapping: IDNs, which nobody here speaks
    const auto coe = mailbox.child("CoE");
    if (!coe) return out;
    coe.knows({"InitCmd"}, {"SdoInfo", "PdoAssign", "PdoConfig", "PdoUpload", "CompleteAccess", "SegmentedSdo"});
    out.coe = EsiCoe{coe.flag("SdoInfo"),   coe.flag("PdoAssign"),      coe.flag("PdoConfig"),
                     coe.flag("PdoUpload"), coe.flag("CompleteAccess"), coe.flag("SegmentedSdo")};
    for (const auto& command : coe.children("InitCmd")) out.init_commands.push_back(read_init_command(command));
    return out;
}

std::vector<EsiOpMode> read_op_modes(const Element& dc) {
    using std::chrono::nanoseconds;
    dc.knows({"OpMode"});
    std::vector<EsiOpMode> out;
    for (const auto& mode : dc.children("OpMode")) {
        mode.knows({"Name", "Desc", "AssignActivate", "CycleTimeSync0", "ShiftTimeSync0", "CycleTimeSync1", "ShiftTimeSync1"});
        EsiOpMode one;
        one.name = mode.in_english("Name");
        one.description = mode.in_english("Desc");
        one.assign_activate = static_cast<std::uint16_t>(mode.number_of("AssignActivate", 0, u16).value_or(0));
        const auto time = [&](const char* name) { return nanoseconds(mode.number_of(name, -i32, i32).value_or(0)); };
        one.sync0_cycle = time("CycleTimeSync0"), one.sync0_shift = time("ShiftTimeSync0");
        one.sync1_cycle = time("CycleTimeSync1"), one.sync1_shift = time("ShiftTimeSync1");
        for (const char* name : {"CycleTimeSync0", "CycleTimeSync1"})
            if (const auto cycle = mode.child(name)) cycle.knows({}, {"Factor"});
        for (const char* name : {"ShiftTimeSync0", "ShiftTimeSync1"})
            if (const auto shift = mode.child(name)) shift.knows({});
        one.sync0_factor = mode.child("CycleTimeSync0").number_in("Factor", -i32, i32).value_or(0);
        one.sync1_factor = mode.child("CycleTimeSync1").number_in("Factor", -i32, i32).value_or(0);
        out.push_back(std::move(one));
    }
    return out;
}

}  // namespace taktwerk::ecat::esi
