// What is kept, by name and type: every number comes back as it was, an edited program finds what it still has, and what does not fit is told.

#include "runtime/retain/kept_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "fb_library/iec/counters.hpp"
#include "fb_library/iec/timers.hpp"
#include "runtime/retain/kept_text.hpp"
#include "runtime/retain/value_type.hpp"

namespace taktwerk::runtime {
namespace {

using fb::PinKind;
using What = RetainNote::What;

constexpr PinKind every_type[] = {PinKind::BOOL,  PinKind::SINT, PinKind::INT,   PinKind::DINT,  PinKind::LINT,
                                  PinKind::USINT, PinKind::UINT, PinKind::UDINT, PinKind::ULINT, PinKind::REAL,
                                  PinKind::LREAL, PinKind::WORD, PinKind::DWORD, PinKind::TIME,  PinKind::ENUM};

std::uint64_t drawn(std::mt19937_64& random, PinKind type) {
    if (type == PinKind::BOOL) return random() & 1;
    const auto bytes = size_of(type);
    return bytes == 8 ? random() : random() & ((std::uint64_t{1} << (8 * bytes)) - 1);
}
double number(std::uint64_t bits) { return std::bit_cast<double>(bits); }

TEST(ValueType, TextReadsBackAsTheVeryBits) {
    std::mt19937_64 random{5};
    for (const auto type : every_type) {
        EXPECT_EQ(find_type(word(type)), type);
        for (int i = 0; i < 2000; ++i) {
            const auto bits = drawn(random, type);
            const auto back = bits_of(type, text_of(type, bits));
            ASSERT_TRUE(back) << word(type) << ' ' << bits;
            if (type == PinKind::LREAL && std::isnan(number(bits))) EXPECT_TRUE(std::isnan(number(*back)));
            else if (type == PinKind::REAL && std::isnan(std::bit_cast<float>(static_cast<std::uint32_t>(bits))))
                EXPECT_TRUE(std::isnan(std::bit_cast<float>(static_cast<std::uint32_t>(*back))));
            else EXPECT_EQ(*back, bits) << word(type) << ' ' << text_of(type, bits);
        }
    }
}

// IEC 61131-3 ed. 3, table 10: ranges of the elementary types.
TEST(ValueType, ConvertsWhatTheOtherTypeHoldsAndNothingElse) {
    const auto from_dint = [](std::int32_t value, PinKind to) { return converted(PinKind::DINT, static_cast<std::uint32_t>(value), to); };
    EXPECT_EQ(from_dint(-5, PinKind::LINT)->bits, static_cast<std::uint64_t>(-5));
    EXPECT_EQ(number(from_dint(-5, PinKind::LREAL)->bits), -5.0);
    EXPECT_EQ(from_dint(127, PinKind::SINT)->bits, 127u);
    EXPECT_FALSE(from_dint(128, PinKind::SINT));
    EXPECT_EQ(from_dint(-128, PinKind::SINT)->bits, 0x80u);
    EXPECT_FALSE(from_dint(-1, PinKind::UDINT));
    EXPECT_FALSE(from_dint(65536, PinKind::UINT));
    EXPECT_EQ(from_dint(1, PinKind::BOOL)->bits, 1u);
    EXPECT_FALSE(from_dint(2, PinKind::BOOL));
    EXPECT_FALSE(from_dint(5, PinKind::TIME)) << "5 of what?";
    EXPECT_FALSE(from_dint(1, PinKind::ENUM));
    const auto from_lreal = [](double value, PinKind to) { return converted(PinKind::LREAL, std::bit_cast<std::uint64_t>(value), to); };
    EXPECT_EQ(from_lreal(-3, PinKind::INT)->bits, 0xFFFDu);
    EXPECT_FALSE(from_lreal(2.5, PinKind::INT));
    EXPECT_FALSE(from_lreal(std::numeric_limits<double>::quiet_NaN(), PinKind::LINT));
    EXPECT_FALSE(from_lreal(9223372036854775808.0, PinKind::LINT)) << "2^63";
    EXPECT_EQ(from_lreal(-9223372036854775808.0, PinKind::LINT)->bits, std::uint64_t{1} << 63);
    EXPECT_TRUE(from_lreal(0.1, PinKind::REAL)->rounded);
    EXPECT_FALSE(from_lreal(0.5, PinKind::REAL)->rounded);
    EXPECT_FALSE(from_lreal(1e300, PinKind::REAL)) << "infinite";
    EXPECT_FALSE(from_lreal(1e-300, PinKind::REAL)) << "nothing";
    EXPECT_EQ(number(converted(PinKind::LINT, std::uint64_t{1} << 53, PinKind::LREAL)->bits), 9007199254740992.0);
    EXPECT_FALSE(converted(PinKind::LINT, (std::uint64_t{1} << 53) + 1, PinKind::LREAL)) << "a count stays itself or is none";
}

TEST(KeptText, WhatIsWrittenIsReadTheSame) {
    std::mt19937_64 random{7};
    Kept kept;
    kept.number = 17;
    for (const auto type : every_type)
        for (int i = 0; i < 20; ++i) {
            auto bits = drawn(random, type);
            if (std::isnan(number(bits)) || std::isnan(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))) bits = 0;
            kept.values.push_back(
                {"cell." + std::string(word(type)) + "[" + std::to_string(i) + "]", RetainKind(i % 2), type, bits, std::uint16_t(i)});
        }
    kept.values.push_back({"零件 100%\n#1", RetainKind::persistent, PinKind::LINT, 5, 0});
    kept.blocks.push_back({"cell.count", RetainKind::retain, "CTU", 0xFEDCBA9876543210, {std::byte{0}, std::byte{255}, std::byte{16}}, 3});
    kept.parameters.push_back({"cell.speed", std::nextafter(0.1, 1), 200, 0});
    const auto text = text_of(kept);
    const auto back = kept_of(text);
    ASSERT_TRUE(back) << text;
    EXPECT_EQ(back->number, kept.number);
    EXPECT_EQ(back->values, kept.values);
    EXPECT_EQ(back->blocks, kept.blocks);
    EXPECT_EQ(back->parameters, kept.parameters);
    EXPECT_EQ(text_of(*back), text);
    for (std::size_t at = 0; at < text.size(); ++at) {  // whatever bit flips
        auto altered = text;
        altered[at] = static_cast<char>(altered[at] ^ (1 << (at % 8)));
        ASSERT_FALSE(kept_of(altered)) << at;
        ASSERT_FALSE(kept_of(std::string_view(text).substr(0, at))) << at;
    }
}

/// A program as the keeper sees it: places by name.
struct Items {
    std::vector<RetainedItem> items;
    template <class T>
    void add(std::string name, T& v, RetainKind kind = RetainKind::retain) {
        items.push_back({std::move(name), kind, fb::PinTypeOf<T>::value.kind, nullptr, &v, sizeof v, 0, RetainedItem::no_task});
    }
    template <class Block>
    void add_block(std::string name, Block& block, RetainKind kind = RetainKind::retain) {
        static constexpr auto type = fb::block_type<Block>();
        items.push_back({std::move(name), kind, PinKind::LREAL, &type, &block, sizeof block, 0, RetainedItem::no_task});
    }
    [[nodiscard]] std::vector<std::byte> image() const {
        std::vector<std::byte> bytes;
        for (const auto& item : items) {
            const auto* begin = static_cast<const std::byte*>(item.address);
            bytes.insert(bytes.end(), begin, begin + item.size);
        }
        return bytes;
    }
};
struct Restored {
    std::vector<RetainNote> notes;
    Kept written;  // at once afterwards
    std::vector<double> parameters;
    [[nodiscard]] const RetainNote* of(std::string_view name) const {
        for (const auto& note : notes)
            if (note.name == name) return &note;
        return nullptr;
    }
};
Restored restore(Items& program, const Kept& kept, RetainStart start = RetainStart::warm,
                 std::vector<MachineLayout::ParameterInfo> infos = {}, std::vector<RetainBound> bounds = {}) {
    Restored out;
    for (const auto& info : infos) out.parameters.push_back(info.value);
    KeptValues values(program.items, infos);
    out.notes = values.restore(kept, start, out.parameters, bounds);
    values.write(program.image(), out.parameters, out.written);
    return out;
}

TEST(KeptValues, AnEditedProgramFindsWhatItStillHas) {
    std::int32_t pieces = 4711;
    double speed = 12.5;
    bool lamp = true;
    Items before;
    before.add("cell.pieces", pieces);
    before.add("cell.speed", speed);
    before.add("cell.lamp", lamp);
    const auto kept = restore(before, {}).written;

    std::int64_t more_pieces = 0;
    double also = 3;
    std::int16_t lamp_number = -1;
    Items after;
    after.add("cell.pieces", more_pieces);  // a larger type
    after.add("cell.also", also);           // new
    after.add("cell.lamp", lamp_number);
    const auto restored = restore(after, kept);
    EXPECT_EQ(more_pieces, 4711);
    EXPECT_EQ(also, 3);
    EXPECT_EQ(lamp_number, 1);
    EXPECT_EQ(restored.of("cell.pieces")->what, What::converted);
    EXPECT_THAT(restored.of("cell.pieces")->text, testing::AllOf(testing::HasSubstr("DINT 4711"), testing::HasSubstr("LINT")));
    EXPECT_EQ(restored.of("cell.also")->what, What::added);
    ASSERT_NE(restored.of("cell.speed"), nullptr);
    EXPECT_EQ(restored.of("cell.speed")->what, What::unclaimed);
    EXPECT_THAT(restored.of("cell.speed")->text, testing::HasSubstr("12.5"));

    // Back to the program of before: what only that one has was kept aside.
    pieces = 0, speed = 0, lamp = false;
    const auto back = restore(before, restored.written);
    EXPECT_EQ(speed, 12.5);
    EXPECT_EQ(pieces, 4711);
    EXPECT_TRUE(lamp);
    EXPECT_EQ(back.of("cell.speed")->what, What::kept);
}

TEST(KeptValues, WhatDoesNotFitIsToldAndBeginsAnew) {
    Kept kept;
    kept.values = {{"cell.count", RetainKind::retain, PinKind::LREAL, std::bit_cast<std::uint64_t>(2.5), 0}};
    std::int32_t count = 9;
    Items program;
    program.add("cell.count", count);
    const auto restored = restore(program, kept);
    EXPECT_EQ(count, 9);
    EXPECT_EQ(restored.of("cell.count")->what, What::refused);
    EXPECT_THAT(restored.of("cell.count")->text, testing::AllOf(testing::HasSubstr("2.5"), testing::HasSubstr("DINT")));
}

TEST(KeptValues, WhatPeopleMayWriteStaysInItsRange) {
    double speed = 100;
    MachineLayout::Variable info;
    info.writable = true;
    info.minimum = 10;
    info.maximum = 200;
    Items program;
    program.add("cell.speed", speed);
    Kept kept;
    kept.values = {{"cell.speed", RetainKind::retain, PinKind::LREAL, std::bit_cast<std::uint64_t>(250.0), 0}};
    EXPECT_EQ(restore(program, kept, RetainStart::warm, {}, {{&speed, &info}}).of("cell.speed")->what, What::refused);
    EXPECT_EQ(speed, 100);
    kept.values[0].bits = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(restore(program, kept, RetainStart::warm, {}, {{&speed, &info}}).of("cell.speed")->what, What::refused);
    kept.values[0].bits = std::bit_cast<std::uint64_t>(200.0);
    EXPECT_EQ(restore(program, kept, RetainStart::warm, {}, {{&speed, &info}}).of("cell.speed")->what, What::kept);
    EXPECT_EQ(speed, 200);
}

// IEC 61131-3 ed. 3, 6.5.6.2 (warm and cold restart); origin as CODESYS' reset: nothing at all.
TEST(KeptValues, ColdKeepsWhatIsPersistentOriginNothing) {
    for (const auto start : {RetainStart::warm, RetainStart::cold, RetainStart::origin}) {
        double a = 1, b = 2;
        Items program;
        program.add("cell.a", a, RetainKind::retain);
        program.add("cell.b", b, RetainKind::persistent);
        Kept kept;
        for (const auto* name : {"cell.a", "cell.b", "gone.c"})
            kept.values.push_back(
                {name, name[5] == 'b' ? RetainKind::persistent : RetainKind::retain, PinKind::LREAL, std::bit_cast<std::uint64_t>(7.0), 0});
        kept.parameters = {{"cell.speed", 180, 200, 0}};
        const auto restored = restore(program, kept, start, {{"cell", "speed", "", "", 0, 500, 200, false}});
        EXPECT_EQ(a, start == RetainStart::warm ? 7 : 1);
        EXPECT_EQ(b, start == RetainStart::origin ? 2 : 7);
        EXPECT_EQ(restored.parameters[0], start == RetainStart::origin ? 200 : 180);
        EXPECT_EQ(restored.written.values.size(), start == RetainStart::warm ? 3u : 2u) << "what is given up is not kept aside either";
    }
}

TEST(KeptValues, ParametersOfTheOperatorHoldUntilTheirConfigurationChanges) {
    Items none;
    const auto info = [](double configured, double maximum = 500) {
        return std::vector<MachineLayout::ParameterInfo>{{"cell", "speed", "mm/s", "", 10, maximum, configured, false}};
    };
    Kept kept;
    kept.parameters = {{"cell.speed", 180, 200, 0}};
    EXPECT_EQ(restore(none, kept, RetainStart::warm, info(200)).parameters[0], 180);
    const auto edited = restore(none, kept, RetainStart::warm, info(250));
    EXPECT_EQ(edited.parameters[0], 250) << "who wrote last: the machine file";
    EXPECT_EQ(edited.of("cell.speed")->what, What::configured);
    EXPECT_THAT(edited.of("cell.speed")->text, testing::AllOf(testing::HasSubstr("180"), testing::HasSubstr("250")));
    EXPECT_TRUE(edited.written.parameters.empty());
    const auto narrowed = restore(none, kept, RetainStart::warm, info(200, 100));
    EXPECT_EQ(narrowed.of("cell.speed")->what, What::refused);
}

TEST(KeptValues, ACounterThatWasKeptCountsNoEdgeTwice) {
    fb::CTU count;
    count.CU = true, count.PV = 10;
    count(CycleContext{});
    ASSERT_EQ(count.CV, 1);
    Items before;
    before.add_block("cell.count", count);
    const auto kept = restore(before, {}).written;

    fb::CTU again;
    Items after;
    after.add_block("cell.count", again);
    EXPECT_EQ(restore(after, kept).of("cell.count")->what, What::kept);
    again(CycleContext{});  // CU is still TRUE, as the sensor is
    EXPECT_EQ(again.CV, 1) << "the edge was counted before the power went";
    EXPECT_EQ(again.PV, 10);
}

TEST(KeptValues, OfAnotherBlockThePinsAreTaken) {
    fb::CTU count;
    count.CV = 12, count.PV = 20;
    Items before;
    before.add_block("cell.count", count);
    const auto kept = restore(before, {}).written;

    fb::CTU_LINT larger;
    Items after;
    after.add_block("cell.count", larger);
    const auto restored = restore(after, kept);
    EXPECT_EQ(larger.CV, 12);
    EXPECT_EQ(larger.PV, 20);
    EXPECT_EQ(restored.of("cell.count")->what, What::converted);
    EXPECT_EQ(restored.written.blocks.size(), 1u) << "the old one is claimed";
}

TEST(KeptValues, BytesThatNoBlockEverHadAreNotTaken) {
    fb::TON timer;
    Items program;
    program.add_block("cell.delay", timer);
    auto kept = restore(program, {}).written;
    kept.blocks[0].bytes[0] = std::byte{2};  // IN: a TRUE that is 2
    for (auto& value : kept.values)
        if (value.name == "cell.delay.IN") value.bits = 1;
    EXPECT_EQ(restore(program, kept).of("cell.delay")->what, What::converted);
    EXPECT_TRUE(timer.IN);
}

TEST(KeptValues, WhatNobodyClaimsIsBounded) {
    Kept kept;
    for (std::size_t i = 0; i < KeptValues::most_unclaimed + 100; ++i)
        kept.values.push_back(
            {"old.v" + std::to_string(i), RetainKind::retain, PinKind::LINT, i, static_cast<std::uint16_t>(i < 100 ? 9 : 1)});
    Items none;
    const auto written = restore(none, kept).written;
    ASSERT_EQ(written.values.size(), KeptValues::most_unclaimed);
    for (const auto& value : written.values) EXPECT_EQ(value.unclaimed, 2) << "those nobody had for longer went";
}

}  // namespace
}  // namespace taktwerk::runtime
