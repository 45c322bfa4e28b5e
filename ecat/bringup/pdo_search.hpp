#pragma once
// Process data of a slave whose PDOs nobody stated: it is given a mapping as far as it takes one, and where it takes none the fitting ones of
// its own PDOs are assigned. Service side only. Sources: ETG.1000.6 5.6.7.4; drives that take one PDO of ten entries, whose 1C12h cannot be
// written, or whose mapping is fixed are on the market.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

struct PdoWish {
    PdoDescription pdo;              ///< the PDO to fill, and with what: the most important object first
    std::vector<PdoEntry> required;  ///< what it does not do without
};

/// In this order: the PDOs that are assigned already have all; `wish.pdo` takes it, but for objects that the slave refuses; one of its other
/// PDOs (16x0h to 16xFh and 17x0h to 17xFh, or 1Axxh and 1Bxxh) has all that is required, or several together have. What was left out is a
/// note of the bus. Error bus.no_process_data: what is missing, what the slave has, what it refused.
[[nodiscard]] Script<Result<std::vector<PdoDescription>>> search_pdos(Bus& bus, BusSlave& slave, std::uint8_t sync_manager, const PdoWish& wish);

}  // namespace taktwerk::ecat
