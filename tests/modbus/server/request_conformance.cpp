// Requests, answers and exceptions as MODBUS Application Protocol Specification V1.1b3 prescribes them; frames by MODBUS Messaging on TCP/IP
// Implementation Guide V1.0b, chapter 3.1.3. PDUs are the specification's own examples where it has one.
#include <gmock/gmock.h>

#include "modbus/server/answer.hpp"
#include "modbus/server/request.hpp"

namespace taktwerk::modbus::server {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

Bytes bytes_of(const AnswerFrame& frame) { return {frame.span().begin(), frame.span().end()}; }
Bytes pdu_of(const AnswerFrame& frame) { return {frame.span().begin() + header_bytes, frame.span().end()}; }

ServedRegister served(Table table, std::uint16_t address, NumberType type = NumberType::uint16, bool writable = false) {
    ServedRegister r;
    r.table = table, r.address = address, r.type = is_bits(table) ? NumberType::boolean : type, r.writable = writable;
    return r;
}

/// `count` of a table from `address` on, and their values.
struct Offered {
    std::vector<ServedRegister> registers;
    ServedImage image;
    void add(Table table, std::uint16_t address, const std::vector<std::uint16_t>& words, bool writable = false) {
        for (std::size_t i = 0; i < words.size(); ++i) {
            registers.push_back(served(table, static_cast<std::uint16_t>(address + i), NumberType::uint16, writable));
            image.words.push_back({words[i], 0});
        }
    }
    /// Bits, lowest first, as the specification prints them.
    void add_bits(Table table, std::uint16_t address, const Bytes& packed, std::uint16_t count, bool writable = false) {
        std::vector<std::uint16_t> bits;
        for (std::uint16_t i = 0; i < count; ++i) bits.push_back(packed[i / 8u] >> (i % 8u) & 1u);
        add(table, address, bits, writable);
    }
};

Bytes read_answer(const Offered& offered, const Bytes& pdu) {
    const auto heard = hear(pdu);
    EXPECT_EQ(heard.exception, Exception::none);
    return pdu_of(answer_read(RegisterMap{offered.registers}, offered.image, {1, 1, pdu[0]}, heard.request).frame);
}

TEST(ModbusServerConformance, ReadCoils_6_1) {
    Offered offered;
    offered.add_bits(Table::coil, 0x13, {0xCD, 0x6B, 0x05}, 19);
    EXPECT_THAT(read_answer(offered, {0x01, 0x00, 0x13, 0x00, 0x13}), ElementsAre(0x01, 0x03, 0xCD, 0x6B, 0x05));
}

TEST(ModbusServerConformance, ReadDiscreteInputs_6_2) {
    Offered offered;
    offered.add_bits(Table::discrete_input, 0xC4, {0xAC, 0xDB, 0x35}, 22);
    EXPECT_THAT(read_answer(offered, {0x02, 0x00, 0xC4, 0x00, 0x16}), ElementsAre(0x02, 0x03, 0xAC, 0xDB, 0x35));
}

TEST(ModbusServerConformance, ReadHoldingRegisters_6_3) {
    Offered offered;
    offered.add(Table::holding, 0x6B, {0x022B, 0x0000, 0x0064});
    EXPECT_THAT(read_answer(offered, {0x03, 0x00, 0x6B, 0x00, 0x03}), ElementsAre(0x03, 0x06, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64));
}

TEST(ModbusServerConformance, ReadInputRegisters_6_4) {
    Offered offered;
    offered.add(Table::input, 0x08, {0x000A});
    EXPECT_THAT(read_answer(offered, {0x04, 0x00, 0x08, 0x00, 0x01}), ElementsAre(0x04, 0x02, 0x00, 0x0A));
}

/// What a write asks for, as numbers by address; and what is answered when it is done.
struct Written {
    Exception exception = Exception::none;
    std::vector<double> numbers;
    Bytes answer;
};
Written write(const Offered& offered, const Bytes& pdu) {
    const auto heard = hear(pdu);
    EXPECT_EQ(heard.exception, Exception::none);
    EXPECT_TRUE(heard.request.writes);
    const auto asked = changes_of(RegisterMap{offered.registers}, heard.request);
    Written out{asked.exception, {}, pdu_of(written({1, 1, pdu[0]}, heard.request))};
    for (const auto& change : asked.changes) out.numbers.push_back(change.number);
    return out;
}

TEST(ModbusServerConformance, WriteSingleCoil_6_5) {
    Offered offered;
    offered.add(Table::coil, 0xAC, {0}, true);
    const auto on = write(offered, {0x05, 0x00, 0xAC, 0xFF, 0x00});
    EXPECT_THAT(on.numbers, ElementsAre(1));
    EXPECT_THAT(on.answer, ElementsAre(0x05, 0x00, 0xAC, 0xFF, 0x00));
    EXPECT_THAT(write(offered, {0x05, 0x00, 0xAC, 0x00, 0x00}).numbers, ElementsAre(0));
}

TEST(ModbusServerConformance, WriteSingleRegister_6_6) {
    Offered offered;
    offered.add(Table::holding, 0x01, {0}, true);
    const auto done = write(offered, {0x06, 0x00, 0x01, 0x00, 0x03});
    EXPECT_THAT(done.numbers, ElementsAre(3));
    EXPECT_THAT(done.answer, ElementsAre(0x06, 0x00, 0x01, 0x00, 0x03));
}

TEST(ModbusServerConformance, WriteMultipleCoils_6_11) {
    Offered offered;
    offered.add_bits(Table::coil, 0x13, {0, 0}, 10, true);
    const auto done = write(offered, {0x0F, 0x00, 0x13, 0x00, 0x0A, 0x02, 0xCD, 0x01});
    EXPECT_THAT(done.numbers, ElementsAre(1, 0, 1, 1, 0, 0, 1, 1, 1, 0));
    EXPECT_THAT(done.answer, ElementsAre(0x0F, 0x00, 0x13, 0x00, 0x0A));
}

TEST(ModbusServerConformance, WriteMultipleRegisters_6_12) {
    Offered offered;
    offered.add(Table::holding, 0x01, {0, 0}, true);
    const auto done = write(offered, {0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0A, 0x01, 0x02});
    EXPECT_THAT(done.numbers, ElementsAre(0x0A, 0x0102));
    EXPECT_THAT(done.answer, ElementsAre(0x10, 0x00, 0x01, 0x00, 0x02));
}

// --- exceptions, chapter 7 ------------------------------------------------------------------------------------------------------------

TEST(ModbusServerConformance, Exception01ForEveryFunctionThatIsNotThere) {
    for (int function = 0; function <= 255; ++function) {
        const bool known = (function >= 1 && function <= 6) || function == 15 || function == 16;
        const Bytes pdu{static_cast<std::uint8_t>(function), 0, 0, 0, 1};
        EXPECT_EQ(hear(pdu).exception == Exception::illegal_function, !known) << function;
    }
    EXPECT_THAT(bytes_of(refusal({0x1234, 7, 0x2B}, Exception::illegal_function)), ElementsAre(0x12, 0x34, 0, 0, 0, 3, 7, 0xAB, 1));
}

struct Bad {
    const char* why;
    Bytes pdu;
};
class Exception03 : public testing::TestWithParam<Bad> {};
TEST_P(Exception03, ForAQuantityALengthOrACoilsValueThatTheFunctionDoesNotHave) {
    EXPECT_EQ(hear(GetParam().pdu).exception, Exception::illegal_value) << GetParam().why;
}
Bytes several(std::uint8_t function, std::uint16_t count, std::uint8_t announced, std::size_t bytes) {
    Bytes pdu{function, 0, 0, static_cast<std::uint8_t>(count >> 8), static_cast<std::uint8_t>(count & 0xFF), announced};
    pdu.insert(pdu.end(), bytes, 0);
    return pdu;
}
INSTANTIATE_TEST_SUITE_P(
    ModbusServerConformance, Exception03,
    testing::Values(Bad{"no coil", {1, 0, 0, 0, 0}}, Bad{"2001 coils", {1, 0, 0, 0x07, 0xD1}},
                    Bad{"2001 discrete inputs", {2, 0, 0, 0x07, 0xD1}}, Bad{"no register", {3, 0, 0, 0, 0}},
                    Bad{"126 registers", {3, 0, 0, 0, 126}}, Bad{"126 input registers", {4, 0, 0, 0, 126}},
                    Bad{"a coil neither on nor off", {5, 0, 0, 0x12, 0x34}}, Bad{"a coil half on", {5, 0, 0, 0xFF, 0x01}},
                    Bad{"function alone", {3}}, Bad{"too short", {3, 0, 0, 0}}, Bad{"too long", {3, 0, 0, 0, 1, 0}},
                    Bad{"a value too much", {6, 0, 0, 0, 1, 0}}, Bad{"no registers written", several(16, 0, 0, 0)},
                    Bad{"124 registers written", several(16, 124, 248, 248)}, Bad{"a byte is missing", several(16, 2, 4, 3)},
                    Bad{"a byte too much", several(16, 2, 4, 5)}, Bad{"another byte count", several(16, 2, 2, 4)},
                    Bad{"no byte count", {16, 0, 0, 0, 1}}, Bad{"no coils written", several(15, 0, 0, 0)},
                    Bad{"1969 coils written", several(15, 1969, 247, 247)}, Bad{"too few bytes of coils", several(15, 9, 1, 1)}));

TEST(ModbusServerConformance, TheLargestQuantitiesAreTaken) {
    EXPECT_EQ(hear(Bytes{1, 0, 0, 0x07, 0xD0}).exception, Exception::none);
    EXPECT_EQ(hear(Bytes{3, 0, 0, 0, 125}).exception, Exception::none);
    EXPECT_EQ(hear(several(16, 123, 246, 246)).exception, Exception::none);
    EXPECT_EQ(hear(several(15, 1968, 246, 246)).exception, Exception::none);
}

TEST(ModbusServerConformance, Exception02BeyondTheLastAddress) {
    EXPECT_EQ(hear(Bytes{3, 0xFF, 0xFF, 0, 2}).exception, Exception::illegal_address);
    EXPECT_EQ(hear(Bytes{3, 0xFF, 0xFF, 0, 1}).exception, Exception::none);
    EXPECT_EQ(hear(Bytes{1, 0xFF, 0xF0, 0, 17}).exception, Exception::illegal_address);
}

TEST(ModbusServerConformance, Exception02WhereOneOfTheAddressesIsNotOffered) {
    Offered offered;
    offered.add(Table::holding, 10, {1, 2}, true);
    offered.add(Table::holding, 13, {3}, true);
    const RegisterMap map{offered.registers};
    const auto across = answer_read(map, offered.image, {9, 1, 3}, hear(Bytes{3, 0, 10, 0, 4}).request);
    EXPECT_EQ(across.exception, Exception::illegal_address);
    EXPECT_THAT(bytes_of(across.frame), ElementsAre(0, 9, 0, 0, 0, 3, 1, 0x83, 2));
    EXPECT_EQ(write(offered, several(16, 4, 8, 8)).exception, Exception::illegal_address);
}

TEST(ModbusServerConformance, Exception02WhereARegisterMayNotBeWritten) {
    Offered offered;
    offered.add(Table::holding, 0, {1}, true);
    offered.add(Table::holding, 1, {2}, false);
    EXPECT_EQ(write(offered, {6, 0, 1, 0, 5}).exception, Exception::illegal_address);
    const auto both = write(offered, several(16, 2, 4, 4));
    EXPECT_EQ(both.exception, Exception::illegal_address);
    EXPECT_TRUE(both.numbers.empty()) << "nothing of it is done";
    EXPECT_EQ(write(offered, {6, 0, 0, 0, 5}).exception, Exception::none);
}

TEST(ModbusServerConformance, Exception03ForARealNumberThatIsNone) {
    Offered offered;
    offered.registers = {served(Table::holding, 0, NumberType::float32, true)};
    EXPECT_EQ(write(offered, {16, 0, 0, 0, 2, 4, 0x7F, 0xC0, 0, 0}).exception, Exception::illegal_value) << "NaN";
    EXPECT_EQ(write(offered, {16, 0, 0, 0, 2, 4, 0xFF, 0x80, 0, 0}).exception, Exception::illegal_value) << "- infinity";
    EXPECT_THAT(write(offered, {16, 0, 0, 0, 2, 4, 0xC1, 0x48, 0, 0}).numbers, ElementsAre(-12.5));
}

TEST(ModbusServerConformance, BitsOfOneRegisterAreReadTogether) {
    Offered offered;
    for (const auto bit : Bytes{15, 9, 0}) {
        auto r = served(Table::input, 3, NumberType::boolean);
        r.bit = bit;
        offered.registers.push_back(r);
        offered.image.words.push_back(words_of(r, bit == 9 ? 0 : 1));
    }
    EXPECT_THAT(read_answer(offered, {4, 0, 3, 0, 1}), ElementsAre(4, 2, 0x80, 0x01));
}

// --- frames ---------------------------------------------------------------------------------------------------------------------------

TEST(ModbusServerFrames, AFrameIsItsHeaderAndAsManyBytesAsItSays) {
    const Bytes two{0x15, 0x01, 0, 0, 0, 6, 0xFF, 3, 0, 4, 0, 1, 0x15, 0x02};
    const auto frame = frame_of(two);
    ASSERT_EQ(frame.state, Frame::State::whole);
    EXPECT_EQ(frame.transaction, 0x1501);
    EXPECT_EQ(frame.unit, 0xFF);
    EXPECT_EQ(frame.bytes, 12u);
    EXPECT_THAT(Bytes(frame.pdu.begin(), frame.pdu.end()), ElementsAre(3, 0, 4, 0, 1));
    for (std::size_t size = 0; size < 12; ++size) EXPECT_EQ(frame_of(std::span(two).first(size)).state, Frame::State::incomplete) << size;
}

TEST(ModbusServerFrames, AnotherProtocolOrALengthThatNoFrameHasIsBroken) {
    EXPECT_EQ(frame_of(Bytes{'G', 'E', 'T', ' '}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 1}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 1}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 0, 0, 1}).state, Frame::State::broken) << "a unit alone";
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 0, 0, 0}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 0, 0, 255}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 0, 0xFF, 2}).state, Frame::State::broken);
    EXPECT_EQ(frame_of(Bytes{0, 1, 0, 0, 0, 254}).state, Frame::State::incomplete);
}

TEST(ModbusServerFrames, TheLargestAnswerFits) {
    Offered offered;
    offered.add(Table::holding, 0, std::vector<std::uint16_t>(125, 0xABCD));
    const auto answer = read_answer(offered, {3, 0, 0, 0, 125});
    EXPECT_EQ(answer.size(), 252u);
    EXPECT_EQ(answer[1], 250);
    EXPECT_EQ(answer[251], 0xCD);
    Offered coils;
    coils.add(Table::coil, 0, std::vector<std::uint16_t>(2000, 1));
    const auto bits = read_answer(coils, {1, 0, 0, 0x07, 0xD0});
    EXPECT_EQ(bits.size(), 252u);
    EXPECT_THAT(Bytes(bits.begin() + 2, bits.end()), ElementsAreArray(Bytes(250, 0xFF)));
}

}  // namespace
}  // namespace taktwerk::modbus::server
