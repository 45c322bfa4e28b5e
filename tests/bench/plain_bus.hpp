#pragma once
// Buses for benchmarks: terminals of 16 bytes of inputs and 16 of outputs.

#include <memory>
#include <string>

#include <fmt/format.h>

#include "ecat/bus_config.hpp"
#include "ecat/sim/digital_terminal.hpp"
#include "ecat/sim/sim_network.hpp"

namespace taktwerk::bench {

/// `unit`: the sync unit of all of them; empty: each its own.
inline ecat::BusConfig terminals(std::size_t count, const std::string& unit = {}) {
    ecat::BusConfig config;
    config.cycle = std::chrono::milliseconds{1};
    const auto device = std::make_shared<const ecat::DeviceDescription>(ecat::sim::digital_input_output_terminal(128, 128));
    for (std::size_t i = 0; i < count; ++i) {
        ecat::SlaveConfig slave;
        slave.name = fmt::format("t{}", i);
        slave.device = device;
        slave.position = static_cast<std::uint16_t>(i);
        slave.sync_unit = unit;
        slave.sm_watchdog = std::chrono::milliseconds{500};  // a stall of the benchmark's host is no finding
        config.slaves.push_back(slave);
    }
    return config;
}

inline void plug_in(ecat::sim::SimNetwork& network, const ecat::BusConfig& config) {
    for (const auto& slave : config.slaves) network.add(slave.device, std::make_unique<ecat::sim::DigitalTerminal>());
}

}  // namespace taktwerk::bench
