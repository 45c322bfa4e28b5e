// What a parser does with bytes that are no frame of ours.

#include <gtest/gtest.h>

#include <vector>

#include "modbus/wire/crc.hpp"
#include "modbus/wire/frame.hpp"

namespace taktwerk::modbus {
namespace {

std::vector<std::byte> with_crc(std::initializer_list<int> body) {
    std::vector<std::byte> frame;
    for (const int b : body) frame.push_back(static_cast<std::byte>(b));
    const auto crc = crc16(frame);
    frame.push_back(static_cast<std::byte>(crc & 0xFF));
    frame.push_back(static_cast<std::byte>(crc >> 8));
    return frame;
}

TEST(ModbusRequest, EveryDamagedBitIsNoticed) {
    const auto frame = encode(write_parameter(1, 138, 100));
    for (std::size_t bit = 0; bit < frame.size * 8; ++bit) {
        auto damaged = frame;
        damaged.bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        EXPECT_EQ(parse_request(damaged.span()).error, WireError::wrong_crc) << "bit " << bit;
    }
}

TEST(ModbusRequest, UnknownFunctionKeepsTheStationForAnException) {
    const auto heard = parse_request(with_crc({7, 0x05, 0, 0, 0xFF, 0}));
    EXPECT_EQ(heard.error, WireError::unknown_function);
    EXPECT_EQ(heard.station, 7);
    EXPECT_EQ(heard.function_byte, 5);
}

TEST(ModbusRequest, LengthAndCountsMustAgree) {
    EXPECT_EQ(parse_request(with_crc({1, 0x03, 0, 0, 0})).error, WireError::wrong_length);
    EXPECT_EQ(parse_request(with_crc({1, 0x08, 0, 0, 0x12, 0x34})).error,
              WireError::wrong_length);  // with the sub-function of the standard
    EXPECT_EQ(parse_request(with_crc({1, 0x10, 0, 0, 0, 2, 2, 0, 0})).error, WireError::wrong_count);
    EXPECT_EQ(parse_request(with_crc({1, 0x10, 0, 0, 0, 0, 0})).error, WireError::wrong_count);
    EXPECT_EQ(parse_request(with_crc({1})).error, WireError::too_short);
}

TEST(ModbusResponse, OnlyTheAnswerToTheQuestionCounts) {
    const auto request = read_status(1, 5, 2);
    Response response;
    const std::uint16_t words[] = {1, 2}, more[] = {1, 2, 3};
    EXPECT_EQ(parse_response(encode_response(request, more).span(), request, response), WireError::wrong_answer);
    EXPECT_EQ(parse_response(encode_response(read_status(2, 5, 2), words).span(), request, response), WireError::wrong_station);
    EXPECT_EQ(parse_response(encode_response(read_parameters(1, 5, 2), words).span(), request, response), WireError::wrong_answer);
    EXPECT_EQ(parse_response(encode_response(request, words).span(), request, response), WireError::none);
    // An echo with another value is no echo.
    EXPECT_EQ(parse_response(encode(write_parameter(1, 138, 101)).span(), write_parameter(1, 138, 100), response), WireError::wrong_answer);
    EXPECT_EQ(parse_response(encode(servo(1, servo_off)).span(), servo(1, servo_on), response), WireError::wrong_answer);
}

TEST(ModbusResponse, AnExceptionWithoutCodeIsNone) {
    Response response;
    EXPECT_EQ(parse_response(with_crc({1, 0x84, 0}), read_status(1, 0, 1), response), WireError::wrong_answer);
}

}  // namespace
}  // namespace taktwerk::modbus
