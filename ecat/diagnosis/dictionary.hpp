#pragma once
// Every object of a slave with name, type, access and value, in the slave's own words (SDO information), or, from slaves
// without that service, the objects of its description. Reads only; takes seconds on drives with hundreds of objects.

#include <optional>
#include <string>
#include <vector>

#include "ecat/bringup/bus.hpp"
#include "ecat/coe/object_info.hpp"

namespace taktwerk::ecat {

struct DictionaryEntry {
    EntryInfo info;
    std::optional<std::vector<std::byte>> value;
    std::optional<Error> error;  ///< why there is no value: write-only, aborted, ...
};
struct DictionaryObject {
    ObjectInfo info;
    std::vector<DictionaryEntry> entries;
};
struct Dictionary {
    std::string subject;
    bool from_slave = true;  ///< false: it has no SDO information; names and types are the description's
    std::vector<DictionaryObject> objects;
};

/// The slave's mailbox is open. `bus.progress` says how far it is.
[[nodiscard]] Script<Result<Dictionary>> read_dictionary(Bus& bus, BusSlave& slave);

/// "r-- rw- ..": read and write in PREOP, SAFEOP, OP, then how it can be mapped: "rw rw r- Rx".
[[nodiscard]] std::string access_text(std::uint16_t access);

/// The type of one entry: asked of the slave, else the description's, else unknown.
[[nodiscard]] Script<Result<std::uint16_t>> find_type(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub);

}  // namespace taktwerk::ecat
