#include "config/device_file/device_file_text.hpp"

#include <array>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::config {

namespace {

const char* type_word(ecat::DataType type) {
    static constexpr std::array<const char*, 12> words{"BOOL", "I8",  "I16", "I32",    "I64",    "U8",
                                                       "U16",  "U32", "U64", "REAL32", "REAL64", "STRING"};
    return words.at(static_cast<std::size_t>(type));
}

const char* use_word(ecat::SmUse use) {
    static constexpr std::array<const char*, 4> words{"mailbox_out", "mailbox_in", "outputs", "inputs"};
    return words.at(static_cast<std::size_t>(use));
}

const char* rule_word(ecat::RevisionRule rule) {
    static constexpr std::array<const char*, 3> words{"any", "at_least", "exact"};
    return words.at(static_cast<std::size_t>(rule));
}

const char* access_word(ecat::Access access) {
    static constexpr std::array<const char*, 3> words{"ro", "rw", "wo"};
    return words.at(static_cast<std::size_t>(access));
}

const char* map_word(ecat::Mappable mappable) {
    static constexpr std::array<const char*, 4> words{"no", "rx", "tx", "both"};
    return words.at(static_cast<std::size_t>(mappable));
}

const char* flag(bool on) { return on ? "true" : "false"; }

std::string address(std::uint16_t index, std::uint8_t sub) { return fmt::format("{:04X}h:{:02X}", index, sub); }

std::string pdo_line(const ecat::PdoDescription& pdo, const char* assigned) {
    std::vector<std::string> objects;
    for (const auto& entry : pdo.entries)
        objects.push_back(entry.index == 0 ? fmt::format("gap/{}", entry.bits)
                                           : fmt::format("{}/{}", address(entry.index, entry.sub), entry.bits));
    std::string line = fmt::format("{{ pdo: {:04X}h", pdo.index);
    if (pdo.fixed) line += ", fixed: true";
    if (pdo.sync_manager) line += fmt::format(", sync_manager: {}", *pdo.sync_manager);
    return line + assigned + fmt::format(", objects: [{}] }}\n", fmt::join(objects, ", "));
}

std::string pdo_section(const DeviceFile& file) {
    if (file.rx.empty() && file.tx.empty()) return {};
    std::string out = "pdo:\n";
    const auto add = [&](const char* key, const std::vector<DevicePdo>& pdos) {
        if (pdos.empty()) return;
        out += fmt::format("  {}:\n", key);
        for (const auto& one : pdos) out += "    - " + pdo_line(one.pdo, one.assigned ? "" : ", assigned: false");
    };
    add("rx", file.rx);
    add("tx", file.tx);
    return out;
}

std::string slots_section(const ecat::SlotDescription& slots) {
    if (slots.count == 0) return {};
    auto out = fmt::format("slots:\n  count: {}\n  index_increment: 0x{:X}\n  pdo_increment: 0x{:X}\n  modules:", slots.count,
                           slots.index_increment, slots.pdo_increment);
    if (slots.may_be_empty) out.insert(out.find("  modules:"), "  may_be_empty: true\n");
    if (slots.modules.empty()) return out + " {}\n";
    out += "\n";
    for (const auto& module : slots.modules) {
        const bool plain = module.ident == 0 && module.rx_pdos.empty() && module.tx_pdos.empty();
        out += fmt::format("    {}:{}\n", quoted_yaml(module.name), plain ? " {}" : "");
        if (module.ident != 0) out += fmt::format("      ident: 0x{:08X}\n", module.ident);
        const auto add = [&](const char* key, const std::vector<ecat::PdoDescription>& pdos) {
            if (pdos.empty()) return;
            out += fmt::format("      {}:\n", key);
            for (const auto& pdo : pdos) out += "        - " + pdo_line(pdo, "");
        };
        add("rx", module.rx_pdos);
        add("tx", module.tx_pdos);
    }
    return out;
}

std::string object_line(const ObjectRow& row) {
    const auto& object = row.object;
    auto line = fmt::format("  - {{ object: {}, name: {}, type: {}, access: {}", address(object.index, object.sub),
                            quoted_yaml(object.name), type_word(object.type), access_word(object.access));
    if (object.mappable != ecat::Mappable::no) line += fmt::format(", map: {}", map_word(object.mappable));
    if (row.has_value) line += fmt::format(", value: {}", object.value);
    if (object.minimum) line += fmt::format(", minimum: {}", *object.minimum);
    if (object.maximum) line += fmt::format(", maximum: {}", *object.maximum);
    if (!object.text.empty()) line += ", text: " + quoted_yaml(object.text);
    if (!row.parameter.unit.empty()) line += ", unit: " + quoted_yaml(row.parameter.unit);
    if (!row.parameter.meaning.empty()) line += ", meaning: " + quoted_yaml(row.parameter.meaning);
    return line + " }\n";
}

std::string startup_line(const StartupEntry& entry) {
    auto line = fmt::format("  - {{ at: {}, object: {}", entry.at == ecat::Transition::SafeopToOp ? "safeop" : "preop",
                            address(entry.object.index, entry.object.sub));
    if (entry.type) line += fmt::format(", type: {}", type_word(*entry.type));
    line += fmt::format(", value: {}", entry.value);
    if (!entry.comment.empty()) line += ", comment: " + quoted_yaml(entry.comment);
    return line + " }\n";
}

std::string channel_line(const ChannelRow& row) {
    const auto& place = row.output ? *row.output : *row.input;
    auto line = fmt::format("  {}: {{ {}: {}", row.name, row.output ? "output" : "input", address(place.index, place.sub));
    if (row.type) line += fmt::format(", type: {}", type_word(*row.type));
    if (!row.doc.empty()) line += ", doc: " + quoted_yaml(row.doc);
    return line + " }\n";
}

std::string controller_section(const ecat::DeviceDescription& device) {
    const ecat::DeviceDescription usual;
    const auto& id = device.identity;
    auto out = fmt::format("identity: {{ device_name: {}, vendor: 0x{:08X}, product: 0x{:08X}, revision: 0x{:08X}, revision_rule: {} }}\n",
                           quoted_yaml(device.device_name), id.vendor, id.product, id.revision, rule_word(device.revision_rule));
    if (device.ebus_current) out += fmt::format("ebus: {} mA\n", *device.ebus_current);
    if (device.mailbox)
        out += fmt::format("mailbox: {{ coe: {}, complete_access: {}, sdo_info: {} }}\n", flag(device.mailbox->coe),
                           flag(device.mailbox->complete_access), flag(device.mailbox->sdo_info));
    if (!device.sync_managers.empty()) out += "sync_managers:\n";
    for (const auto& sm : device.sync_managers) {
        out += fmt::format("  - {{ use: {}, start: 0x{:04X}", use_word(sm.use), sm.start);
        if (sm.size > 0) out += fmt::format(", size: {}", sm.size);
        out += fmt::format(", control: 0x{:02X} }}\n", sm.control);
    }
    if (device.fmmus != usual.fmmus) out += fmt::format("fmmus: {}\n", device.fmmus);
    if (device.sync_manager_count != usual.sync_manager_count) out += fmt::format("sync_manager_count: {}\n", device.sync_manager_count);
    if (device.dc.supported) out += fmt::format("dc: {{ supported: true, required: {} }}\n", flag(device.dc.required));
    return out;
}

}  // namespace

