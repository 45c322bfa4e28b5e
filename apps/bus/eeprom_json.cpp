// What an EEPROM says, as JSON.

#include "apps/bus/eeprom.hpp"
#include "ecat/eeprom/sii_names.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::apps {

namespace {

Json sii_mailbox_json(const ecat::SiiMailbox& mailbox) { return Json{{"start", mailbox.start}, {"size", mailbox.size}}; }

Json sii_pdos_json(const ecat::Sii& sii, const std::vector<ecat::SiiPdo>& pdos) {
    Json list = Json::array();
    for (const auto& pdo : pdos) {
        Json entries = Json::array();
        for (const auto& entry : pdo.entries)
            entries.push_back(Json{{"index", entry.index},
                                   {"sub", entry.sub},
                                   {"bits", entry.bits},
                                   {"type", entry.data_type},
                                   {"name", sii.string(entry.name)}});
        Json one{{"index", pdo.index}, {"name", sii.string(pdo.name)}, {"flags", pdo.flags}};
        if (pdo.sync_manager != ecat::SiiPdo::not_assigned) one["sync_manager"] = pdo.sync_manager;
        one["entries"] = std::move(entries);
        list.push_back(std::move(one));
    }
    return list;
}

Json sii_general_json(const ecat::Sii& sii, const ecat::SiiGeneral& general) {
    Json json{{"group", sii.string(general.group)},
              {"order", sii.string(general.order)},
              {"name", sii.string(general.name)},
              {"coe", ecat::sii_coe_names(general.coe_details)},
              {"flags", general.flags},
              {"ebus_current_ma", general.ebus_current},
              {"ports", general.physical_ports}};
    if ((general.flags & ecat::sii_flag::id_in_memory) != 0) json["device_id_address"] = general.id_address;
    return json;
}

}  // namespace

Json eeprom_json(std::span<const std::byte> image) {
    const ecat::Sii sii = ecat::parse_sii(image);
    const auto& id = sii.identity;
    Json json{{"bytes", image.size()},
              {"used_bytes", eeprom_used_bytes(image)},
              {"checksum_right", image.size() >= ecat::sii_header_bytes && !sii.has(ecat::SiiDefect::bad_checksum)},
              {"vendor", id.vendor},
              {"product", id.product},
              {"revision", id.revision},
              {"serial", id.serial},
              {"alias", sii.alias},
              {"pdi_control", sii.pdi_control},
              {"pdi_configuration", sii.pdi_configuration},
              {"sync_pulse_ns", 10 * unsigned{sii.sync_pulse_length}},
              {"mailbox_out", sii_mailbox_json(sii.mailbox_out)},
              {"mailbox_in", sii_mailbox_json(sii.mailbox_in)},
              {"boot_mailbox_out", sii_mailbox_json(sii.boot_mailbox_out)},
              {"boot_mailbox_in", sii_mailbox_json(sii.boot_mailbox_in)},
              {"protocols", ecat::sii_protocol_names(sii.mailbox_protocols)}};
    if (sii.general) json["general"] = sii_general_json(sii, *sii.general);
    json["categories"] = Json::array();
    for (const auto& category : ecat::sii_categories(image))
        json["categories"].push_back(Json{
            {"type", category.type}, {"name", ecat::sii_category_name(category.type)}, {"word", category.word}, {"words", category.words}});
    json["sync_managers"] = Json::array();
    for (const auto& sm : sii.sync_managers)
        json["sync_managers"].push_back(
            Json{{"use", name(sm.use)}, {"start", sm.start}, {"length", sm.length}, {"control", sm.control}, {"enable", sm.enable}});
    json["fmmus"] = Json::array();
    for (const auto use : sii.fmmus) json["fmmus"].push_back(name(use));
    json["rx_pdos"] = sii_pdos_json(sii, sii.rx_pdos);
    json["tx_pdos"] = sii_pdos_json(sii, sii.tx_pdos);
    json["clock_modes"] = Json::array();
    for (const auto& mode : sii.dc_modes)
        json["clock_modes"].push_back(Json{{"name", sii.string(mode.name)},
                                           {"assign_activate", mode.assign_activate},
                                           {"sync0_cycle", mode.sync0_cycle},
                                           {"sync0_factor", mode.sync0_factor},
                                           {"sync0_shift", mode.sync0_shift},
                                           {"sync1_factor", mode.sync1_factor},
                                           {"sync1_shift", mode.sync1_shift}});
    json["strings"] = sii.strings;
    json["defects"] = Json::array();
    for (const auto defect : sii.defects) json["defects"].push_back(text(defect));
    return json;
}

}  // namespace taktwerk::apps
