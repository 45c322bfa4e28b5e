#pragma once
// Ethernet over EtherCAT: fragments of frames, and the IP settings of a slave. All functions work on a mailbox payload, that is
// without the 6-byte mailbox header (ecat/wire/mailbox.hpp). No allocation. Source: ETG.1000.6 (EoE).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

enum class EoeType : std::uint8_t {
    fragment = 0,
    timestamp_response = 1,
    set_ip_request = 2,
    set_ip_response = 3,
    set_filter_request = 4,
    set_filter_response = 5,
    get_ip_request = 6,
    get_ip_response = 7,
    get_filter_request = 8,
    get_filter_response = 9,
};
inline constexpr std::size_t eoe_header_size = 4;
inline constexpr std::size_t eoe_block = 32;     ///< all fragments but the last are a multiple of it
inline constexpr std::size_t eoe_time_size = 4;  ///< a time stamp behind the last fragment
inline constexpr std::uint8_t eoe_most_fragments = 64;

/// Nothing when the message is shorter than its header or the type does not exist.
[[nodiscard]] std::optional<EoeType> eoe_type(std::span<const std::byte> payload) noexcept;

/// A piece of an Ethernet frame.
struct EoeFragment {
    std::uint8_t port = 0;    ///< of the slave's switch; 0: any
    std::uint8_t frame = 0;   ///< 0..15: all fragments of a frame have the same
    std::uint8_t number = 0;  ///< 0..63
    std::uint8_t blocks = 0;  ///< of the first fragment: of the whole frame, rounded up; of others: before this one
    bool last = false;
    bool time_asked = false;            ///< the sender wants to know when the frame left
    std::optional<std::uint32_t> time;  ///< ns; only behind the last fragment
    std::span<const std::byte> data;    ///< a view of the mailbox
};
/// Nothing when it is no fragment, or too short for what its header says.
[[nodiscard]] std::optional<EoeFragment> parse_eoe_fragment(std::span<const std::byte> payload) noexcept;
/// The bytes written; 0 when `out` is too small.
std::size_t encode_eoe_fragment(std::span<std::byte> out, const EoeFragment& fragment) noexcept;

/// Bytes of a frame that a mailbox of this size carries in one fragment that is not the last.
[[nodiscard]] std::size_t eoe_room(std::size_t mailbox_size) noexcept;

using EoeMac = std::array<std::byte, 6>;

/// What a slave is told of its network; what is not given stays as it is.
struct EoeAddress {
    std::optional<EoeMac> mac;
    std::optional<std::uint32_t> ip, subnet, gateway, dns;  ///< 192.168.1.2 = C0A80102h
    std::string_view name;                                  ///< of the host, at most 31 characters; empty: not given
};
/// Every field has its place, given or not, as TwinCAT and IgH write it.
inline constexpr std::size_t eoe_set_ip_size = eoe_header_size + 4 + 6 + 4 * 4 + 32;
std::size_t encode_eoe_set_ip(std::span<std::byte> out, std::uint8_t port, const EoeAddress& address) noexcept;
/// Of a request; fields that are not there are not given. Nothing when it is no such request.
[[nodiscard]] std::optional<EoeAddress> parse_eoe_set_ip(std::span<const std::byte> payload) noexcept;

enum class EoeResult : std::uint16_t {
    success = 0x0000,
    unspecified = 0x0001,
    unsupported_type = 0x0002,
    no_ip_support = 0x0201,
    no_dhcp_support = 0x0202,
    no_filter_support = 0x0401,
};
[[nodiscard]] std::string_view text(EoeResult result) noexcept;
/// The answer to a request of `asked`: its type is the one behind it. Nothing when it is none.
[[nodiscard]] std::optional<EoeResult> parse_eoe_result(std::span<const std::byte> payload, EoeType asked) noexcept;
std::size_t encode_eoe_result(std::span<std::byte> out, std::uint8_t port, EoeType asked, EoeResult result) noexcept;

}  // namespace taktwerk::ecat
