#include "ecat/bringup/known_pdos.hpp"

#include "ecat/description/module_pdos.hpp"

namespace taktwerk::ecat {

namespace {

std::vector<PdoDescription> effective(const PdoSelection& selection, const std::vector<PdoDescription>& known,
                                      const std::vector<std::uint16_t>& assigned) {
    std::vector<PdoDescription> result;
    const auto append = [&](std::uint16_t index) {
        for (const auto& pdo : known)
            if (pdo.index == index) result.push_back(pdo);
    };
    for (const auto& pdo : selection.assigned) {
        if (pdo.entries.empty()) append(pdo.index);
        else result.push_back(pdo);
    }
    if (selection.assigned.empty())
        for (const auto index : assigned) append(index);
    return result;
}

}  // namespace

KnownPdos known_pdos(const SlaveConfig& slave) {
    const auto offered = pdos_of(*slave.device, slave.modules);
    return {effective(slave.rx, offered.rx, offered.rx_assigned), effective(slave.tx, offered.tx, offered.tx_assigned)};
}

}  // namespace taktwerk::ecat
