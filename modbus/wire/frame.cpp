#include "modbus/wire/frame.hpp"

#include <algorithm>

#include "modbus/wire/crc.hpp"

namespace taktwerk::modbus {

namespace {

void put(Frame& frame, unsigned byte) noexcept { frame.bytes[frame.size++] = static_cast<std::byte>(byte & 0xFFu); }
void put_word(Frame& frame, unsigned word) noexcept {
    put(frame, word >> 8);
    put(frame, word);
}
void finish(Frame& frame) noexcept {
    const unsigned crc = crc16(frame.span());
    put(frame, crc);
    put(frame, crc >> 8);
}
Frame begin(std::uint8_t station, unsigned function) noexcept {
    Frame frame;
    put(frame, station);
    put(frame, function);
    return frame;
}

unsigned byte_at(std::span<const std::byte> frame, std::size_t at) noexcept { return std::to_integer<unsigned>(frame[at]); }
std::uint16_t word_at(std::span<const std::byte> frame, std::size_t at) noexcept {
    return static_cast<std::uint16_t>((byte_at(frame, at) << 8) | byte_at(frame, at + 1));
}
bool crc_holds(std::span<const std::byte> frame) noexcept {
    const auto body = frame.first(frame.size() - 2);
    return crc16(body) == (byte_at(frame, frame.size() - 2) | (byte_at(frame, frame.size() - 1) << 8));
}

Request plain(std::uint8_t station, Function function) noexcept {
    Request request;
    request.station = station;
    request.function = function;
    return request;
}
Request reading(std::uint8_t station, Function function, std::uint16_t first, std::uint16_t count) noexcept {
    auto request = plain(station, function);
    request.address = first;
    request.count = count;
    return request;
}

}  // namespace

std::string_view name(ExceptionCode code) noexcept {
    switch (code) {
        case ExceptionCode::none: return "none";
        case ExceptionCode::illegal_function: return "illegal function";
        case ExceptionCode::illegal_address: return "illegal data address";
        case ExceptionCode::illegal_value: return "illegal data value";
        case ExceptionCode::device_failure: return "slave device failure";
        case ExceptionCode::acknowledge: return "acknowledge";
        case ExceptionCode::busy: return "slave device busy";
    }
    return "unknown exception";
}

std::string_view name(WireError error) noexcept {
    switch (error) {
        case WireError::none: return "none";
        case WireError::too_short: return "too short";
        case WireError::wrong_length: return "wrong length";
        case WireError::wrong_crc: return "wrong CRC";
        case WireError::unknown_function: return "unknown function";
        case WireError::wrong_count: return "counts that do not agree";
        case WireError::wrong_station: return "another station's answer";
        case WireError::wrong_answer: return "an answer to something else";
    }
    return "?";
}

Request read_parameters(std::uint8_t station, std::uint16_t first, std::uint16_t count) noexcept {
    return reading(station, Function::read_parameters, first, count);
}
Request read_status(std::uint8_t station, std::uint16_t first, std::uint16_t count) noexcept {
    return reading(station, Function::read_status, first, count);
}
Request write_parameter(std::uint8_t station, std::uint16_t number, std::uint16_t value) noexcept {
    auto request = reading(station, Function::write_parameter, number, 1);
    request.words[0] = value;
    return request;
}
Request write_parameters(std::uint8_t station, std::uint16_t first, std::span<const std::uint16_t> values) noexcept {
    const auto count = std::min(values.size(), words_in_frame);
    auto request = reading(station, Function::write_parameters, first, static_cast<std::uint16_t>(count));
    std::copy_n(values.begin(), count, request.words.begin());
    return request;
}
Request diagnose(std::uint8_t station, std::uint16_t data) noexcept {
    auto request = plain(station, Function::diagnose);
    request.data = data;
    return request;
}
Request save(std::uint8_t station) noexcept { return plain(station, Function::save); }
Request servo(std::uint8_t station, std::uint8_t what) noexcept {
    auto request = plain(station, Function::servo);
    request.data = what;
    return request;
}
Request clear_alarm(std::uint8_t station) noexcept { return plain(station, Function::clear_alarm); }

Frame encode(const Request& request) noexcept {
    auto frame = begin(request.station, static_cast<unsigned>(request.function));
    switch (request.function) {
        case Function::read_parameters:
        case Function::read_status:
            put_word(frame, request.address);
            put_word(frame, request.count);
            break;
        case Function::write_parameter:
            put_word(frame, request.address);
            put_word(frame, request.words[0]);
            break;
        case Function::diagnose: put_word(frame, request.data); break;
        case Function::write_parameters: {
            const auto values = request.values();
            put_word(frame, request.address);
            put_word(frame, static_cast<unsigned>(values.size()));
            put(frame, static_cast<unsigned>(2 * values.size()));
            for (const auto value : values) put_word(frame, value);
            break;
        }
        case Function::servo: put(frame, request.data); break;
        case Function::save:
        case Function::clear_alarm: break;
    }
    finish(frame);
    return frame;
}

Frame encode_response(const Request& request, std::span<const std::uint16_t> words) noexcept {
    switch (request.function) {
        case Function::read_parameters:
        case Function::read_status: {
            auto frame = begin(request.station, static_cast<unsigned>(request.function));
            const auto count = std::min(words.size(), words_in_frame);
            put(frame, static_cast<unsigned>(2 * count));
            for (const auto word : words.first(count)) put_word(frame, word);
            finish(frame);
            return frame;
        }
        case Function::write_parameters: {
            auto frame = begin(request.station, static_cast<unsigned>(request.function));
            put_word(frame, request.address);
            put_word(frame, request.count);
            finish(frame);
            return frame;
        }
        default: return encode(request);
    }
}

Frame encode_exception(std::uint8_t station, std::uint8_t function, ExceptionCode code) noexcept {
    auto frame = begin(station, function | exception_bit);
    put(frame, static_cast<unsigned>(code));
    finish(frame);
    return frame;
}

Heard parse_request(std::span<const std::byte> frame) noexcept {
    Heard heard;
    if (frame.size() < shortest_frame) {
        heard.error = WireError::too_short;
        return heard;
    }
    if (!crc_holds(frame)) {
        heard.error = WireError::wrong_crc;
        return heard;
    }
    heard.station = std::to_integer<std::uint8_t>(frame[0]);
    heard.function_byte = std::to_integer<std::uint8_t>(frame[1]);
    const auto* rule = find_rule(heard.function_byte);
    if (rule == nullptr) {
        heard.error = WireError::unknown_function;
        return heard;
    }
    const auto length = frame_length(Direction::request, frame);
    if (length.known != LengthKnown::yes || length.bytes != frame.size()) {
        heard.error = WireError::wrong_length;
        return heard;
    }
    auto& request = heard.request;
    request.station = heard.station;
    request.function = rule->function;
    switch (rule->function) {
        case Function::read_parameters:
        case Function::read_status:
            request.address = word_at(frame, 2);
            request.count = word_at(frame, 4);
            break;
        case Function::write_parameter:
            request.address = word_at(frame, 2);
            request.count = 1;
            request.words[0] = word_at(frame, 4);
            break;
        case Function::diagnose: request.data = word_at(frame, 2); break;
        case Function::write_parameters: {
            request.address = word_at(frame, 2);
            request.count = word_at(frame, 4);
            const auto bytes = byte_at(frame, 6);
            if (request.count == 0 || request.count > words_in_frame || bytes != 2u * request.count) {
                heard.error = WireError::wrong_count;
                return heard;
            }
            for (std::size_t i = 0; i < request.count; ++i) request.words[i] = word_at(frame, 7 + 2 * i);
            break;
        }
        case Function::servo: request.data = static_cast<std::uint16_t>(byte_at(frame, 2)); break;
        case Function::save:
        case Function::clear_alarm: break;
    }
    return heard;
}

WireError parse_response(std::span<const std::byte> frame, const Request& request, Response& response) noexcept {
    response = {};
    if (frame.size() < shortest_frame) return WireError::too_short;
    const auto length = frame_length(Direction::response, frame);
    if (length.known == LengthKnown::yes && length.bytes != frame.size()) return WireError::wrong_length;
    if (!crc_holds(frame)) return WireError::wrong_crc;
    if (byte_at(frame, 0) != request.station) return WireError::wrong_station;
    const auto function = byte_at(frame, 1);
    if ((function & ~static_cast<unsigned>(exception_bit)) != static_cast<unsigned>(request.function)) return WireError::wrong_answer;
    if ((function & exception_bit) != 0) {
        response.exception = static_cast<ExceptionCode>(byte_at(frame, 2));
        return response.exception == ExceptionCode::none ? WireError::wrong_answer : WireError::none;
    }
    if (request.function == Function::read_parameters || request.function == Function::read_status) {
        if (byte_at(frame, 2) != 2u * request.count || request.count > words_in_frame) return WireError::wrong_answer;
        response.count = request.count;
        for (std::size_t i = 0; i < request.count; ++i) response.words[i] = word_at(frame, 3 + 2 * i);
        return WireError::none;
    }
    const auto expected = encode_response(request, {});
    const auto echo = expected.span();
    return std::equal(frame.begin(), frame.end(), echo.begin(), echo.end()) ? WireError::none : WireError::wrong_answer;
}

}  // namespace taktwerk::modbus