std::string quoted_yaml(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        const auto byte = static_cast<unsigned char>(c);
        if (byte == '\t' || byte == '\n' || byte == '\r') out += ' ';
        else if (byte >= 0x20 && byte != 0x7F) out += c;
    }
    return out + '"';
}

std::string device_file_text(const DeviceFile& file, const std::string& heading) {
    std::string out;
    for (std::size_t at = 0; at < heading.size();) {
        const auto end = std::min(heading.find('\n', at), heading.size());
        out += "# " + heading.substr(at, end - at) + "\n";
        at = end + 1;
    }
    out += fmt::format("version: 1\nname: {}\nvendor: {}\ntitle: {}\nsource: {}\nchecked: {}\n", file.name, quoted_yaml(file.vendor),
                       quoted_yaml(file.title), quoted_yaml(file.source), file.checked);
    out += controller_section(file.device) + pdo_section(file) + slots_section(file.device.slots);
    if (!file.objects.empty()) out += "objects:\n";
    for (const auto& row : file.objects) out += object_line(row);
    if (!file.startup.empty()) out += "startup:\n";
    for (const auto& entry : file.startup) out += startup_line(entry);
    if (!file.channels.empty()) out += "channels:\n";
    for (const auto& row : file.channels) out += channel_line(row);
    return out;
}

}  // namespace taktwerk::config
