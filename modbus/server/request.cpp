#include "modbus/server/request.hpp"

#include <algorithm>
#include <array>

namespace taktwerk::modbus::server {

namespace {

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t offset) noexcept {
    return static_cast<std::uint16_t>(bytes[offset] << 8 | bytes[offset + 1]);
}

/// What each function does, and how many at once (chapter 6, "Quantity").
struct Function {
    enum class Form : std::uint8_t { read, single, several };
    std::uint8_t code;
    Form form;
    Table table;
    std::uint16_t most;
};
constexpr std::array<Function, 8> functions{{
    {1, Function::Form::read, Table::coil, 2000},
    {2, Function::Form::read, Table::discrete_input, 2000},
    {3, Function::Form::read, Table::holding, 125},
    {4, Function::Form::read, Table::input, 125},
    {5, Function::Form::single, Table::coil, 1},
    {6, Function::Form::single, Table::holding, 1},
    {15, Function::Form::several, Table::coil, 1968},
    {16, Function::Form::several, Table::holding, 123},
}};

constexpr std::size_t plain_bytes = 5;  // function, address, quantity or value

std::size_t value_bytes(Table table, std::uint16_t count) noexcept { return is_bits(table) ? (count + 7u) / 8u : count * 2u; }

}  // namespace

Frame frame_of(std::span<const std::uint8_t> bytes) noexcept {
    Frame frame;
    if ((bytes.size() > 2 && bytes[2] != 0) || (bytes.size() > 3 && bytes[3] != 0)) frame.state = Frame::State::broken;
    if (bytes.size() < 6 || frame.state == Frame::State::broken) return frame;
    const std::size_t length = word_at(bytes, 4);  // unit and PDU
    if (length < 2 || length > most_pdu_bytes + 1) frame.state = Frame::State::broken;
    if (frame.state == Frame::State::broken || bytes.size() < 6 + length) return frame;
    frame.state = Frame::State::whole;
    frame.transaction = word_at(bytes, 0);
    frame.unit = bytes[6];
    frame.pdu = bytes.subspan(header_bytes, length - 1);
    frame.bytes = 6 + length;
    return frame;
}

HeardRequest hear(std::span<const std::uint8_t> pdu) noexcept {
    HeardRequest heard;
    auto& request = heard.request;
    request.function = pdu[0];
    const auto refuse = [&](Exception exception) {
        heard.exception = exception;
        return heard;
    };
    const auto known = std::ranges::find(functions, pdu[0], &Function::code);
    if (known == functions.end()) return refuse(Exception::illegal_function);
    if (pdu.size() < plain_bytes) return refuse(Exception::illegal_value);
    request.table = known->table;
    request.address = word_at(pdu, 1);
    request.writes = known->form != Function::Form::read;
    const auto second = word_at(pdu, 3);
    request.count = known->form == Function::Form::single ? std::uint16_t{1} : second;
    if (request.count < 1 || request.count > known->most) return refuse(Exception::illegal_value);
    switch (known->form) {
        case Function::Form::read:
            if (pdu.size() != plain_bytes) return refuse(Exception::illegal_value);
            break;
        case Function::Form::single:
            if (pdu.size() != plain_bytes) return refuse(Exception::illegal_value);
            if (request.table == Table::coil && second != 0x0000 && second != 0xFF00) return refuse(Exception::illegal_value);
            request.values = pdu.subspan(3);
            break;
        case Function::Form::several: {
            const auto bytes = value_bytes(request.table, request.count);
            if (pdu.size() != plain_bytes + 1 + bytes || pdu[plain_bytes] != bytes) return refuse(Exception::illegal_value);
            request.values = pdu.subspan(plain_bytes + 1);
            break;
        }
    }
    if (std::uint32_t{request.address} + request.count > 0x10000) return refuse(Exception::illegal_address);
    return heard;
}

}  // namespace taktwerk::modbus::server
