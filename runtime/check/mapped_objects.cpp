#include "runtime/check/mapped_objects.hpp"

#include "ecat/description/module_pdos.hpp"

namespace taktwerk::runtime {

std::vector<ecat::PdoEntry> mapped(const ecat::PdoSelection& selection, const std::vector<ecat::PdoDescription>& known,
                                   const std::vector<std::uint16_t>& assigned) {
    std::vector<ecat::PdoEntry> out;
    const auto add = [&](const std::vector<ecat::PdoEntry>& entries) { out.insert(out.end(), entries.begin(), entries.end()); };
    const auto add_known = [&](std::uint16_t index) {
        for (const auto& pdo : known)
            if (pdo.index == index) add(pdo.entries);
    };
    for (const auto& pdo : selection.assigned) {
        if (pdo.entries.empty()) add_known(pdo.index);
        else add(pdo.entries);
    }
    if (selection.assigned.empty())
        for (const auto index : assigned) add_known(index);
    return out;
}

unsigned bits_of_point(const MachineConfig& config, std::string_view name, IoDirection direction) {
    for (const auto& point : config.io) {
        if (point.name != name || point.direction != direction) continue;
        for (const auto& slave : config.bus.slaves) {
            if (slave.name != point.slave || !slave.device) continue;
            const auto offered = ecat::pdos_of(*slave.device, slave.modules);
            const auto entries = direction == IoDirection::input ? mapped(slave.tx, offered.tx, offered.tx_assigned)
                                                                 : mapped(slave.rx, offered.rx, offered.rx_assigned);
            for (const auto& entry : entries)
                if (entry.index == point.index && entry.sub == point.sub) return entry.bits;
        }
    }
    return 0;
}

Duration exchange_period_of(const MachineConfig& config, std::string_view name) {
    auto bus = config.bus;
    bus.cycle = config.cycle;
    for (const auto& slave : bus.slaves)
        if (slave.name == name) return ecat::exchange_period(bus, slave);
    return config.cycle;
}

}  // namespace taktwerk::runtime
