// Parameters as people write them: names, units, ranges, bytes.

#include "axes/port/parameter_text.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

DriveParameter brake_release() {  // SV33-E P05.13
    DriveParameter p;
    p.address = {0x2005, 0x0E};
    p.parameter = "P05.13";
    p.name = "brake release to commands";
    p.unit = "ms";
    p.minimum = 0, p.maximum = 500;
    p.value = 250;
    return p;
}

DriveParameter positive_torque_limit() {  // CiA 402 60E0h in 0.1 %
    DriveParameter p;
    p.address = {0x60E0, 0};
    p.name = "positive torque limit";
    p.unit = "%";
    p.scale = 0.1;
    return p;
}

DriveParameter home_offset() {
    DriveParameter p;
    p.address = {0x607C, 0};
    p.name = "home offset";
    p.bits = 32;
    p.is_signed = true;
    return p;
}

DriveProfile named_profile() {
    DriveProfile out;
    out.name = "some-drive";
    out.parameters = {brake_release(), positive_torque_limit(), home_offset()};
    return out;
}

TEST(ParameterText, AParameterIsFoundByTheManualsNameOrItsObjectInAnyCase) {
    const auto drive = named_profile();
    EXPECT_EQ((*find_parameter(drive, "P05.13"))->address, (ParameterAddress{0x2005, 0x0E}));
    EXPECT_EQ((*find_parameter(drive, " p05.13 "))->address, (ParameterAddress{0x2005, 0x0E}));
    EXPECT_EQ((*find_parameter(drive, "2005h:0e"))->parameter, "P05.13");
    EXPECT_EQ((*find_parameter(drive, "607Ch"))->name, "home offset");
    EXPECT_EQ((*find_parameter(drive, "607Ch:00"))->name, "home offset");
}

TEST(ParameterText, ASlipOfTheKeyboardIsAnsweredByTheNearestName) {
    const auto found = find_parameter(named_profile(), "P05.31");
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, "drive.no_parameter");
    EXPECT_NE(found.error().remedy.find("P05.13"), std::string::npos) << found.error().text();
}

// A number that merely looks alike is another parameter: whoever asks for P99.99 does not mean P05.13.
TEST(ParameterText, ADifferentNumberIsNoSlip) {
    const auto other = find_parameter(named_profile(), "P99.99");
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().remedy, "`taktwerk drive params` lists them all");
    for (const char* slip : {"P5.13", "P05.133", "P05.12", "p05.31"})
        EXPECT_EQ(find_parameter(named_profile(), slip).error().remedy, "did you mean P05.13?") << slip;
}

TEST(ParameterText, ValuesAreShownInTheirUnitWithTheDigitsOfOneStep) {
    EXPECT_EQ(value_text(brake_release(), 250), "250 ms");
    EXPECT_EQ(value_text(positive_torque_limit(), 1000), "100.0 %");
    EXPECT_EQ(value_text(positive_torque_limit(), 5), "0.5 %");
    EXPECT_EQ(value_text(home_offset(), -7), "-7");
    EXPECT_EQ(range_text(brake_release()), "0 .. 500 ms");
    EXPECT_EQ(range_text(home_offset()), "");
    auto bounded = positive_torque_limit();
    bounded.maximum = 5000;
    EXPECT_EQ(range_text(bounded), "0.0 .. 500.0 %") << "an unsigned value begins at 0";
    auto fine = positive_torque_limit();
    fine.scale = 0.01;
    EXPECT_EQ(value_text(fine, 470), "4.70 %");
}

TEST(ParameterText, WhatIsWrittenInTheUnitBecomesRaw) {
    EXPECT_EQ(*parse_value(brake_release(), "300"), 300);
    EXPECT_EQ(*parse_value(brake_release(), "300 ms"), 300);
    EXPECT_EQ(*parse_value(brake_release(), "0.3 s"), 300) << "another unit of the same thing";
    EXPECT_EQ(*parse_value(brake_release(), "0.3s"), 300);
    EXPECT_EQ(*parse_value(positive_torque_limit(), "99.9%"), 999);
    EXPECT_EQ(*parse_value(positive_torque_limit(), "0x3E7"), 999);
    EXPECT_EQ(*parse_value(home_offset(), "-12"), -12);
    EXPECT_EQ(*parse_value(home_offset(), "10h"), 16);
}

TEST(ParameterText, WhatCannotBeMeantIsRefusedWithAReason) {
    const auto code = [](const DriveParameter& p, std::string_view text) {
        const auto value = parse_value(p, text);
        return value ? std::string("accepted") : value.error().code;
    };
    EXPECT_EQ(code(brake_release(), "501"), "drive.out_of_range");
    EXPECT_EQ(code(brake_release(), "-1"), "drive.out_of_range");
    EXPECT_EQ(code(brake_release(), "3s"), "drive.out_of_range") << "3000 ms, in the unit of the range";
    EXPECT_EQ(code(brake_release(), "0.3 V"), "drive.value");
    EXPECT_EQ(code(brake_release(), "100 us"), "drive.value") << "between two steps";
    EXPECT_EQ(code(positive_torque_limit(), "10 ms"), "drive.value");
    EXPECT_EQ(code(brake_release(), "fast"), "drive.value");
    EXPECT_EQ(code(brake_release(), ""), "drive.value");
    EXPECT_EQ(code(brake_release(), "nan"), "drive.value");
    EXPECT_EQ(code(brake_release(), "1e300"), "drive.value");
    EXPECT_EQ(code(positive_torque_limit(), "0.05 %"), "drive.value") << "between two steps";
    EXPECT_EQ(code(positive_torque_limit(), "6553.6 %"), "drive.out_of_range") << "16 bit end at 6553.5 %";
    EXPECT_EQ(code(home_offset(), "2147483648"), "drive.out_of_range");
    auto shown = brake_release();
    shown.change = ParameterChange::never;
    EXPECT_EQ(code(shown, "1"), "drive.read_only");
}

TEST(ParameterText, BytesAreLittleEndianAndKeepTheSign) {
    using Bytes = std::vector<std::byte>;
    const auto b = [](int v) { return static_cast<std::byte>(v); };
    EXPECT_EQ(to_bytes(home_offset(), -2), (Bytes{b(0xFE), b(0xFF), b(0xFF), b(0xFF)}));
    EXPECT_EQ(*from_bytes(home_offset(), to_bytes(home_offset(), -2)), -2);
    EXPECT_EQ(*from_bytes(home_offset(), Bytes{b(0xFE), b(0xFF)}), -2) << "a drive may answer in fewer bytes";
    EXPECT_EQ(*from_bytes(positive_torque_limit(), Bytes{b(0xFE), b(0xFF)}), 0xFFFE);
    EXPECT_EQ(from_bytes(positive_torque_limit(), Bytes{}).error().code, "drive.size");
}

TEST(ParameterText, CommandsActionsAndActualValuesAreNoSettings) {
    EXPECT_TRUE(is_setting(brake_release()));
    auto p = brake_release();
    p.action = true;
    EXPECT_FALSE(is_setting(p));
    p = brake_release();
    p.change = ParameterChange::never;
    EXPECT_FALSE(is_setting(p));
    p = home_offset();
    EXPECT_TRUE(is_setting(p));
    p.address = {0x607A, 0};
    EXPECT_FALSE(is_setting(p));
    p.address = {0x1C12, 1};
    EXPECT_FALSE(is_setting(p));
}

}  // namespace
}  // namespace taktwerk::axes
