#pragma once
// Relaxed supervision, for networks and hosts without real time: one factor for the machine, the world that it runs against, and the remarks.

#include <cstdint>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// How much wider the limits of missed exchanges are.
inline constexpr std::uint32_t relaxed_factor = 100;

/// A limit that counts missed cycles, as this machine's supervision takes it.
[[nodiscard]] inline std::uint32_t supervised_limit(const MachineConfig& config, std::uint32_t strict) noexcept {
    return config.simulation.supervision == Supervision::relaxed ? strict * relaxed_factor : strict;
}

}  // namespace taktwerk::runtime
