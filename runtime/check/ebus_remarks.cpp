#include "runtime/check/ebus_remarks.hpp"

#include <optional>

#include <fmt/format.h>

namespace taktwerk::runtime {

std::vector<Error> ebus_remarks(const MachineConfig& config) {
    std::vector<Error> out;
    std::string feeder;
    std::optional<int> supplied;
    int used = 0, unknown = 0;
    bool told = false;
    for (std::size_t i = 0; i < config.bus.slaves.size(); ++i) {
        const auto& slave = config.bus.slaves[i];
        if (!slave.device) continue;
        const auto current = slave.device->ebus_current;
        if (current && *current < 0) {
            feeder = slave.name, supplied = -*current;
            used = unknown = 0;
            told = false;
            continue;
        }
        unknown += current ? 0 : 1;
        used += current.value_or(0);
        if (!supplied || used <= *supplied || told) continue;
        told = true;
        out.push_back(
            {"remark.ebus", fmt::format("bus.slaves.{}", i),
             fmt::format("up to '{}' the terminals behind '{}' take {} mA from the E-bus{}, and it supplies {} mA", slave.name, feeder,
                         used, unknown > 0 ? fmt::format(" (and {} whose current is not known)", unknown) : std::string{}, *supplied),
             "put a feed terminal before it, such as EL9410, or a coupler of its own"});
    }
    return out;
}

}  // namespace taktwerk::runtime
