// The XP200's frames byte for byte. The manual (V1.0, sections 9.3 and 9.6) prints the bodies and leaves the CRC open ("CRC_Lo, CRC_Hi"); the
// CRCs here follow from its algorithm of 9.3 and were calculated apart from this code. The one CRC it prints is wrong, as shown below.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "modbus/wire/crc.hpp"
#include "modbus/wire/frame.hpp"

namespace taktwerk::modbus {
namespace {

std::vector<std::byte> bytes(std::string_view hex) {
    std::vector<std::byte> out;
    for (std::size_t i = 0; i + 1 < hex.size();) {
        if (hex[i] == ' ') {
            ++i;
            continue;
        }
        out.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
        i += 2;
    }
    return out;
}

std::string hex(std::span<const std::byte> frame) {
    std::string out;
    constexpr std::string_view digits = "0123456789ABCDEF";
    for (const auto b : frame) {
        if (!out.empty()) out += ' ';
        out += digits[std::to_integer<unsigned>(b) >> 4];
        out += digits[std::to_integer<unsigned>(b) & 15];
    }
    return out;
}

struct RequestRow {
    const char* section;
    Request request;
    const char* wire;
};

std::vector<RequestRow> requests() {
    const std::uint16_t several[] = {0x0064, 0xFF9C};
    return {
        {"9.6.1 format", read_status(1, 0, 1), "01 04 00 00 00 01 31 CA"},
        {"9.6.1 example: raw position command", read_status(1, 1, 2), "01 04 00 01 00 02 20 0B"},
        {"9.5: actual position", read_status(1, 5, 2), "01 04 00 05 00 02 61 CA"},
        {"9.6.1: eight words, the most", read_status(1, 5, 8), "01 04 00 05 00 08 E1 CD"},
        {"9.5: alarm code and speed", read_status(1, 0x1A, 2), "01 04 00 1A 00 02 50 0C"},
        {"9.5: DI and DO", read_status(1, 0x12, 2), "01 04 00 12 00 02 D1 CE"},
        {"9.5: single-turn position", read_status(1, 0x14, 2), "01 04 00 14 00 02 31 CF"},
        {"9.6.1: nine words, to be refused", read_status(1, 0, 9), "01 04 00 00 00 09 30 0C"},
        {"9.5: past the status area, to be refused", read_status(1, 0x28, 1), "01 04 00 28 00 01 B1 C2"},
        {"9.6.2 format", read_parameters(1, 0, 1), "01 03 00 00 00 01 84 0A"},
        {"9.6.2 example: Pr001, Pr002", read_parameters(1, 1, 2), "01 03 00 01 00 02 95 CB"},
        {"9.3 example with the right CRC: Pr005, Pr006", read_parameters(1, 5, 2), "01 03 00 05 00 02 D4 0A"},
        {"9.4: Pr005 alone", read_parameters(1, 5, 1), "01 03 00 05 00 01 94 0B"},
        {"9.5: actual position by function 03h", read_parameters(1, 0x1005, 2), "01 03 10 05 00 02 D0 CA"},
        {"9.6.3 format", write_parameter(1, 0, 100), "01 06 00 00 00 64 88 21"},
        {"9.6.3 example", write_parameter(1, 1, 0x0102), "01 06 00 01 01 02 58 5B"},
        {"5.4.1 Pr098: forced enable", write_parameter(1, 98, 1), "01 06 00 62 00 01 E9 D4"},
        {"5.4.1 Pr098: off", write_parameter(1, 98, 0), "01 06 00 62 00 00 28 14"},
        {"5.4.2 Pr120: SON, 00010", write_parameter(1, 120, 10), "01 06 00 78 00 0A 89 D4"},
        {"5.4.2 Pr120: ACLR, 00100", write_parameter(1, 120, 100), "01 06 00 78 00 64 08 38"},
        {"5.4.2 Pr121: ZCLAMP, 00100", write_parameter(1, 121, 100), "01 06 00 79 00 64 59 F8"},
        {"5.4.2 Pr121: CZERO, 01000", write_parameter(1, 121, 1000), "01 06 00 79 03 E8 58 AD"},
        {"5.4.2 Pr122: SP1", write_parameter(1, 122, 1), "01 06 00 7A 00 01 69 D3"},
        {"5.4.2 Pr122: SP2", write_parameter(1, 122, 10), "01 06 00 7A 00 0A 28 14"},
        {"5.4.2 Pr122: none", write_parameter(1, 122, 0), "01 06 00 7A 00 00 A8 13"},
        {"5.4.2 Pr138: +100 r/min", write_parameter(1, 138, 100), "01 06 00 8A 00 64 A9 CB"},
        {"5.4.2 Pr139: -100 r/min", write_parameter(1, 139, 0xFF9C), "01 06 00 8B FF 9C B8 79"},
        {"9.6.4: two words", write_parameters(1, 138, several), "01 10 00 8A 00 02 04 00 64 FF 9C 7B F6"},
        {"9.6.5", diagnose(1, 0x1234), "01 08 12 34 8D 6D"},
        {"9.6.5 text: ABCDh", diagnose(1, 0xABCD), "01 08 AB CD 3E BF"},
        {"9.6.6", save(1), "01 41 C0 10"},
        {"9.6.7 enable", servo(1, servo_on), "01 42 55 D0 9F"},
        {"9.6.7 disable", servo(1, servo_off), "01 42 AA 90 DF"},
        {"9.6.8", clear_alarm(1), "01 43 41 D1"},
    };
}

TEST(Xp200Frames, RequestsAreThoseOfTheManual) {
    for (const auto& row : requests()) EXPECT_EQ(hex(encode(row.request).span()), row.wire) << row.section;
}

TEST(Xp200Frames, AHeardRequestIsTheOneThatWasSent) {
    for (const auto& row : requests()) {
        const auto frame = bytes(row.wire);
        const auto heard = parse_request(frame);
        ASSERT_EQ(heard.error, WireError::none) << row.section;
        EXPECT_EQ(heard.request.station, 1) << row.section;
        EXPECT_EQ(heard.request.function, row.request.function) << row.section;
        EXPECT_EQ(heard.request.address, row.request.address) << row.section;
        EXPECT_EQ(heard.request.count, row.request.count) << row.section;
        EXPECT_EQ(heard.request.data, row.request.data) << row.section;
        EXPECT_EQ(heard.request.words, row.request.words) << row.section;
    }
}

// Manual 9.3: "address 16 (decimal): ADR = 10h".
TEST(Xp200Frames, StationIsTheFirstByte) { EXPECT_EQ(std::to_integer<int>(encode(clear_alarm(16)).bytes[0]), 0x10); }

// Manual 9.6: what is written, enabled, saved or asked for an echo comes back as it was; 10h without its values.
TEST(Xp200Frames, EchoesAndShortAnswers) {
    const std::uint16_t two[] = {1, 2};
    struct Row {
        Request request;
        const char* answer;
    };
    const Row rows[] = {
        {write_parameter(1, 0, 100), "01 06 00 00 00 64 88 21"},
        {write_parameters(1, 0, two), "01 10 00 00 00 02 41 C8"},
        {write_parameters(1, 1, two), "01 10 00 01 00 02 10 08"},
        {diagnose(1, 0x1234), "01 08 12 34 8D 6D"},
        {save(1), "01 41 C0 10"},
        {servo(1, servo_on), "01 42 55 D0 9F"},
        {servo(1, servo_off), "01 42 AA 90 DF"},
        {clear_alarm(1), "01 43 41 D1"},
    };
    for (const auto& row : rows) {
        EXPECT_EQ(hex(encode_response(row.request, {}).span()), row.answer);
        Response response;
        EXPECT_EQ(parse_response(bytes(row.answer), row.request, response), WireError::none) << row.answer;
        EXPECT_EQ(response.exception, ExceptionCode::none);
    }
}

// Manual 9.5: the low word stands at the lower address, the high byte of a word first. 0001 86A0h = 100000.
TEST(Xp200Frames, WordsOfAReading) {
    const auto request = read_status(1, 5, 2);
    const std::uint16_t words[] = {0x86A0, 0x0001};
    const auto frame = encode_response(request, words);
    EXPECT_EQ(hex(frame.span()).substr(0, 20), "01 04 04 86 A0 00 01");
    Response response;
    ASSERT_EQ(parse_response(frame.span(), request, response), WireError::none);
    ASSERT_EQ(response.count, 2);
    EXPECT_EQ(response.words[0], 0x86A0);
    EXPECT_EQ(response.words[1], 0x0001);
}

// Manual 9.3, 9.6: ADR, function + 80h, code, CRC.
TEST(Xp200Frames, Exceptions) {
    const Request asked[] = {read_parameters(1, 0, 1), read_status(1, 0, 1), write_parameter(1, 0, 0), write_parameters(1, 0, {}), save(1),
                             servo(1, servo_on),       clear_alarm(1)};
    const char* wire[][4] = {
        {"01 83 01 80 F0", "01 83 02 C0 F1", "01 83 03 01 31", "01 83 04 40 F3"},
        {"01 84 01 82 C0", "01 84 02 C2 C1", "01 84 03 03 01", "01 84 04 42 C3"},
        {"01 86 01 83 A0", "01 86 02 C3 A1", "01 86 03 02 61", "01 86 04 43 A3"},
        {"01 90 01 8D C0", "01 90 02 CD C1", "01 90 03 0C 01", "01 90 04 4D C3"},
        {"01 C1 01 B0 50", "01 C1 02 F0 51", "01 C1 03 31 91", "01 C1 04 70 53"},
        {"01 C2 01 B0 A0", "01 C2 02 F0 A1", "01 C2 03 31 61", "01 C2 04 70 A3"},
        {"01 C3 01 B1 30", "01 C3 02 F1 31", "01 C3 03 30 F1", "01 C3 04 71 33"},
    };
    for (std::size_t f = 0; f < std::size(asked); ++f)
        for (int code = 1; code <= 4; ++code) {
            const auto frame = encode_exception(1, static_cast<std::uint8_t>(asked[f].function), static_cast<ExceptionCode>(code));
            EXPECT_EQ(hex(frame.span()), wire[f][code - 1]);
            Response response;
            EXPECT_EQ(parse_response(frame.span(), asked[f], response), WireError::none);
            EXPECT_EQ(static_cast<int>(response.exception), code);
        }
}

// The manual's one printed CRC: "01 03 00 05 00 02 94 37, the register holds 3794h" (9.3). Its own steps give 0AD4h; 3794h is the CRC of the
// same request to address 0101h, which an older product must have had. The steps count.
TEST(Xp200Frames, ThePrintedCrcIsWrong) {
    EXPECT_EQ(crc16(bytes("01 03 00 05 00 02")), 0x0AD4);
    EXPECT_EQ(crc16(bytes("01 03 01 01 00 02")), 0x3794);
    EXPECT_EQ(parse_request(bytes("01 03 00 05 00 02 94 37")).error, WireError::wrong_crc);
}

// Manual 9.6: every length of the table, from the first bytes alone.
TEST(Xp200Frames, LengthsFollowFromTheFirstBytes) {
    const auto length = [](Direction direction, std::string_view text) {
        const auto found = frame_length(direction, bytes(text));
        return found.known == LengthKnown::yes ? static_cast<int>(found.bytes) : found.known == LengthKnown::not_yet ? -1 : -2;
    };
    EXPECT_EQ(length(Direction::request, "01 03"), 8);
    EXPECT_EQ(length(Direction::request, "01 04"), 8);
    EXPECT_EQ(length(Direction::request, "01 06"), 8);
    EXPECT_EQ(length(Direction::request, "01 08"), 6);
    EXPECT_EQ(length(Direction::request, "01 10 00 00 00 02"), -1);
    EXPECT_EQ(length(Direction::request, "01 10 00 00 00 02 04"), 13);
    EXPECT_EQ(length(Direction::request, "01 41"), 4);
    EXPECT_EQ(length(Direction::request, "01 42"), 5);
    EXPECT_EQ(length(Direction::request, "01 43"), 4);
    EXPECT_EQ(length(Direction::request, "01 05"), -2);
    EXPECT_EQ(length(Direction::response, "01 03"), -1);
    EXPECT_EQ(length(Direction::response, "01 03 02"), 7);
    EXPECT_EQ(length(Direction::response, "01 04 10"), 21);
    EXPECT_EQ(length(Direction::response, "01 06"), 8);
    EXPECT_EQ(length(Direction::response, "01 08"), 6);
    EXPECT_EQ(length(Direction::response, "01 10"), 8);
    EXPECT_EQ(length(Direction::response, "01 41"), 4);
    EXPECT_EQ(length(Direction::response, "01 42"), 5);
    EXPECT_EQ(length(Direction::response, "01 43"), 4);
    EXPECT_EQ(length(Direction::response, "01 84"), 5);
    EXPECT_EQ(length(Direction::response, "01"), -1);
}

}  // namespace
}  // namespace taktwerk::modbus
