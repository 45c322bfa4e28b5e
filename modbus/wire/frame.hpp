#pragma once
// Requests and responses as values, and their bytes. Words of a frame are high byte first, the CRC low byte first (XP200 manual 9.3, 9.6).
// Everything here is real-time safe: no allocation, no exception.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "modbus/wire/frame_length.hpp"

namespace taktwerk::modbus {

/// Words a frame of 256 bytes can carry. What a drive accepts is less.
inline constexpr std::size_t words_in_frame = 122;

/// Of the XP200: words in one reading (manual 9.6.1, 9.6.2) and in one writing (9.6.4, note; its table says 122).
inline constexpr std::size_t read_words_limit = 8, write_words_limit = 10;

inline constexpr std::uint8_t servo_on = 0x55, servo_off = 0xAA;  ///< manual 9.6.7
/// A drive needs this long to save its parameters; nothing may be asked of it meanwhile (manual 9.6.6). Seconds.
inline constexpr int save_seconds = 5;

/// Codes of an exception (manual 9.3).
enum class ExceptionCode : std::uint8_t {
    none = 0,
    illegal_function = 1,
    illegal_address = 2,
    illegal_value = 3,
    device_failure = 4,
    acknowledge = 5,
    busy = 6,
};
[[nodiscard]] std::string_view name(ExceptionCode code) noexcept;

enum class WireError : std::uint8_t {
    none,
    too_short,     ///< fewer bytes than any frame has
    wrong_length,  ///< not what the function's row in the table says
    wrong_crc,
    unknown_function,  ///< CRC is right; station and function are filled in
    wrong_count,       ///< byte count and word count do not agree, or are 0
    wrong_station,     ///< a response of somebody else
    wrong_answer,      ///< a response to something else: function, address, count or echo
};
[[nodiscard]] std::string_view name(WireError error) noexcept;

/// One frame of bytes.
struct Frame {
    std::array<std::byte, longest_frame> bytes{};
    std::size_t size = 0;

    [[nodiscard]] std::span<const std::byte> span() const noexcept { return {bytes.data(), size}; }
};

struct Request {
    std::uint8_t station = 0;
    Function function = Function::diagnose;
    std::uint16_t address = 0;  ///< first register
    std::uint16_t count = 0;    ///< words read or written; 1 for write_parameter
    std::uint16_t data = 0;     ///< diagnose: the two bytes; servo: the byte
    std::array<std::uint16_t, words_in_frame> words{};

    [[nodiscard]] std::span<const std::uint16_t> values() const noexcept {
        return std::span{words}.first(count < words_in_frame ? count : words_in_frame);
    }
};

/// The eight requests. `count` and sizes are not checked here: the drive's limits are the client's business.
[[nodiscard]] Request read_parameters(std::uint8_t station, std::uint16_t first, std::uint16_t count) noexcept;
[[nodiscard]] Request read_status(std::uint8_t station, std::uint16_t first, std::uint16_t count) noexcept;
[[nodiscard]] Request write_parameter(std::uint8_t station, std::uint16_t number, std::uint16_t value) noexcept;
[[nodiscard]] Request write_parameters(std::uint8_t station, std::uint16_t first, std::span<const std::uint16_t> values) noexcept;
[[nodiscard]] Request diagnose(std::uint8_t station, std::uint16_t data) noexcept;
[[nodiscard]] Request save(std::uint8_t station) noexcept;
[[nodiscard]] Request servo(std::uint8_t station, std::uint8_t what) noexcept;
[[nodiscard]] Request clear_alarm(std::uint8_t station) noexcept;

struct Response {
    ExceptionCode exception = ExceptionCode::none;
    std::uint16_t count = 0;  ///< words read
    std::array<std::uint16_t, words_in_frame> words{};

    [[nodiscard]] std::span<const std::uint16_t> values() const noexcept { return std::span{words}.first(count); }
};

[[nodiscard]] Frame encode(const Request& request) noexcept;
/// What a drive answers to `request` when it has no objection: words for the reading functions, else an echo.
[[nodiscard]] Frame encode_response(const Request& request, std::span<const std::uint16_t> words) noexcept;
[[nodiscard]] Frame encode_exception(std::uint8_t station, std::uint8_t function, ExceptionCode code) noexcept;

/// A whole frame, as a drive hears it. Errors: too_short, wrong_crc, unknown_function, wrong_length, wrong_count; `request` is valid
/// only without one, except station and `function_byte`, which are after unknown_function and wrong_count too.
struct Heard {
    WireError error = WireError::none;
    std::uint8_t station = 0, function_byte = 0;
    Request request;
};
[[nodiscard]] Heard parse_request(std::span<const std::byte> frame) noexcept;

/// A whole frame, as the answer to `request`. Errors: too_short, wrong_length, wrong_crc, wrong_station, wrong_answer.
[[nodiscard]] WireError parse_response(std::span<const std::byte> frame, const Request& request, Response& response) noexcept;

}  // namespace taktwerk::modbus
