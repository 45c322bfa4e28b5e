#pragma once
// The SDO information service: a slave's own words about its dictionary. Bytes only, on a mailbox payload (without the 6-byte
// mailbox header). Source: ETG.1000.6 5.6.3, SV33-E manual 6.2.8.3, reference section 5. No allocation.
//
//   | CoE header 2 | opcode 7 bit, incomplete 1 bit | reserved 1 | fragments left 2 | data |
//
// Each answer may come in fragments: the data of all fragments, put together, is what the parse_* functions below take (only the
// first fragment of a list repeats the list type). Encoders return the bytes written; 0 when the buffer is too small.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

enum class SdoInfoOpcode : std::uint8_t {
    list_request = 1,
    list_response = 2,
    object_request = 3,
    object_response = 4,
    entry_request = 5,
    entry_response = 6,
    error = 7,
};

enum class ObjectList : std::uint16_t { all = 1, rx_mappable = 2, tx_mappable = 3, backup = 4, startup = 5 };
enum class ObjectCode : std::uint8_t { variable = 7, array = 8, record = 9 };

/// Bits of an entry's access word.
namespace entry_access {
inline constexpr std::uint16_t read_preop = 1u << 0, read_safeop = 1u << 1, read_op = 1u << 2;
inline constexpr std::uint16_t write_preop = 1u << 3, write_safeop = 1u << 4, write_op = 1u << 5;
inline constexpr std::uint16_t rx_mappable = 1u << 6, tx_mappable = 1u << 7, backup = 1u << 8, setting = 1u << 9;
inline constexpr std::uint16_t read = read_preop | read_safeop | read_op;
inline constexpr std::uint16_t write = write_preop | write_safeop | write_op;
}  // namespace entry_access

/// What an entry request asks for and an answer contains. Access, category and mapping are always there.
namespace value_info {
inline constexpr std::uint8_t unit = 1u << 3, default_value = 1u << 4, minimum = 1u << 5, maximum = 1u << 6;
}  // namespace value_info

inline constexpr std::size_t sdo_info_header_size = 6;  ///< CoE header, opcode, reserved, fragments left

/// One message, that is one fragment.
struct SdoInfoMessage {
    SdoInfoOpcode opcode = SdoInfoOpcode::error;
    bool incomplete = false;           ///< more fragments follow
    std::uint16_t fragments_left = 0;  ///< how many
    std::span<const std::byte> data;
};
/// Any bytes are safe. Nothing for other CoE services, unknown opcodes and truncated headers.
[[nodiscard]] std::optional<SdoInfoMessage> parse_sdo_info(std::span<const std::byte> payload) noexcept;
std::size_t encode_sdo_info(std::span<std::byte> out, const SdoInfoMessage& message) noexcept;

std::size_t encode_list_request(std::span<std::byte> out, ObjectList list) noexcept;
std::size_t encode_object_request(std::span<std::byte> out, std::uint16_t index) noexcept;
/// `wanted`: bits of value_info.
std::size_t encode_entry_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint8_t wanted) noexcept;
/// `code`: as an SDO abort (ecat/wire/sdo.hpp).
std::size_t encode_info_error(std::span<std::byte> out, std::uint32_t code) noexcept;

/// Data of a list answer: indexes, ascending by convention only.
class ObjectListView {
public:
    explicit ObjectListView(std::uint16_t type, std::span<const std::byte> indexes) noexcept : type_(type), indexes_(indexes) {}
    [[nodiscard]] std::uint16_t type() const noexcept { return type_; }
    [[nodiscard]] std::size_t size() const noexcept { return indexes_.size() / 2; }
    [[nodiscard]] std::uint16_t operator[](std::size_t n) const noexcept;

private:
    std::uint16_t type_;
    std::span<const std::byte> indexes_;
};

/// Data of an object description. Views: valid as long as the bytes are.
struct ObjectDescriptionView {
    std::uint16_t index = 0;
    std::uint16_t data_type = 0;  ///< CoE type number: of a variable, or of an array's or record's entries
    std::uint8_t max_sub = 0;
    std::uint8_t code = 0;  ///< ObjectCode
    std::string_view name;
};

/// Data of an entry description. What value_info does not announce is empty.
struct EntryDescriptionView {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint8_t contains = 0;  ///< value_info
    std::uint16_t data_type = 0;
    std::uint16_t bits = 0;
    std::uint16_t access = 0;
    std::optional<std::uint32_t> unit;
    std::span<const std::byte> default_value, minimum, maximum;
    std::string_view name;
};

// Nothing when the data is shorter than its fixed part and what it announces.
[[nodiscard]] std::optional<ObjectListView> parse_object_list(std::span<const std::byte> data) noexcept;
[[nodiscard]] std::optional<ObjectDescriptionView> parse_object_description(std::span<const std::byte> data) noexcept;
[[nodiscard]] std::optional<EntryDescriptionView> parse_entry_description(std::span<const std::byte> data) noexcept;
[[nodiscard]] std::optional<std::uint32_t> parse_info_error(std::span<const std::byte> data) noexcept;

// Data only; the caller cuts it into fragments.
std::size_t encode_object_description(std::span<std::byte> out, const ObjectDescriptionView& object) noexcept;
std::size_t encode_entry_description(std::span<std::byte> out, const EntryDescriptionView& entry) noexcept;

/// CoE numbers of the basic data types (ETG.1000.6 5.6.7.3, ETG.1020). Text of a number: "UNSIGNED16"; empty when unknown.
namespace coe_type {
inline constexpr std::uint16_t boolean = 0x0001, integer8 = 0x0002, integer16 = 0x0003, integer32 = 0x0004;
inline constexpr std::uint16_t unsigned8 = 0x0005, unsigned16 = 0x0006, unsigned32 = 0x0007, real32 = 0x0008;
inline constexpr std::uint16_t visible_string = 0x0009, octet_string = 0x000A, unicode_string = 0x000B, domain = 0x000F;
inline constexpr std::uint16_t real64 = 0x0011, integer64 = 0x0015, unsigned64 = 0x001B;
inline constexpr std::uint16_t pdo_mapping = 0x0021, identity = 0x0023, sm_synchronisation = 0x0029, record = 0x002A;
}  // namespace coe_type
[[nodiscard]] std::string_view coe_type_text(std::uint16_t number) noexcept;

}  // namespace taktwerk::ecat
