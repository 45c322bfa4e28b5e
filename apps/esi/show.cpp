// taktwerk esi show FILE --device D: everything that a vendor's file says of one device.

#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/esi/esi.hpp"
#include "apps/esi/names.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {

namespace {

using namespace ecat::esi;

std::string indented(const std::string& text, std::size_t indent) { return std::string(indent, ' ') + wrapped(text, indent) + "\n"; }

std::string heading_text(const std::string& title, Colours colours) { return "\n" + toned(title, Tone::strong, colours) + "\n"; }

std::string bytes_text(const std::vector<std::byte>& bytes) {
    constexpr std::size_t most = 16;
    std::string out;
    for (std::size_t n = 0; n < bytes.size() && n < most; ++n) out += fmt::format("{:02X}", std::to_integer<unsigned>(bytes[n]));
    return bytes.size() > most ? out + fmt::format("... ({} bytes)", bytes.size()) : out;
}

std::string sync_managers_text(const EsiDevice& device, Colours colours) {
    if (device.sync_managers.empty()) return {};
    TextTable table({{"SM"}, {"use"}, {"start"}, {"bytes", TextTable::Column::Side::right}, {"control"}, {""}});
    for (std::size_t n = 0; n < device.sync_managers.size(); ++n) {
        const auto& sm = device.sync_managers[n];
        std::vector<std::string> marks;
        if (!sm.enable) marks.emplace_back("not enabled");
        if (sm.is_virtual) marks.emplace_back("virtual");
        if (sm.op_only) marks.emplace_back("in OP only");
        table.add({std::to_string(n), sm.use ? esi_use_name(*sm.use) : "not said", fmt::format("{:04X}h", sm.start),
                   sm.size > 0 ? std::to_string(sm.size) : std::string("-"), fmt::format("{:02X}h", sm.control),
                   fmt::format("{}", fmt::join(marks, ", "))});
    }
    return heading_text("Sync managers", colours) + table.text(colours, 2);
}

std::string pdo_marks(const EsiPdo& pdo) {
    std::vector<std::string> marks;
    marks.push_back(pdo.sync_manager ? fmt::format("in SM{}", *pdo.sync_manager) : "not assigned");
    if (pdo.fixed) marks.emplace_back("fixed");
    if (pdo.mandatory) marks.emplace_back("mandatory");
    if (pdo.is_virtual) marks.emplace_back("virtual");
    if (pdo.oversampling) marks.push_back(fmt::format("{} samples", *pdo.oversampling));
    if (!pdo.excludes.empty()) {
        std::vector<std::string> others;
        for (const auto other : pdo.excludes) others.push_back(fmt::format("{:04X}h", other));
        marks.push_back(fmt::format("not with {}", fmt::join(others, " ")));
    }
    return fmt::format("{}", fmt::join(marks, ", "));
}

std::string pdos_text(const char* title, const std::vector<EsiPdo>& pdos, Colours colours, std::size_t indent = 2) {
    std::string out;
    for (const auto& pdo : pdos) {
        out += indented(fmt::format("{} {:04X}h {}: {}", title, pdo.index, pdo.name, pdo_marks(pdo)), indent);
        TextTable table({{"object"},
                         {"bits", TextTable::Column::Side::right},
                         {"type", TextTable::Column::Side::left, 20},
                         {"name", TextTable::Column::Side::left, 44}});
        for (const auto& entry : pdo.entries) {
            if (entry.index == 0) table.add({"gap", std::to_string(entry.bits), "", Cell{entry.name, Tone::faint}});
            else table.add({fmt::format("{:04X}h:{:02X}", entry.index, entry.sub), std::to_string(entry.bits), entry.type, entry.name});
        }
        if (!table.empty()) out += table.text(colours, indent + 2);
    }
    return out;
}

std::string mailbox_text(const EsiMailbox& mailbox, Colours colours) {
    auto out = heading_text("Mailbox", colours);
    if (mailbox.coe) {
        std::vector<std::string> can;
        const auto add = [&](bool there, const char* what) {
            if (there) can.emplace_back(what);
        };
        add(mailbox.coe->sdo_info, "its dictionary can be listed");
        add(mailbox.coe->complete_access, "complete access");
        add(mailbox.coe->pdo_assign, "PDOs can be assigned");
        add(mailbox.coe->pdo_config, "PDOs can be mapped");
        add(mailbox.coe->pdo_upload, "PDOs are to be read from it");
        add(mailbox.coe->segmented_sdo, "segmented SDOs");
        out += indented(can.empty() ? std::string("CoE") : fmt::format("CoE: {}", fmt::join(can, ", ")), 2);
    }
    if (!mailbox.other_protocols.empty()) out += indented(fmt::format("also {}", fmt::join(mailbox.other_protocols, ", ")), 2);
    const auto ms = [](Duration time) { return std::chrono::duration_cast<std::chrono::milliseconds>(time).count(); };
    if (mailbox.request_timeout) out += indented(fmt::format("a request may take {} ms", ms(*mailbox.request_timeout)), 2);
    if (mailbox.response_timeout) out += indented(fmt::format("an answer may take {} ms", ms(*mailbox.response_timeout)), 2);
    return out;
}

std::string init_commands_text(const std::vector<EsiInitCommand>& commands, Colours colours, std::size_t indent = 2) {
    TextTable table({{"at"}, {"object"}, {"data"}, {"comment", TextTable::Column::Side::left, 44}});
    for (const auto& one : commands)
        table.add({fmt::format("{}", fmt::join(one.transitions, " ")),
                   fmt::format("{:04X}h:{}", one.index, one.complete_access ? "all" : fmt::format("{:02X}", one.sub)), bytes_text(one.data),
                   one.comment});
    return table.text(colours, indent);
}

std::string dc_text(const EsiDevice& device, Colours colours) {
    if (!device.has_dc) return {};
    auto out = heading_text("Distributed clocks", colours);
    if (device.op_modes.empty()) out += indented("it has a clock, and no mode that uses it", 2);
    TextTable table({{"mode", TextTable::Column::Side::left, 20},
                     {"activate"},
                     {"SYNC0", TextTable::Column::Side::left, 24},
                     {"SYNC1", TextTable::Column::Side::left, 24},
                     {"meaning", TextTable::Column::Side::left, 34}});
    for (const auto& mode : device.op_modes)
        table.add(
            {mode.name, fmt::format("{:04X}h", mode.assign_activate), esi_sync_text(mode, 0), esi_sync_text(mode, 1), mode.description});
    return out + table.text(colours, 2);
}

std::string slots_text(const EsiDevice& device, Colours colours) {
    if (!device.slots) return {};
    const auto& slots = *device.slots;
    auto out = heading_text("Slots", colours);
    out += indented(fmt::format("{}; of each the PDOs are {:X}h further, the objects {:X}h",
                                slots.maximum > 0 ? "at most " + count_text(slots.maximum, "slot") : count_text(slots.slots.size(), "slot"),
                                slots.pdo_increment, slots.index_increment),
                    2);
    for (const auto& slot : slots.slots) {
        std::vector<std::string> takes;
        for (const auto ident : slot.idents) takes.push_back(fmt::format("{:X}h", ident));
        for (const auto& one : slot.classes) takes.push_back("class " + one);
        constexpr std::size_t most = 12;
        const auto others = takes.size() > most ? fmt::format(" and {} others", takes.size() - most) : std::string{};
        if (takes.size() > most) takes.resize(most);
        out += indented(fmt::format("{} ({} to {}): {}{}", slot.name.empty() ? "slot" : slot.name, slot.minimum, slot.maximum,
                                    fmt::join(takes, ", "), others),
                        2);
    }
    for (const auto& module : device.modules) {
        out += heading_text(fmt::format("Module {} ({:X}h) {}", module.type, module.ident, module.name), colours);
        out += pdos_text("RxPDO", module.rx, colours) + pdos_text("TxPDO", module.tx, colours);
        if (!module.init_commands.empty()) out += "  init commands\n" + init_commands_text(module.init_commands, colours, 4);
        if (!module.objects.empty()) out += indented(count_text(module.objects.size(), "object") + " in its dictionary", 2);
    }
    return out;
}

std::string objects_text(const EsiDevice& device, Colours colours) {
    if (device.objects.empty()) return {};
    TextTable table({{"object"},
                     {"type", TextTable::Column::Side::left, 16},
                     {"access"},
                     {"default", TextTable::Column::Side::right, 16},
                     {"name", TextTable::Column::Side::left, 52}});
    for (const auto& object : device.objects)
        table.add({fmt::format("{:04X}h:{:02X}", object.index, object.sub), object.type,
                   fmt::format("{} {}", esi_access_name(object.access), esi_mappable_name(object.mappable)),
                   object.value ? std::to_string(*object.value) : object.text, object.name});
    return heading_text(fmt::format("Dictionary ({})", count_text(device.objects.size(), "value")), colours) + table.text(colours, 2);
}

std::string findings_text(const EsiReading& reading, Colours colours) {
    std::string out;
    const auto list = [&](const char* title, const std::vector<Error>& errors) {
        if (errors.empty()) return;
        out += heading_text(title, colours);
        for (const auto& error : errors) out += indented(error.text(), 2);
    };
    list("Wrong in the file: it cannot be used like this", reading.problems);
    list("Wrong in the file", reading.remarks);
    if (!reading.unread.empty()) {
        out += heading_text("In the file, and not read", colours);
        for (const auto& part : reading.unread)
            out += indented(fmt::format("{} ({}, first in line {})", part.path, part.count, part.line), 2);
    }
    return out;
}

}  // namespace

