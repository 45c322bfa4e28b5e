#include "ecat/diagnosis/derived_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ecat/diagnosis/object_value.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t fixed_content = 1u << 4;  // SiiPdo::flags

DataType data_type(std::uint8_t coe, std::uint8_t bits) noexcept {
    constexpr std::array all{DataType::BOOL, DataType::I8,  DataType::I16, DataType::I32,    DataType::I64,   DataType::U8,
                             DataType::U16,  DataType::U32, DataType::U64, DataType::REAL32, DataType::REAL64};
    for (const DataType type : all)
        if (type_number(type) == coe) return type;
    return bits == 1 ? DataType::BOOL : bits <= 8 ? DataType::U8 : bits <= 16 ? DataType::U16 : bits <= 32 ? DataType::U32 : DataType::U64;
}

void add_pdos(const Sii& sii, const std::vector<SiiPdo>& from, std::vector<PdoDescription>& pdos, std::vector<std::uint16_t>& assigned,
              std::vector<ObjectEntry>& objects) {
    for (const auto& pdo : from) {
        PdoDescription description;
        description.index = pdo.index;
        description.fixed = (pdo.flags & fixed_content) != 0;
        if (pdo.sync_manager != SiiPdo::not_assigned) {
            description.sync_manager = pdo.sync_manager;
            assigned.push_back(pdo.index);
        }
        for (const auto& entry : pdo.entries) {
            description.entries.push_back({entry.index, entry.sub, entry.bits});
            if (entry.index == 0) continue;
            ObjectEntry object;
            object.index = entry.index;
            object.sub = entry.sub;
            object.name = std::string{sii.string(entry.name)};
            object.type = data_type(entry.data_type, entry.bits);
            objects.push_back(std::move(object));
        }
        pdos.push_back(std::move(description));
    }
}

SmUse use_of(const SiiSyncManager& sm) noexcept {
    switch (sm.use) {
        case SiiSyncManagerUse::mailbox_out: return SmUse::mailbox_out;
        case SiiSyncManagerUse::mailbox_in: return SmUse::mailbox_in;
        case SiiSyncManagerUse::outputs: return SmUse::outputs;
        case SiiSyncManagerUse::inputs:
        case SiiSyncManagerUse::unused: break;
    }
    return SmUse::inputs;
}

}  // namespace

DeviceDescription describe(const SurveyedSlave& slave) {
    const auto& sii = slave.found.sii;
    DeviceDescription device;
    device.name = !slave.order_name.empty() ? slave.order_name : !slave.device_name.empty() ? slave.device_name : "unknown device";
    device.device_name = slave.device_name;
    device.identity = slave.found.identity;
    // An EEPROM without the word about protocols, but with a mailbox: nearly every mailbox speaks CoE.
    const bool coe = slave.has_mailbox() && (sii.mailbox_protocols == 0 || (sii.mailbox_protocols & sii_protocol::coe) != 0);
    if (slave.has_mailbox()) {
        MailboxDescription mailbox;
        mailbox.coe = coe;
        if (sii.general) {
            mailbox.complete_access = (sii.general->coe_details & sii_coe::complete_access) != 0;
            mailbox.sdo_info = (sii.general->coe_details & sii_coe::sdo_info) != 0;
        }
        device.mailbox = mailbox;
    }
    for (const auto& sm : sii.sync_managers) {
        if (sm.use == SiiSyncManagerUse::unused) continue;
        const SmUse use = use_of(sm);
        const bool process_data = use == SmUse::outputs || use == SmUse::inputs;
        device.sync_managers.push_back({use, sm.start, process_data && coe ? std::uint16_t{0} : sm.length, sm.control});
    }
    if (device.sync_managers.empty() && slave.has_mailbox())
        device.sync_managers = {{SmUse::mailbox_out, slave.found.mailbox[0], slave.found.mailbox[1], SyncManager::usual_mailbox_out},
                                {SmUse::mailbox_in, slave.found.mailbox[2], slave.found.mailbox[3], SyncManager::usual_mailbox_in}};
    add_pdos(sii, sii.rx_pdos, device.rx_pdos, device.rx_assigned, device.objects);
    add_pdos(sii, sii.tx_pdos, device.tx_pdos, device.tx_assigned, device.objects);
    device.dc.supported = slave.dc();
    device.dc.clock_64bit = (slave.found.features & feature::dc_64bit) != 0;
    device.fmmus = slave.found.fmmus;
    device.sync_manager_count = slave.found.sync_managers;
    return device;
}

BusConfig derived_config(const Survey& survey, const BusConfig& machine) {
    BusConfig config;
    config.interface = machine.interface;
    config.cycle = machine.cycle;
    config.sync0_shift = machine.sync0_shift;
    for (const auto& slave : survey.slaves) {
        if (slave.found.error) continue;
        SlaveConfig entry;
        const auto named = std::find_if(machine.slaves.begin(), machine.slaves.end(),
                                        [&](const SlaveConfig& wanted) { return !slave.name.empty() && wanted.name == slave.name; });
        entry.name = slave.name.empty() ? fmt::format("slave{}", slave.found.position) : slave.name;
        if (named != machine.slaves.end() && !slave.mismatch) entry.device = named->device;
        else entry.device = std::make_shared<const DeviceDescription>(describe(slave));
        entry.position = slave.found.position;
        config.slaves.push_back(std::move(entry));
    }
    config.extra_slaves = ExtraSlaves::ignore;
    return config;
}

void adopt(Bus& bus, const Survey& survey) {
    bus.slaves.clear();
    bus.found.clear();
    for (const auto& slave : survey.slaves) bus.found.push_back(slave.found);
    if (survey.topology) bus.topology = *survey.topology;
    for (const auto& config : bus.config.slaves) {
        const auto& surveyed = survey.slaves.at(*config.position);
        auto slave = std::make_unique<BusSlave>();
        slave->config = &config;
        slave->index = bus.slaves.size();
        slave->found = surveyed.found;
        slave->subject = fmt::format("{} ({})", survey.subject(*config.position), config.device->name);
        slave->dc = surveyed.dc();
        bus.slaves.push_back(std::move(slave));
    }
}

}  // namespace taktwerk::ecat
