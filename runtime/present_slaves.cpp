#include "runtime/present_slaves.hpp"

namespace taktwerk::runtime {

std::vector<ecat::SlaveConfig> present_slaves(const MachineConfig& config) {
    const auto is_absent = [&](const ecat::SlaveConfig& slave) {
        bool bound = false, all_simulated = true;
        for (const auto& binding : config.axes) {
            if (binding.slave != slave.name && binding.follower.slave != slave.name) continue;
            bound = true;
            all_simulated = all_simulated && binding.axis.simulated;
        }
        return bound && all_simulated;
    };
    std::vector<ecat::SlaveConfig> present;
    for (auto slave : config.bus.slaves) {
        if (is_absent(slave)) continue;
        if (slave.position) {
            std::uint16_t before = 0;
            for (const auto& other : config.bus.slaves) before += is_absent(other) && other.position && *other.position < *slave.position;
            *slave.position = static_cast<std::uint16_t>(*slave.position - before);
        }
        present.push_back(std::move(slave));
    }
    return present;
}

}  // namespace taktwerk::runtime
