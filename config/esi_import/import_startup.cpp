// Init commands, clock, slots.

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/esi_import/import_parts.hpp"

namespace taktwerk::config {

namespace {

using namespace ecat::esi;
using ecat::DataType;

bool has(const EsiInitCommand& command, const char* transition) {
    return std::find(command.transitions.begin(), command.transitions.end(), transition) != command.transitions.end();
}

/// Why a command cannot be a start-up value; empty: it can.
std::string obstacle(const EsiInitCommand& command, const ObjectRow* known) {
    const auto size = command.data.size();
    if (command.index == 0xF030) return "the master writes it itself, from `modules:` at the slave";
    if ((command.index >= 0x1600 && command.index <= 0x1BFF) || (command.index >= 0x1C10 && command.index <= 0x1C2F))
        return "the master assigns and maps PDOs itself, from `pdo:` at the slave";
    if (command.complete_access) return "an object in one piece: write its sub-indices, in `startup:` at the slave";
    if (size != 1 && size != 2 && size != 4 && size != 8) return fmt::format("{} bytes: a start-up value has 1, 2, 4 or 8", size);
    if (!has(command, "PS") && !has(command, "IP") && !has(command, "SO")) return "start-up values are written before SAFEOP or before OP";
    if (known != nullptr && known->object.access == ecat::Access::ro) return "the dictionary says that it is read-only";
    if (known != nullptr && ecat::bit_size(known->object.type) != 8 * size && !(known->object.type == DataType::BOOL && size == 1))
        return "its data have another length than the object";
    return {};
}

DataType unsigned_of_size(std::size_t bytes) {
    return bytes == 1 ? DataType::U8 : bytes == 2 ? DataType::U16 : bytes == 4 ? DataType::U32 : DataType::U64;
}

std::int64_t value_of(const std::vector<std::byte>& data, DataType type) {
    std::uint64_t value = 0;
    for (std::size_t n = data.size(); n-- > 0;) value = value << 8u | std::to_integer<std::uint64_t>(data[n]);
    const unsigned bits = 8 * static_cast<unsigned>(data.size());
    if (ecat::is_signed(type) && bits < 64 && (value >> (bits - 1) & 1u) != 0) value |= ~std::uint64_t{0} << bits;
    return static_cast<std::int64_t>(value);
}

std::string shown(const EsiInitCommand& command) {
    std::string data;
    for (const auto byte : command.data) data += fmt::format("{:02X}", std::to_integer<unsigned>(byte));
    return fmt::format("init command {} {:04X}h:{:02X} = {}{}", fmt::join(command.transitions, "/"), command.index, command.sub,
                       data.size() > 40 ? data.substr(0, 40) + "..." : data, command.comment.empty() ? "" : " (" + command.comment + ")");
}

}  // namespace

void import_startup(const EsiDevice& from, EsiImport& to) {
    if (!from.mailbox) return;
    for (const auto& command : from.mailbox->init_commands) {
        const auto row = std::find_if(to.file.objects.begin(), to.file.objects.end(), [&](const ObjectRow& one) {
            return one.object.index == command.index && one.object.sub == command.sub;
        });
        const ObjectRow* known = row == to.file.objects.end() ? nullptr : &*row;
        if (auto why = obstacle(command, known); !why.empty()) {
            to.leftovers.push_back({shown(command), std::move(why)});
            continue;
        }
        StartupEntry entry;
        entry.at = has(command, "PS") || has(command, "IP") ? ecat::Transition::PreopToSafeop : ecat::Transition::SafeopToOp;
        entry.object = {command.index, command.sub};
        const auto type = known != nullptr ? known->object.type : unsigned_of_size(command.data.size());
        if (known == nullptr) entry.type = type;
        entry.value = value_of(command.data, type);
        entry.comment = command.comment;
        const auto earlier = std::find_if(to.file.startup.begin(), to.file.startup.end(),
                                          [&](const StartupEntry& other) { return other.object == entry.object && other.at == entry.at; });
        if (earlier != to.file.startup.end()) {
            to.leftovers.push_back({shown(command), "written twice by the vendor: the later one is kept"});
            to.file.startup.erase(earlier);
        }
        to.file.startup.push_back(std::move(entry));
    }
}

void import_clock(const EsiDevice& from, EsiImport& to) {
    constexpr std::uint16_t sync0 = 0x0200, sync1 = 0x0400, latch_or_sync = 0x0100;  // 0981h, the high byte
    const auto uses = [](const EsiOpMode& mode, std::uint16_t bit) { return (mode.assign_activate & bit) != 0; };
    const auto& modes = from.op_modes;
    auto& dc = to.file.device.dc;
    dc.supported = !modes.empty() && uses(modes.front(), sync0);
    dc.required = dc.supported && std::all_of(modes.begin(), modes.end(), [&](const EsiOpMode& mode) { return uses(mode, sync0); });
    for (const auto& mode : modes) {
        const auto what = fmt::format("mode '{}' of the clock ({:04X}h{})", mode.name, mode.assign_activate,
                                      mode.description.empty() || mode.description == mode.name ? "" : ", " + mode.description);
        const bool factory = &mode == &modes.front();
        if (!uses(mode, sync0)) {
            if (uses(mode, latch_or_sync)) to.leftovers.push_back({what, "a clock without SYNC0: not known here"});
            else if (!factory) to.leftovers.push_back({what, "write `dc: false` at the slave for it"});
            continue;
        }
        std::string at_slave;
        if (!dc.supported) at_slave = "the vendor's first mode has no clock: write `dc: { supported: true }` in the file for SYNC0";
        else if (!factory) at_slave = "SYNC0 comes once a cycle, as in the first mode";
        if (mode.sync0_factor < -1 || mode.sync0_cycle != Duration::zero())
            at_slave += "; SYNC0 at another time than the cycle is not known here";
        if (mode.sync0_shift != Duration::zero())
            at_slave += fmt::format("; shift: `sync0_shift: {} us` at the slave", static_cast<double>(mode.sync0_shift.count()) / 1000);
        if (uses(mode, sync1)) at_slave += "; SYNC1: `sync1:` at the slave";
        if (at_slave.rfind("; ", 0) == 0) at_slave.erase(0, 2);
        if (!at_slave.empty()) to.leftovers.push_back({what, at_slave});
    }
}

Result<void> import_slots(const EsiDevice& from, EsiImport& to) {
    if (!from.slots) return {};
    const auto& slots = *from.slots;
    auto& out = to.file.device.slots;
    unsigned count = slots.maximum;
    if (count == 0)
        for (const auto& slot : slots.slots) count += std::min(slot.maximum, 255u);
    constexpr unsigned most = 255;
    if (count > most) to.leftovers.push_back({fmt::format("slots beyond the first {} of {}", most, count), "no more can be named"});
    out.count = static_cast<std::uint8_t>(std::clamp(count, 1u, most));
    out.may_be_empty = true;
    out.pdo_increment = slots.pdo_increment, out.index_increment = slots.index_increment;
    std::set<std::string> taken;
    for (const auto& module : from.modules) {
        ecat::ModuleDescription one;
        one.name = module.type.empty() ? fmt::format("module-{:x}", module.ident) : module.type;
        if (taken.count(one.name) != 0) one.name += fmt::format(" {:X}h", module.ident);
        if (!taken.insert(one.name).second) {
            to.leftovers.push_back({fmt::format("module {} once more", one.name), "the first of that ident and type is kept"});
            continue;
        }
        one.ident = module.ident;
        bool moves = true;
        for (const bool rx : {true, false})
            for (const auto& pdo : rx ? module.rx : module.tx) {
                auto made = import_pdo(pdo, from, to);
                if (!made) return made.error();
                moves = moves && pdo.depends_on_slot;
                (rx ? one.rx_pdos : one.tx_pdos).push_back(std::move(*made));
            }
        if (!moves && out.pdo_increment != 0)
            to.leftovers.push_back({fmt::format("module {}: its PDOs keep their numbers in every slot", one.name),
                                    "here each slot adds the increment: use it in slot 0 only"});
        if (!module.init_commands.empty())
            to.leftovers.push_back({fmt::format("module {}: {} init commands", one.name, module.init_commands.size()),
                                    "write them in `startup:` at the slave"});
        if (!module.objects.empty())
            to.leftovers.push_back(
                {fmt::format("module {}: {} values of its dictionary", one.name, module.objects.size()), "`bus sdo` takes them by number"});
        out.modules.push_back(std::move(one));
    }
    if (slots.slots.size() > 1)
        to.leftovers.push_back({fmt::format("which of the {} kinds of slot takes which module", slots.slots.size()),
                                "here every slot takes every module: compare with the manual"});
    for (const auto& slot : slots.slots) {
        if (slot.pdo_increment || slot.index_increment)
            to.leftovers.push_back({fmt::format("slot '{}' has increments of its own", slot.name), "here all slots have the same"});
        if (slot.minimum > 0)
            to.leftovers.push_back(
                {fmt::format("slot '{}' must be filled ({} at least)", slot.name, slot.minimum), "list its modules at the slave"});
    }
    if (!from.modules.empty())
        to.leftovers.push_back({"names for the values of modules", "a point gives the object as it is in its slot: `object: 6010h:01`"});
    return {};
}

}  // namespace taktwerk::config
