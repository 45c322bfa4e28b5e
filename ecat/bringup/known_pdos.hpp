#pragma once
// The process data of a slave that nobody has asked yet, by its configuration and its description. Pure.

#include <vector>

#include "ecat/bus_config.hpp"

namespace taktwerk::ecat {

struct KnownPdos {
    std::vector<PdoDescription> rx, tx;
};

/// The PDOs that are selected, else the factory ones of its description with its modules. The slave needs a `device`.
[[nodiscard]] KnownPdos known_pdos(const SlaveConfig& slave);

}  // namespace taktwerk::ecat
