#pragma once
// What the server says to a request. Real-time safe but for changes_of().
// Source: MODBUS Application Protocol Specification V1.1b3, chapters 6 and 7; MODBUS Messaging on TCP/IP Implementation Guide V1.0b.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "modbus/server/register_map.hpp"
#include "modbus/server/request.hpp"
#include "modbus/server/served_image.hpp"

namespace taktwerk::modbus::server {

/// A frame on its way out.
struct AnswerFrame {
    std::array<std::uint8_t, most_frame_bytes> bytes{};
    std::size_t size = 0;
    [[nodiscard]] std::span<const std::uint8_t> span() const noexcept { return {bytes.data(), size}; }
};

/// To whom the answer goes: transaction, unit and function of the request.
struct AnswerTo {
    std::uint16_t transaction = 0;
    std::uint8_t unit = 0, function = 0;
};

[[nodiscard]] AnswerFrame refusal(const AnswerTo& to, Exception exception) noexcept;

/// Registers or bits from the image. `exception`: illegal_address where the map does not have all of them.
struct ReadAnswer {
    Exception exception = Exception::none;
    AnswerFrame frame;
};
[[nodiscard]] ReadAnswer answer_read(const RegisterMap& map, const ServedImage& image, const AnswerTo& to, const Request& request) noexcept;

/// A write that was carried out: address, and the value or how many.
[[nodiscard]] AnswerFrame written(const AnswerTo& to, const Request& request) noexcept;

/// What a write asks for: a number for each register, in the order of their addresses.
struct RegisterChange {
    std::size_t index = 0;  ///< of the map
    double number = 0;      ///< finite
};
struct AskedChanges {
    Exception exception = Exception::none;  ///< illegal_address: not all of them are offered and writable; illegal_value: no finite number
    std::vector<RegisterChange> changes;
};
[[nodiscard]] AskedChanges changes_of(const RegisterMap& map, const Request& request);

}  // namespace taktwerk::modbus::server
