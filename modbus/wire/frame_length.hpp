#pragma once
// Where a frame ends, from its own first bytes: one row for each function of the XP200 (manual 9.6). Functions 08h, 41h, 42h and 43h are the
// vendor's own: 08h has no sub-function, the other three carry one byte or none.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::modbus {

enum class Function : std::uint8_t {
    read_parameters = 0x03,  ///< also status, from address 1000h on
    read_status = 0x04,
    write_parameter = 0x06,
    diagnose = 0x08,  ///< echoes two bytes
    write_parameters = 0x10,
    save = 0x41,   ///< parameter table into the EEPROM
    servo = 0x42,  ///< 55h enables, AAh disables
    clear_alarm = 0x43,
};

enum class Direction : std::uint8_t { request, response };

inline constexpr std::uint8_t exception_bit = 0x80;
inline constexpr std::size_t exception_length = 5;  ///< station, function | 80h, code, CRC
inline constexpr std::size_t shortest_frame = 4;    ///< station, function, CRC
inline constexpr std::size_t longest_frame = 256;   ///< of Modbus RTU

/// Bytes of a frame with its CRC: `fixed`, plus the value of the byte at `count_at` where that is not 0.
struct LengthRule {
    Function function;
    std::uint8_t request_fixed, request_count_at;
    std::uint8_t response_fixed, response_count_at;
    std::string_view name;
};

inline constexpr std::array<LengthRule, 8> length_rules{{
    {Function::read_parameters, 8, 0, 5, 2, "read parameters (03h)"},
    {Function::read_status, 8, 0, 5, 2, "read status (04h)"},
    {Function::write_parameter, 8, 0, 8, 0, "write parameter (06h)"},
    {Function::diagnose, 6, 0, 6, 0, "diagnose (08h)"},
    {Function::write_parameters, 9, 6, 8, 0, "write parameters (10h)"},
    {Function::save, 4, 0, 4, 0, "save (41h)"},
    {Function::servo, 5, 0, 5, 0, "servo (42h)"},
    {Function::clear_alarm, 4, 0, 4, 0, "clear alarm (43h)"},
}};

[[nodiscard]] constexpr const LengthRule* find_rule(std::uint8_t function) noexcept {
    for (const auto& rule : length_rules)
        if (static_cast<std::uint8_t>(rule.function) == function) return &rule;
    return nullptr;
}

enum class LengthKnown : std::uint8_t {
    yes,
    not_yet,  ///< more bytes are needed to tell
    never,    ///< the function is unknown: only silence ends the frame
};

struct FrameLength {
    LengthKnown known = LengthKnown::not_yet;
    std::size_t bytes = 0;  ///< with CRC
};

/// Length of the frame that `begin` is the beginning of. Any bytes. Real-time safe.
[[nodiscard]] constexpr FrameLength frame_length(Direction direction, std::span<const std::byte> begin) noexcept {
    if (begin.size() < 2) return {};
    const auto function = std::to_integer<std::uint8_t>(begin[1]);
    if (direction == Direction::response && (function & exception_bit) != 0) return {LengthKnown::yes, exception_length};
    const auto* rule = find_rule(function);
    if (rule == nullptr) return {LengthKnown::never, 0};
    const std::size_t fixed = direction == Direction::request ? rule->request_fixed : rule->response_fixed;
    const std::size_t count_at = direction == Direction::request ? rule->request_count_at : rule->response_count_at;
    if (count_at == 0) return {LengthKnown::yes, fixed};
    if (begin.size() <= count_at) return {};
    return {LengthKnown::yes, fixed + std::to_integer<std::size_t>(begin[count_at])};
}

}  // namespace taktwerk::modbus
