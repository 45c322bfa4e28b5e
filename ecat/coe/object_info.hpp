#pragma once
// The SDO information service: what objects a slave has and what they are, in its own words. Scripts, service side only; they
// share the endpoint's lock with SDO transfers. Source: ETG.1000.6 (SDO information), reference/ethercat-masters.md section 5.
// Errors: as sdo_client.hpp; sdo.no_info when the slave does not have the service.

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat {

struct ObjectInfo {
    std::uint16_t index = 0;
    std::uint16_t data_type = 0;  ///< CoE type number
    std::uint8_t max_sub = 0;
    ObjectCode code = ObjectCode::variable;
    std::string name;
};

struct EntryInfo {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint16_t data_type = 0;
    std::uint16_t bits = 0;
    std::uint16_t access = 0;  ///< bits of entry_access
    std::string name;
};

[[nodiscard]] Script<Result<std::vector<std::uint16_t>>> list_objects(DatagramPort& port, MailboxEndpoint& mailbox, ObjectList list);
[[nodiscard]] Script<Result<ObjectInfo>> describe_object(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index);
[[nodiscard]] Script<Result<EntryInfo>> describe_entry(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub);

}  // namespace taktwerk::ecat
