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
/// PDOs (1600h to 160Fh and 1700h to 170Fh, or 1A00h to 1A0Fh and 1B00h to 1B0Fh) has all that is required, or several together have. Where the
/// assignment cannot be written, it is the assigned PDO that is filled, or taken as it is. What is written is read back, and what the slave shows
/// then is what is exchanged. What was left out is a note of the bus; outputs beyond the wish are in BusSlave::kept. Error bus.no_process_data:
/// what is missing, what the slave has, what it refused.
[[nodiscard]] Script<Result<std::vector<PdoDescription>>> search_pdos(Bus& bus, BusSlave& slave, std::uint8_t sync_manager,
                                                                      const PdoWish& wish);

}  // namespace taktwerk::ecat
