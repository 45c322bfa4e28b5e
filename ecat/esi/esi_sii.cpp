#include "ecat/esi/esi_sii.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "ecat/description/coe_type_number.hpp"
#include "ecat/esi/base_type.hpp"

namespace taktwerk::ecat::esi {

namespace {

constexpr unsigned bytes_per_kbit = 128;
constexpr unsigned usual_eeprom_bytes = 2048;   ///< where the file does not say
constexpr std::size_t most_entries = 255;       ///< of a PDO: their number is a byte
constexpr std::uint32_t most_entry_bits = 255;  ///< of an entry: likewise

/// ETG.2010, category 50: flags of a PDO.
constexpr std::uint16_t pdo_mandatory = 1u << 0, pdo_fixed = 1u << 4, pdo_virtual = 1u << 5, pdo_depends_on_slot = 1u << 9;

/// ETG.1020, base data types; those that our dictionaries do not tell apart come first.
std::uint8_t sii_type_of(const std::string& name) {
    constexpr std::array<std::pair<std::string_view, std::uint8_t>, 17> own{{{"BYTE", 0x1E},
                                                                             {"WORD", 0x1F},
                                                                             {"DWORD", 0x20},
                                                                             {"BITARR8", 0x2D},
                                                                             {"BITARR16", 0x2E},
                                                                             {"BITARR32", 0x2F},
                                                                             {"BIT1", 0x30},
                                                                             {"BIT2", 0x31},
                                                                             {"BIT3", 0x32},
                                                                             {"BIT4", 0x33},
                                                                             {"BIT5", 0x34},
                                                                             {"BIT6", 0x35},
                                                                             {"BIT7", 0x36},
                                                                             {"BIT8", 0x37},
                                                                             {"INT24", 0x10},
                                                                             {"UINT24", 0x16},
                                                                             {"BIT", 0x30}}};
    for (const auto& [word, number] : own)
        if (word == name) return number;
    const auto basic = basic_type(name);
    return basic ? static_cast<std::uint8_t>(type_number(*basic)) : std::uint8_t{0};
}

SiiMailbox mailbox_of(const EsiDevice& device, SmUse use) {
    for (const auto& sm : device.sync_managers)
        if (sm.use == use) return {sm.start, sm.size};
    return {};
}

/// ConfigData: words 0 to 6. BootStrap: words 14h to 17h.
void take_configuration(const EsiDevice& device, Sii& sii, std::vector<std::string>& leftovers) {
    const auto word = [](const std::vector<std::byte>& bytes, std::size_t n) {
        return 2 * n + 2 <= bytes.size() ? load_le<std::uint16_t>(bytes, 2 * n) : std::uint16_t{0};
    };
    if (!device.eeprom || device.eeprom->config.empty())
        leftovers.emplace_back("no ConfigData: words 0 to 6 are 0, and the controller gets no PDI");
    if (!device.eeprom) return;
    const auto& config = device.eeprom->config;
    constexpr std::size_t most_config = 14;
    if (config.size() > most_config)
        leftovers.push_back(fmt::format("ConfigData of {} bytes: the first {} are taken", config.size(), most_config));
    sii.pdi_control = word(config, 0);
    sii.pdi_configuration = word(config, 1);
    sii.sync_pulse_length = word(config, 2);
    sii.pdi_configuration_extended = word(config, 3);
    sii.alias = word(config, 4);
    sii.pdi_configuration_more = {word(config, 5), word(config, 6)};
    const auto& boot = device.eeprom->bootstrap;
    sii.boot_mailbox_out = {word(boot, 0), word(boot, 1)};
    sii.boot_mailbox_in = {word(boot, 2), word(boot, 3)};
    for (const auto& category : device.eeprom->categories) {
        if (is_decoded(category.type) || category.type == sii_category::end || category.type == sii_category::nop)
            leftovers.push_back(fmt::format("category {} by hand: that one is made of what the file says of the device", category.type));
        else sii.others.push_back(category);
    }
}

std::uint16_t protocols_of(const EsiMailbox& mailbox) {
    constexpr std::array<std::pair<std::string_view, std::uint16_t>, 5> others{{{"AoE", sii_protocol::aoe},
                                                                                {"EoE", sii_protocol::eoe},
                                                                                {"FoE", sii_protocol::foe},
                                                                                {"SoE", sii_protocol::soe},
                                                                                {"VoE", sii_protocol::voe}}};
    unsigned bits = mailbox.coe ? sii_protocol::coe : 0u;
    for (const auto& [name, bit] : others)
        if (std::find(mailbox.other_protocols.begin(), mailbox.other_protocols.end(), name) != mailbox.other_protocols.end()) bits |= bit;
    return static_cast<std::uint16_t>(bits);
}

std::uint8_t coe_details_of(const EsiCoe& coe) {
    unsigned bits = sii_coe::sdo;
    if (coe.sdo_info) bits |= sii_coe::sdo_info;
    if (coe.pdo_assign) bits |= sii_coe::pdo_assign;
    if (coe.pdo_config) bits |= sii_coe::pdo_configuration;
    if (coe.pdo_upload) bits |= sii_coe::upload_at_startup;
    if (coe.complete_access) bits |= sii_coe::complete_access;
    return static_cast<std::uint8_t>(bits);
}

/// ETG.2010, category 30, ports: 1 MII, 3 E-bus, 4 fast hot connect; four bits each.
std::uint16_t ports_of(const std::string& physics) {
    unsigned ports = 0;
    for (std::size_t p = 0; p < std::min<std::size_t>(physics.size(), 4); ++p) {
        const unsigned kind = physics[p] == 'Y' ? 1u : physics[p] == 'K' ? 3u : physics[p] == 'H' ? 4u : 0u;
        ports |= kind << (4 * p);
    }
    return static_cast<std::uint16_t>(ports);
}

SiiGeneral general_of(const EsiDevice& device, Sii& sii) {
    SiiGeneral general;
    general.group = sii.add_string(device.heading.group);
    general.order = sii.add_string(device.heading.type);
    general.name = sii.add_string(device.heading.name);
    general.ebus_current = static_cast<std::int16_t>(std::clamp(device.ebus_current.value_or(0), -0x8000, 0x7FFF));
    general.physical_ports = ports_of(device.physics);
    general.id_address = device.id_address.value_or(0);
    unsigned flags = (device.id_in_al_status ? sii_flag::id_in_al_status : 0u) | (device.id_address ? sii_flag::id_in_memory : 0u);
    if (device.mailbox) {
        if (device.mailbox->data_link_layer) flags |= sii_flag::mailbox_data_link_layer;
        if (device.mailbox->coe) general.coe_details = coe_details_of(*device.mailbox->coe);
        const auto speaks = protocols_of(*device.mailbox);
        general.foe_details = (speaks & sii_protocol::foe) != 0 ? 1 : 0;
        general.eoe_details = (speaks & sii_protocol::eoe) != 0 ? 1 : 0;
    }
    general.flags = static_cast<std::uint8_t>(flags);
    return general;
}

SiiSyncManager sync_manager_of(const EsiSyncManager& from) {
    SiiSyncManager to;
    to.start = from.start;
    to.length = from.size;
    to.control = from.control;
    to.enable = static_cast<std::uint8_t>((from.enable ? 1u : 0u) | (from.is_virtual ? 4u : 0u) | (from.op_only ? 8u : 0u));
    to.use = from.use ? static_cast<SiiSyncManagerUse>(static_cast<std::uint8_t>(*from.use) + 1) : SiiSyncManagerUse::unused;
    return to;
}

SiiFmmuUse fmmu_of(const std::string& word) {
    if (word == "Outputs") return SiiFmmuUse::outputs;
    if (word == "Inputs") return SiiFmmuUse::inputs;
    return word == "MBoxState" ? SiiFmmuUse::mailbox_status : SiiFmmuUse::unused;
}

SiiPdo pdo_of(const EsiPdo& from, Sii& sii, std::vector<std::string>& leftovers) {
    SiiPdo to;
    to.index = from.index;
    to.sync_manager = from.sync_manager.value_or(SiiPdo::not_assigned);
    to.name = sii.add_string(from.name);
    to.flags = static_cast<std::uint16_t>((from.mandatory ? pdo_mandatory : 0u) | (from.fixed ? pdo_fixed : 0u) |
                                          (from.is_virtual ? pdo_virtual : 0u) | (from.depends_on_slot ? pdo_depends_on_slot : 0u));
    for (const auto& entry : from.entries) {
        auto left = entry.bits;
        if (left > most_entry_bits && entry.index != 0)
            leftovers.push_back(fmt::format("{:04X}h in PDO {:04X}h has {} bits: an EEPROM says at most {}", entry.index, from.index, left,
                                            most_entry_bits));
        // A gap may be said in several parts.
        do {
            SiiPdoEntry one;
            one.index = entry.index;
            one.sub = entry.sub;
            one.bits = static_cast<std::uint8_t>(std::min(left, most_entry_bits));
            one.data_type = entry.index == 0 ? std::uint8_t{0} : sii_type_of(entry.type);
            one.name = sii.add_string(entry.name);
            to.entries.push_back(one);
            left -= one.bits;
        } while (left > 0 && entry.index == 0);
    }
    if (to.entries.size() > most_entries) {
        leftovers.push_back(
            fmt::format("PDO {:04X}h has {} entries: an EEPROM says at most {}", from.index, to.entries.size(), most_entries));
        to.entries.resize(most_entries);
    }
    return to;
}

SiiDcMode clock_of(const EsiOpMode& from, Sii& sii) {
    SiiDcMode to;
    to.sync0_cycle = static_cast<std::uint32_t>(std::max<std::int64_t>(from.sync0_cycle.count(), 0));
    to.sync0_shift = static_cast<std::int32_t>(from.sync0_shift.count());
    to.sync1_shift = static_cast<std::int32_t>(from.sync1_shift.count());
    to.sync0_factor = static_cast<std::int16_t>(std::clamp<std::int64_t>(from.sync0_factor, -0x8000, 0x7FFF));
    to.sync1_factor = static_cast<std::int16_t>(std::clamp<std::int64_t>(from.sync1_factor, -0x8000, 0x7FFF));
    to.assign_activate = from.assign_activate;
    to.name = sii.add_string(from.name);
    to.description = sii.add_string(from.description);
    return to;
}

}  // namespace

Sii sii_of(const EsiDevice& device, std::vector<std::string>& leftovers) {
    Sii sii;
    sii.identity = device.heading.identity;
    const unsigned bytes = device.eeprom && device.eeprom->size >= bytes_per_kbit ? device.eeprom->size : usual_eeprom_bytes;
    sii.size_code = static_cast<std::uint16_t>(std::min(bytes / bytes_per_kbit - 1, 0xFFFFu));
    take_configuration(device, sii, leftovers);
    sii.mailbox_out = mailbox_of(device, SmUse::mailbox_out);
    sii.mailbox_in = mailbox_of(device, SmUse::mailbox_in);
    if (device.mailbox) sii.mailbox_protocols = protocols_of(*device.mailbox);
    sii.general = general_of(device, sii);
    for (const auto& use : device.fmmus) sii.fmmus.push_back(fmmu_of(use));
    for (const auto& sm : device.sync_managers) sii.sync_managers.push_back(sync_manager_of(sm));
    for (const auto& pdo : device.tx) sii.tx_pdos.push_back(pdo_of(pdo, sii, leftovers));
    for (const auto& pdo : device.rx) sii.rx_pdos.push_back(pdo_of(pdo, sii, leftovers));
    for (const auto& mode : device.op_modes) sii.dc_modes.push_back(clock_of(mode, sii));
    return sii;
}

EsiImage esi_image(const EsiDevice& device) {
    EsiImage out;
    if (device.eeprom && device.eeprom->data.size() >= sii_header_bytes) {
        out.bytes = device.eeprom->data;
        return out;
    }
    const Sii sii = sii_of(device, out.leftovers);
    out.bytes = build_sii(sii);
    const auto stated = (std::size_t{sii.size_code} + 1) * bytes_per_kbit;
    if (out.bytes.size() > stated) {
        if (out.bytes.size() % 2 != 0) out.bytes.push_back(std::byte{0xFF});
        out.leftovers.push_back(
            fmt::format("it has {} bytes, and the device's EEPROM {}: names or PDOs have to go", out.bytes.size(), stated));
    }
    if (!device.modules.empty()) out.leftovers.push_back(fmt::format("{} modules: no EEPROM holds them", device.modules.size()));
    return out;
}

}  // namespace taktwerk::ecat::esi
