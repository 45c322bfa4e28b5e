#include "axes/sim/xp200/station.hpp"

namespace taktwerk::axes::sim::xp200 {

namespace pr = axes::xp200::pr;
namespace status = axes::xp200::status;
using modbus::ExceptionCode;
using modbus::Function;

modbus::LineSettings Drive::line() const noexcept {
    using modbus::Parity;
    static constexpr std::uint32_t bauds[] = {4800, 9600, 19200, 38400};  // Pr182 (9.2)
    static constexpr modbus::LineSettings formats[] = {{0, Parity::none, 1}, {0, Parity::even, 1}, {0, Parity::odd, 1},
                                                       {0, Parity::none, 2}, {0, Parity::even, 2}, {0, Parity::odd, 2}};  // Pr183 (9.2)
    const auto& parameters = servo_.parameters();
    auto settings = formats[parameters[pr::format]];
    settings.baud = bauds[parameters[pr::baud]];
    return settings;
}

bool Drive::hear(std::span<const std::byte> frame, Instant, modbus::Frame& answer) {
    const auto own = servo_.parameters()[pr::station];
    const bool powered = servo_.state() != Servo::State::off && servo_.state() != Servo::State::starting;
    if (!powered || own < 1 || own > servo_.options().highest_station) return false;
    const auto heard = modbus::parse_request(frame);
    if (heard.station != own) return false;  // also a wrong CRC; broadcasts are not described
    if (heard.error == modbus::WireError::wrong_crc || heard.error == modbus::WireError::too_short) return false;
    if (servo_.saving()) {
        if (servo_.options().while_saving == WhileSaving::silent) return false;
        answer = modbus::encode_exception(heard.station, heard.function_byte, ExceptionCode::busy);
        return true;
    }
    std::array<std::uint16_t, modbus::words_in_frame> words{};
    auto exception = ExceptionCode::none;
    switch (heard.error) {
        case modbus::WireError::unknown_function: exception = ExceptionCode::illegal_function; break;
        case modbus::WireError::wrong_count: exception = ExceptionCode::illegal_value; break;
        case modbus::WireError::none: exception = execute(heard.request, words); break;
        default: return false;  // a length of its own: it cannot tell where the frame ends
    }
    answer = exception == ExceptionCode::none ? modbus::encode_response(heard.request, std::span{words}.first(heard.request.count))
                                              : modbus::encode_exception(heard.station, heard.function_byte, exception);
    return true;
}

ExceptionCode Drive::execute(const modbus::Request& request, std::array<std::uint16_t, modbus::words_in_frame>& words) {
    switch (request.function) {
        case Function::read_parameters:
        case Function::read_status: return read(request, words);
        case Function::write_parameter:
        case Function::write_parameters: return write(request);
        case Function::diagnose: return ExceptionCode::none;
        case Function::save: servo_.begin_saving(); return ExceptionCode::none;
        case Function::servo:
            if (request.data != modbus::servo_on && request.data != modbus::servo_off) return ExceptionCode::illegal_value;
            servo_.enable_by_port(request.data == modbus::servo_on && servo_.alarm() == 0);
            return ExceptionCode::none;
        case Function::clear_alarm: servo_.clear_alarm(); return ExceptionCode::none;  // also where it does not help
    }
    return ExceptionCode::illegal_function;
}

/// 9.5, 9.6.1, 9.6.2: at most 8 words; status by 04h, or by 03h from 1000h on.
ExceptionCode Drive::read(const modbus::Request& request, std::array<std::uint16_t, modbus::words_in_frame>& words) {
    if (request.count == 0 || request.count > modbus::read_words_limit) return ExceptionCode::illegal_value;
    const bool by_parameters = request.function == Function::read_parameters;
    const bool of_status = !by_parameters || request.address >= status::by_parameters;
    const unsigned first = of_status && by_parameters ? request.address - status::by_parameters : request.address;
    for (unsigned i = 0; i < request.count; ++i) {
        const auto at = static_cast<std::uint16_t>(first + i);
        if (of_status) {
            if (first + i >= status::count) return ExceptionCode::illegal_address;
            words[i] = servo_.status(at);
        } else if (const auto refused = servo_.parameters().read(at, words[i]); refused != ExceptionCode::none) return refused;
    }
    return ExceptionCode::none;
}

/// 9.6.3, 9.6.4; writing status has no effect (9.5): the address is none of the parameters'. All or nothing.
ExceptionCode Drive::write(const modbus::Request& request) {
    if (request.count > servo_.options().words_written) return ExceptionCode::illegal_value;
    const auto before = servo_.parameters();
    for (unsigned i = 0; i < request.count; ++i) {
        const auto refused = servo_.parameters().write(static_cast<std::uint16_t>(request.address + i), request.words[i]);
        if (refused == ExceptionCode::none) continue;
        servo_.parameters() = before;
        return refused;
    }
    return ExceptionCode::none;
}

}  // namespace taktwerk::axes::sim::xp200