std::string esi_show_text(const std::string& vendor, const EsiReading& reading, Colours colours) {
    const auto& device = reading.device;
    const auto& head = device.heading;
    std::string out = toned(head.type, Tone::strong, colours) + "  " + head.name + "\n";
    if (!head.chinese.empty() && head.chinese != head.name) out += indented(head.chinese, 2);
    out += indented(fmt::format("{}, vendor {:08X}h product {:08X}h revision {:08X}h", vendor, head.identity.vendor, head.identity.product,
                                head.identity.revision),
                    2);
    if (head.hidden) out += indented("hidden: newer ones take its place", 2);
    if (!head.check_revision.empty()) out += indented("revisions are compared by " + head.check_revision, 2);
    if (!head.group.empty()) out += indented("group " + head.group, 2);
    if (!head.url.empty()) out += indented(head.url, 2);
    if (!device.physics.empty()) out += indented(esi_ports_text(device.physics), 2);
    if (!device.profiles.empty()) out += indented(fmt::format("profile {}", fmt::join(device.profiles, ", ")), 2);
    if (device.ebus_current)
        out += indented(fmt::format("E-bus: {} {} mA", *device.ebus_current < 0 ? "supplies" : "takes", std::abs(*device.ebus_current)), 2);
    out += sync_managers_text(device, colours);
    if (!device.rx.empty() || !device.tx.empty())
        out += heading_text("Process data", colours) + pdos_text("RxPDO", device.rx, colours) + pdos_text("TxPDO", device.tx, colours);
    if (device.mailbox) out += mailbox_text(*device.mailbox, colours);
    if (device.mailbox && !device.mailbox->init_commands.empty())
        out += heading_text("Init commands", colours) + init_commands_text(device.mailbox->init_commands, colours);
    out += dc_text(device, colours);
    out += slots_text(device, colours);
    if (device.eeprom)
        out +=
            heading_text("EEPROM", colours) + indented(fmt::format("{} bytes, configuration {}, mailboxes in BOOT {}", device.eeprom->size,
                                                                   bytes_text(device.eeprom->config), bytes_text(device.eeprom->bootstrap)),
                                                       2);
    out += objects_text(device, colours);
    return out + findings_text(reading, colours);
}

void add_esi_show(CLI::App& esi, Action& action) {
    auto* sub = esi.add_subcommand("show", "everything that a file says of one device");
    auto options = add_esi_file(*sub);
    add_esi_device(*sub, *options);
    sub->add_flag("--json", options->json, "the answer as one JSON object");
    sub->callback([&action, options] {
        action = [options] {
            return with_esi_device(*options, [&](const EsiFile& file, const EsiReading& reading) {
                if (options->json)
                    fmt::print("{}\n", esi_show_json(file.vendor_name(), reading).dump(-1, ' ', false, EsiJson::error_handler_t::replace));
                else fmt::print("{}", esi_show_text(file.vendor_name(), reading, colours_of_output()));
                return static_cast<int>(reading.problems.empty() ? exit_ok : exit_bad_file);
            });
        };
    });
}

}  // namespace taktwerk::apps
