#include "ecat/sim/sii_image.hpp"

#include <algorithm>

#include "ecat/description/coe_type_number.hpp"
#include "ecat/sim/process_data.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::size_t bytes_per_kbit = 128;
constexpr std::uint16_t usual_size_code = 0x000F;  ///< 16 kbit: size in kbit, less 1

/// An EEPROM has a byte for it.
std::uint8_t sii_type(DataType type) noexcept { return static_cast<std::uint8_t>(type_number(type)); }

SiiPdo pdo_of(const DeviceDescription& description, const PdoDescription& pdo, const std::vector<std::uint16_t>& assigned, Sii& sii) {
    constexpr std::uint16_t fixed_content = 1u << 4;
    SiiPdo out;
    out.index = pdo.index;
    out.flags = pdo.fixed ? fixed_content : std::uint16_t{0};
    if (std::find(assigned.begin(), assigned.end(), pdo.index) != assigned.end())
        for (unsigned n = 0; n < description.sync_managers.size(); ++n)
            if (belongs_to(description, pdo, n)) out.sync_manager = static_cast<std::uint8_t>(n);
    for (const auto& entry : pdo.entries) {
        SiiPdoEntry e;
        e.index = entry.index;
        e.sub = entry.sub;
        e.bits = entry.bits;
        e.data_type = entry.index == 0 ? 0
                                       : sii_type(entry.bits == 1    ? DataType::BOOL
                                                  : entry.bits <= 8  ? DataType::U8
                                                  : entry.bits <= 16 ? DataType::U16
                                                                     : DataType::U32);
        for (const auto& object : description.objects)
            if (entry.index != 0 && object.index == entry.index && object.sub == entry.sub) {
                e.data_type = sii_type(object.type);
                e.name = sii.add_string(object.name);
            }
        out.entries.push_back(e);
    }
    return out;
}

/// Of the PDOs that a sync manager carries as the device comes from the factory.
std::uint16_t default_bytes(const DeviceDescription& description, unsigned n) {
    const bool rx = description.sync_managers[n].use == SmUse::outputs;
    const auto& assigned = rx ? description.rx_assigned : description.tx_assigned;
    std::size_t bits = 0;
    for (const auto& pdo : rx ? description.rx_pdos : description.tx_pdos)
        if (std::find(assigned.begin(), assigned.end(), pdo.index) != assigned.end() && belongs_to(description, pdo, n))
            for (const auto& entry : pdo.entries) bits += entry.bits;
    return static_cast<std::uint16_t>((bits + 7) / 8);
}

}  // namespace

std::vector<std::byte> sii_image(const DeviceDescription& description, std::uint16_t alias, std::uint8_t general_flags) {
    Sii sii;
    // PDI 08h: 16-bit microcontroller, 04h: digital I/O; high byte 0Ch: SYNC and latch unit (SV33-E manual 6.2.6.2 reads 0C08h).
    sii.pdi_control = static_cast<std::uint16_t>((description.mailbox ? 0x08 : 0x04) | (description.dc.supported ? 0x0C00 : 0));
    sii.pdi_configuration = description.mailbox ? 0x6608 : 0;
    sii.sync_pulse_length = description.dc.supported ? 0x01F4 : 0;
    sii.alias = alias;
    sii.identity = description.identity;
    sii.size_code = usual_size_code;

    SiiGeneral general;
    general.order = sii.add_string(description.name);
    general.name = sii.add_string(description.device_name.empty() ? description.name : description.device_name);
    general.physical_ports = 0x0011;
    general.ebus_current = description.ebus_current.value_or(0);
    general.flags = general_flags;
    if (description.mailbox && description.mailbox->coe) {
        sii.mailbox_protocols |= sii_protocol::coe;
        general.coe_details = sii_coe::sdo | sii_coe::pdo_assign | sii_coe::pdo_configuration;
        if (description.mailbox->sdo_info) general.coe_details |= sii_coe::sdo_info;
        if (description.mailbox->complete_access) general.coe_details |= sii_coe::complete_access;
    }
    if (description.mailbox && description.mailbox->foe) {
        sii.mailbox_protocols |= sii_protocol::foe;
        general.foe_details = 1;
    }
    if (description.mailbox && description.mailbox->eoe) {
        sii.mailbox_protocols |= sii_protocol::eoe;
        general.eoe_details = 1;
    }
    if (description.mailbox && description.mailbox->bootstrap) {
        const auto& boot = *description.mailbox->bootstrap;
        sii.boot_mailbox_out = {boot.out_start, boot.out_size};
        sii.boot_mailbox_in = {boot.in_start, boot.in_size};
    }
    sii.general = general;

    for (unsigned n = 0; n < description.sync_managers.size(); ++n) {
        const auto& sm = description.sync_managers[n];
        SiiSyncManager out;
        out.start = sm.start;
        out.length = sm.size;
        out.control = sm.control;
        out.use = static_cast<SiiSyncManagerUse>(static_cast<std::uint8_t>(sm.use) + 1);
        if (sm.use == SmUse::mailbox_out) sii.mailbox_out = {sm.start, sm.size};
        if (sm.use == SmUse::mailbox_in) sii.mailbox_in = {sm.start, sm.size};
        if ((sm.use == SmUse::outputs || sm.use == SmUse::inputs) && sm.size == 0) out.length = default_bytes(description, n);
        if (sm.use == SmUse::outputs) sii.fmmus.push_back(SiiFmmuUse::outputs);
        if (sm.use == SmUse::inputs) sii.fmmus.push_back(SiiFmmuUse::inputs);
        sii.sync_managers.push_back(out);
    }
    if (description.mailbox) sii.fmmus.push_back(SiiFmmuUse::mailbox_status);
    for (const auto& pdo : description.rx_pdos) sii.rx_pdos.push_back(pdo_of(description, pdo, description.rx_assigned, sii));
    for (const auto& pdo : description.tx_pdos) sii.tx_pdos.push_back(pdo_of(description, pdo, description.tx_assigned, sii));
    auto image = build_sii(sii);
    // Whoever reads it stops at the size that it states: a memory is as large as what stands in it.
    while ((std::size_t{sii.size_code} + 1) * bytes_per_kbit < image.size()) {
        sii.size_code = static_cast<std::uint16_t>(2 * sii.size_code + 1);
        image = build_sii(sii);
    }
    return image;
}

}  // namespace taktwerk::ecat::sim
