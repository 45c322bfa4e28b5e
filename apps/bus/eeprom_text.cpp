// What an EEPROM says, as text.

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/count_text.hpp"
#include "core/bytes.hpp"
#include "ecat/eeprom/sii_names.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Sii;
using Align = TextTable::Column::Side;

std::string checksum_text(std::span<const std::byte> image, const Sii& sii) {
    if (image.size() < ecat::sii_header_bytes) return "no checksum";
    if (!sii.has(ecat::SiiDefect::bad_checksum)) return "checksum right";
    return fmt::format("checksum wrong: word 0007h is {:04X}h, words 0 to 6 give {:02X}h",
                       load_le<std::uint16_t>(image, 2 * ecat::sii_word::checksum), ecat::sii_checksum(image));
}

std::string mailboxes_text(const ecat::SiiMailbox& out, const ecat::SiiMailbox& in) {
    if (out.size == 0 && in.size == 0) return "none";
    return fmt::format("out {} bytes at {:04X}h, in {} bytes at {:04X}h", out.size, out.start, in.size, in.start);
}

std::string device_id_text(const ecat::SiiGeneral& general) {
    std::string text;
    if ((general.flags & ecat::sii_flag::id_in_al_status) != 0) text = "through AL status (0134h)";
    if ((general.flags & ecat::sii_flag::id_in_memory) != 0)
        text += fmt::format("{}at {:04X}h", text.empty() ? "" : ", and ", general.id_address);
    return text.empty() ? "none" : text;
}

/// Rows of "name  value".
class FactLines {
public:
    explicit FactLines(Colours colours) : colours_(colours) {}
    void add(const char* name, std::string value, Tone tone = Tone::plain) { table_.add({name, Cell{std::move(value), tone}}); }
    [[nodiscard]] std::string text() const {
        const auto all = table_.text(colours_, 2);
        return all.substr(all.find('\n') + 1);  // without the heads, which say nothing
    }

private:
    Colours colours_;
    TextTable table_{{{"fact"}, {""}}};
};

std::string facts_text(const Sii& sii, Colours colours) {
    FactLines facts{colours};
    const auto& id = sii.identity;
    facts.add("identity",
              fmt::format("vendor {:08X}h product {:08X}h revision {:08X}h serial {}", id.vendor, id.product, id.revision, id.serial));
    facts.add("alias", sii.alias != 0 ? std::to_string(sii.alias) : "none");
    if (sii.general) {
        const auto& general = *sii.general;
        facts.add("order", fmt::format("'{}'", sii.string(general.order)));
        facts.add("name", fmt::format("'{}'", sii.string(general.name)));
        if (general.group != 0) facts.add("group", fmt::format("'{}'", sii.string(general.group)));
        facts.add("device id", device_id_text(general));
    }
    const auto& more = sii.pdi_configuration_more;
    facts.add("PDI", fmt::format("control {:04X}h, configuration {:04X}h {:04X}h{}", sii.pdi_control, sii.pdi_configuration,
                                 sii.pdi_configuration_extended,
                                 more[0] != 0 || more[1] != 0 ? fmt::format(" {:04X}h {:04X}h", more[0], more[1]) : std::string{}));
    facts.add("SYNC pulse", fmt::format("{} ns", 10 * unsigned{sii.sync_pulse_length}));
    facts.add("mailboxes", mailboxes_text(sii.mailbox_out, sii.mailbox_in));
    if (sii.mailbox_protocols != 0)
        facts.add("protocols", fmt::format("{}", fmt::join(ecat::sii_protocol_names(sii.mailbox_protocols), ", ")));
    facts.add("in BOOT", mailboxes_text(sii.boot_mailbox_out, sii.boot_mailbox_in));
    if (sii.general) {
        const auto& general = *sii.general;
        if (general.coe_details != 0) facts.add("CoE", fmt::format("{}", fmt::join(ecat::sii_coe_names(general.coe_details), ", ")));
        if ((general.flags & ecat::sii_flag::no_lrw) != 0) facts.add("LRW", "not supported");
        if (general.ebus_current != 0)
            facts.add("E-bus", fmt::format("{} {} mA", general.ebus_current < 0 ? "supplies" : "takes", std::abs(general.ebus_current)));
        if (general.physical_ports != 0) facts.add("ports", ecat::sii_ports_text(general.physical_ports));
    }
    std::vector<std::string> fmmus;
    for (const auto use : sii.fmmus) fmmus.emplace_back(name(use));
    if (!fmmus.empty()) facts.add("FMMUs", fmt::format("{}", fmt::join(fmmus, ", ")));
    for (const auto defect : sii.defects) facts.add("wrong", std::string{text(defect)}, Tone::bad);
    return facts.text();
}

