#include "ecat/bringup/modules.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/bringup/slave_objects.hpp"
#include "ecat/description/module_pdos.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t configured_modules = 0xF030, detected_modules = 0xF050;

/// Ident by slot; 0: nothing chosen.
std::vector<std::uint32_t> chosen_idents(const BusSlave& slave) {
    std::vector<std::uint32_t> idents(slave.device().slots.count, 0);
    for (const auto& selection : slave.config->modules)
        if (const auto* module = find_module(slave.device().slots, selection.module); module != nullptr && selection.slot < idents.size())
            idents[selection.slot] = module->ident;
    return idents;
}

std::string module_text(const SlotDescription& slots, std::uint32_t ident) {
    if (ident == 0) return "no module";
    const auto it = std::find_if(slots.modules.begin(), slots.modules.end(), [&](const ModuleDescription& m) { return m.ident == ident; });
    return it != slots.modules.end() ? fmt::format("'{}' ({:08X}h)", it->name, ident) : fmt::format("an unknown module ({:08X}h)", ident);
}

}  // namespace

Script<Result<void>> configure_modules(Bus& bus, BusSlave& slave) {
    const auto& slots = slave.device().slots;
    if (slots.count == 0 || slave.config->modules.empty() || !slave.has_coe()) co_return Result<void>{};
    const std::vector<std::uint32_t> idents = chosen_idents(slave);
    // Modules whose manual names no ident are a matter of the PDO assignment alone.
    if (std::all_of(idents.begin(), idents.end(), [](auto ident) { return ident == 0; })) co_return Result<void>{};
    bus.note(slave, "choosing its modules");

    std::vector<std::vector<std::byte>> entries;
    for (const auto ident : idents) {
        entries.emplace_back(4);
        store_le(entries.back(), 0, ident);
    }
    const Result<void> written = co_await sdo_download_list(bus.port, slave.mailbox, configured_modules, std::move(entries));
    if (!written && !is_absent(written.error()) && !is_read_only(written.error())) {
        remember_abort(slave, written.error());
        co_return written;
    }

    const Result<std::vector<std::vector<std::byte>>> detected = co_await sdo_upload_list(bus.port, slave.mailbox, detected_modules, 4);
    if (!detected && is_absent(detected.error())) co_return Result<void>{};
    if (!detected) {
        remember_abort(slave, detected.error());
        co_return detected.error();
    }
    for (std::size_t slot = 0; slot < idents.size(); ++slot) {
        const std::uint32_t found =
            slot < detected->size() && (*detected)[slot].size() >= 4 ? load_le<std::uint32_t>((*detected)[slot], 0) : 0;
        if (found == idents[slot]) continue;
        co_return Error{
            "bus.module_mismatch", slave.subject,
            fmt::format("slot {} holds {}, configured is {}", slot, module_text(slots, found), module_text(slots, idents[slot])),
            "plug the configured module, or choose the one that is there under `modules`"};
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
