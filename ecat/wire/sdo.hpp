#pragma once
// CAN application protocol over EtherCAT: the CoE header, SDO messages (expedited, normal, segments, abort), emergencies.
// All functions work on a mailbox payload, that is without the 6-byte mailbox header (ecat/wire/mailbox.hpp).
// Encoders return the bytes written; 0 when the buffer is too small. No allocation. Source: ETG.1000.6, reference section 5.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

enum class CoeService : std::uint8_t {
    emergency = 1,
    sdo_request = 2,
    sdo_response = 3,
    tx_pdo = 4,
    rx_pdo = 5,
    tx_pdo_request = 6,
    rx_pdo_request = 7,
    sdo_info = 8,
};
inline constexpr std::size_t coe_header_size = 2;
inline constexpr std::size_t sdo_initiate_size = 10;       ///< CoE header, command, index, subindex, 4 bytes
inline constexpr std::size_t sdo_segment_header_size = 3;  ///< CoE header, command
inline constexpr std::size_t sdo_segment_minimum = 7;      ///< a shorter segment is padded to this and says so

/// Service of a CoE message; nothing when it is shorter than its header.
[[nodiscard]] std::optional<CoeService> coe_service(std::span<const std::byte> payload) noexcept;

enum class SdoKind : std::uint8_t {
    download_request,
    download_response,
    download_segment_request,
    download_segment_response,
    upload_request,
    upload_response,
    upload_segment_request,
    upload_segment_response,
    abort,
};

/// One SDO message in both directions; fields that its kind does not have stay at their defaults.
struct SdoMessage {
    SdoKind kind = SdoKind::abort;
    std::uint16_t index = 0;  ///< initiate and abort
    std::uint8_t sub = 0;
    bool complete_access = false;     ///< initiate
    bool expedited = false;           ///< initiate with data
    bool toggle = false;              ///< segments
    bool last = false;                ///< segments with data
    std::uint32_t complete_size = 0;  ///< download request, upload response: bytes of the whole value
    std::uint32_t abort_code = 0;     ///< abort
    std::span<const std::byte> data;  ///< what this message carries; more follows in segments when shorter than complete_size
};

/// Any bytes are safe. Nothing for other CoE services, unknown commands and truncated messages.
[[nodiscard]] std::optional<SdoMessage> parse_sdo(std::span<const std::byte> payload) noexcept;

/// Client: asks for a value.
std::size_t encode_upload_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, bool complete_access = false) noexcept;
/// Client: writes a value; expedited for 1..4 bytes, else with as much data as fits: the first (result - sdo_initiate_size) bytes.
std::size_t encode_download_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data,
                                    bool complete_access = false) noexcept;
/// Server: the value; expedited for 1..4 bytes, else with as much as fits: the first (result - sdo_initiate_size) bytes.
std::size_t encode_upload_response(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data,
                                   bool complete_access = false) noexcept;
/// Server: the value was taken.
std::size_t encode_download_response(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub,
                                     bool complete_access = false) noexcept;

/// Client: asks for the next segment. The first has toggle false.
std::size_t encode_upload_segment_request(std::span<std::byte> out, bool toggle) noexcept;
/// Server and client: the next segment with all of `data`.
std::size_t encode_upload_segment_response(std::span<std::byte> out, bool toggle, bool last, std::span<const std::byte> data) noexcept;
std::size_t encode_download_segment_request(std::span<std::byte> out, bool toggle, bool last, std::span<const std::byte> data) noexcept;
std::size_t encode_download_segment_response(std::span<std::byte> out, bool toggle) noexcept;

/// Either side ends the transfer. The standard gives aborts the service "SDO request" in both directions.
std::size_t encode_sdo_abort(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint32_t code) noexcept;

/// SDO abort codes that Taktwerk itself sends or treats apart; texts for all of them below.
namespace sdo_abort {
inline constexpr std::uint32_t toggle = 0x05030000;
inline constexpr std::uint32_t timeout = 0x05040000;
inline constexpr std::uint32_t unknown_command = 0x05040001;
inline constexpr std::uint32_t out_of_memory = 0x05040005;
inline constexpr std::uint32_t unsupported_access = 0x06010000;
inline constexpr std::uint32_t write_only = 0x06010001;
inline constexpr std::uint32_t read_only = 0x06010002;
inline constexpr std::uint32_t sub0_not_zero = 0x06010003;
inline constexpr std::uint32_t no_complete_access = 0x06010004;
inline constexpr std::uint32_t too_long_for_mailbox = 0x06010005;
inline constexpr std::uint32_t mapped_to_pdo = 0x06010006;
inline constexpr std::uint32_t no_object = 0x06020000;
inline constexpr std::uint32_t not_mappable = 0x06040041;
inline constexpr std::uint32_t pdo_length = 0x06040042;
inline constexpr std::uint32_t parameter_incompatible = 0x06040043;
inline constexpr std::uint32_t device_incompatible = 0x06040047;
inline constexpr std::uint32_t hardware = 0x06060000;
inline constexpr std::uint32_t wrong_length = 0x06070010;
inline constexpr std::uint32_t too_long = 0x06070012;
inline constexpr std::uint32_t too_short = 0x06070013;
inline constexpr std::uint32_t no_subindex = 0x06090011;
inline constexpr std::uint32_t value_range = 0x06090030;
inline constexpr std::uint32_t value_too_high = 0x06090031;
inline constexpr std::uint32_t value_too_low = 0x06090032;
inline constexpr std::uint32_t maximum_below_minimum = 0x06090036;
inline constexpr std::uint32_t general = 0x08000000;
inline constexpr std::uint32_t cannot_store = 0x08000020;
inline constexpr std::uint32_t local_control = 0x08000021;
inline constexpr std::uint32_t device_state = 0x08000022;
inline constexpr std::uint32_t no_dictionary = 0x08000023;
}  // namespace sdo_abort

struct SdoAbortInfo {
    std::uint32_t code;
    std::string_view text;
};
[[nodiscard]] std::span<const SdoAbortInfo> sdo_abort_codes() noexcept;  ///< ascending
/// "unknown abort code" for codes that the standard does not list.
[[nodiscard]] std::string_view sdo_abort_text(std::uint32_t code) noexcept;

/// What a slave sends unasked when it enters a fault. May arrive between a request and its answer.
struct Emergency {
    std::uint16_t code = 0;           ///< CiA error code, as in 603Fh; 0000h error gone
    std::uint8_t error_register = 0;  ///< 1001h
    std::array<std::byte, 5> data{};  ///< vendor's
    friend bool operator==(const Emergency&, const Emergency&) = default;
};
inline constexpr std::size_t emergency_size = coe_header_size + 8;
[[nodiscard]] std::optional<Emergency> parse_emergency(std::span<const std::byte> payload) noexcept;
std::size_t encode_emergency(std::span<std::byte> out, const Emergency& emergency) noexcept;

}  // namespace taktwerk::ecat