std::string titled(const char* title, const TextTable& table, Colours colours) {
    return table.empty() ? std::string{} : "\n" + toned(title, Tone::strong, colours) + "\n" + table.text(colours, 2);
}

std::string categories_table(std::span<const std::byte> image, Colours colours) {
    TextTable table{{{"at"}, {"words", Align::right}, {"type", Align::right}, {"category"}}};
    for (const auto& category : ecat::sii_categories(image))
        if (category.type != ecat::sii_category::nop)
            table.add({fmt::format("{:04X}h", category.word), std::to_string(category.words), std::to_string(category.type),
                       ecat::sii_category_name(category.type)});
    return titled("Categories", table, colours);
}

std::string sync_managers_table(const Sii& sii, Colours colours) {
    TextTable table{{{"SM"}, {"use"}, {"start"}, {"bytes", Align::right}, {"control"}, {"enable"}}};
    for (std::size_t n = 0; n < sii.sync_managers.size(); ++n) {
        const auto& sm = sii.sync_managers[n];
        table.add({std::to_string(n), std::string{name(sm.use)}, fmt::format("{:04X}h", sm.start), std::to_string(sm.length),
                   fmt::format("{:02X}h", sm.control), fmt::format("{:02X}h", sm.enable)});
    }
    return titled("Sync managers", table, colours);
}

std::string pdos_table(const Sii& sii, Colours colours) {
    TextTable table{{{"PDO"}, {"in"}, {"bits", Align::right}, {"object"}, {"name", Align::left, 40}}};
    const auto add = [&](const std::vector<ecat::SiiPdo>& pdos, const char* direction) {
        for (const auto& pdo : pdos) {
            table.add({Cell{fmt::format("{} {:04X}h", direction, pdo.index), Tone::strong},
                       pdo.sync_manager == ecat::SiiPdo::not_assigned ? std::string{"-"} : fmt::format("SM{}", pdo.sync_manager),
                       std::to_string(pdo.bits()), "", std::string{sii.string(pdo.name)}});
            for (const auto& entry : pdo.entries)
                table.add({"", "", std::to_string(entry.bits),
                           entry.index == 0 ? std::string{"gap"} : fmt::format("{:04X}h:{:02X}", entry.index, entry.sub),
                           std::string{sii.string(entry.name)}});
        }
    };
    add(sii.rx_pdos, "Rx");
    add(sii.tx_pdos, "Tx");
    return titled("Process data", table, colours);
}

std::string clocks_table(const Sii& sii, Colours colours) {
    TextTable table{{{"activation"},
                     {"SYNC0 cycle ns", Align::right},
                     {"factor", Align::right},
                     {"shift ns", Align::right},
                     {"SYNC1 factor", Align::right},
                     {"shift ns", Align::right},
                     {"name", Align::left, 24}}};
    for (const auto& mode : sii.dc_modes)
        table.add({fmt::format("{:04X}h", mode.assign_activate), std::to_string(mode.sync0_cycle), std::to_string(mode.sync0_factor),
                   std::to_string(mode.sync0_shift), std::to_string(mode.sync1_factor), std::to_string(mode.sync1_shift),
                   std::string{sii.string(mode.name)}});
    return titled("Clock modes", table, colours);
}

std::string strings_table(const Sii& sii, Colours colours) {
    TextTable table{{{"", Align::right}, {"text", Align::left, 60}}};
    for (std::size_t n = 0; n < sii.strings.size(); ++n) table.add({std::to_string(n + 1), sii.strings[n]});
    return titled("Strings", table, colours);
}

}  // namespace

std::size_t eeprom_used_bytes(std::span<const std::byte> image) {
    std::size_t end = ecat::sii_word::categories;
    for (const auto& category : ecat::sii_categories(image)) end = category.word + category.words;
    return std::min(2 * (end + 1), image.size());
}

std::string eeprom_text(const std::string& where, std::span<const std::byte> image, Colours colours) {
    const Sii sii = ecat::parse_sii(image);
    std::string out = toned(where, Tone::strong, colours) + fmt::format(": EEPROM of {} bytes, {} of them used, {}\n", image.size(),
                                                                        eeprom_used_bytes(image), checksum_text(image, sii));
    if (sii.has(ecat::SiiDefect::empty)) return out + "  it is empty\n";
    return out + facts_text(sii, colours) + categories_table(image, colours) + sync_managers_table(sii, colours) +
           pdos_table(sii, colours) + clocks_table(sii, colours) + strings_table(sii, colours);
}

}  // namespace taktwerk::apps
