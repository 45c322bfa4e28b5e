#pragma once
// The SDO information service: what objects a slave has and what they are, in its own words. Scripts, service side only; they
// share the endpoint's lock with SDO transfers. Source: ETG.1000.6 (SDO information), reference/ethercat-masters.md section 5.
// Errors: as sdo_client.hpp; sdo.no_info when the slave does not have the service.

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/coe/sdo_client.hpp"

namespace taktwerk::ecat {

enum class ObjectList : std::uint16_t { all = 1, rx_mappable = 2, tx_mappable = 3, backup = 4, startup = 5 };
enum class ObjectCode : std::uint8_t { variable = 7, array = 8, record = 9 };

struct ObjectInfo {
    std::uint16_t index = 0;
    std::uint16_t data_type = 0;  ///< CoE type number
    std::uint8_t max_sub = 0;
    ObjectCode code = ObjectCode::variable;
    std::string name;
};

/// Bits of EntryInfo::access.
namespace entry_access {
inline constexpr std::uint16_t read_preop = 1u << 0, read_safeop = 1u << 1, read_op = 1u << 2;
inline constexpr std::uint16_t write_preop = 1u << 3, write_safeop = 1u << 4, write_op = 1u << 5;
inline constexpr std::uint16_t rx_mappable = 1u << 6, tx_mappable = 1u << 7, backup = 1u << 8, setting = 1u << 9;
}  // namespace entry_access

struct EntryInfo {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint16_t data_type = 0;
    std::uint16_t bits = 0;
    std::uint16_t access = 0;
    std::string name;
};

[[nodiscard]] Script<Result<std::vector<std::uint16_t>>> list_objects(DatagramPort& port, MailboxEndpoint& mailbox, ObjectList list);
[[nodiscard]] Script<Result<ObjectInfo>> describe_object(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index);
[[nodiscard]] Script<Result<EntryInfo>> describe_entry(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub);

}  // namespace taktwerk::ecat
