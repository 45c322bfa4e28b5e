#pragma once
// Frames and requests of a Modbus TCP client, from bytes that anybody may have sent. Views: valid as long as the bytes are. Real-time safe.
// Source: MODBUS Messaging on TCP/IP Implementation Guide V1.0b, chapter 3.1.3 (header); MODBUS Application Protocol Specification V1.1b3,
// chapters 6.1 to 6.6, 6.11 and 6.12 (requests), 7 (exceptions).

#include <cstddef>
#include <cstdint>
#include <span>

#include "modbus/server/served_register.hpp"

namespace taktwerk::modbus::server {

/// Transaction, protocol 0, length, unit: all with the high byte first.
inline constexpr std::size_t header_bytes = 7;
inline constexpr std::size_t most_pdu_bytes = 253;
inline constexpr std::size_t most_frame_bytes = header_bytes + most_pdu_bytes;

struct Frame {
    enum class State : std::uint8_t {
        incomplete,  ///< more bytes are needed
        whole,
        broken,  ///< no Modbus TCP: nobody knows where the next frame would begin
    };
    State state = State::incomplete;
    std::uint16_t transaction = 0;
    std::uint8_t unit = 0;
    std::span<const std::uint8_t> pdu{};  ///< whole: 1 byte at least
    std::size_t bytes = 0;                ///< whole: of the frame, header and all
};

/// The frame that `bytes` begin with. Of a broken header it is known with its last wrong byte, not only when a length that it made up has come.
[[nodiscard]] Frame frame_of(std::span<const std::uint8_t> bytes) noexcept;

/// Chapter 7; 11 (0Bh) is what a gateway says of a unit that is not there.
enum class Exception : std::uint8_t {
    none = 0,
    illegal_function = 1,
    illegal_address = 2,
    illegal_value = 3,
    server_failure = 4,
    no_such_unit = 11,
};

struct Request {
    std::uint8_t function = 0;
    Table table = Table::holding;
    bool writes = false;
    std::uint16_t address = 0, count = 0;
    std::span<const std::uint8_t> values{};  ///< of a write: bits, lowest first; or registers, high byte first

    /// Of a write: i < count.
    [[nodiscard]] std::uint16_t word(std::size_t i) const noexcept {
        return static_cast<std::uint16_t>(values[2 * i] << 8 | values[2 * i + 1]);
    }
    [[nodiscard]] bool bit(std::size_t i) const noexcept { return (values[i / 8] >> (i % 8) & 1) != 0; }
};

struct HeardRequest {
    Exception exception =
        Exception::none;  ///< illegal_function, illegal_value (a quantity, a length or a coil's value that the function does
                          ///< not have), illegal_address (beyond 65535); then only `request.function` counts
    Request request;
};

/// Functions 1 to 6, 15 and 16. `pdu` has 1 byte at least.
[[nodiscard]] HeardRequest hear(std::span<const std::uint8_t> pdu) noexcept;

}  // namespace taktwerk::modbus::server
