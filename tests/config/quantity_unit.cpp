// Numbers with units as people write them.

#include "config/reading/quantity.hpp"

#include <gtest/gtest.h>

namespace taktwerk::config {
namespace {

using P = QuantityProblem;
using D = Dimension;

struct UnitRow {
    const char* text;
    D dimension;
    const char* axis_unit;
    P problem;
    double value;
};

// Values converted by hand.
constexpr UnitRow rows[] = {
    {"1 ms", D::time, "", P::none, 0.001},
    {"1ms", D::time, "", P::none, 0.001},
    {"  250 us ", D::time, "", P::none, 0.00025},
    {"250 µs", D::time, "", P::none, 0.00025},
    {"5 ns", D::time, "", P::none, 5e-9},
    {"2 min", D::time, "", P::none, 120},
    {"+1.5e1 s", D::time, "", P::none, 15},
    {"100 mm/s", D::velocity, "mm", P::none, 100},
    {"0.1 m/s", D::velocity, "mm", P::none, 100},
    {"6 m/min", D::velocity, "mm", P::none, 100},
    {"2000 mm/s2", D::acceleration, "mm", P::none, 2000},
    {"2000 mm/s^2", D::acceleration, "mm", P::none, 2000},
    {"2000 mm/s²", D::acceleration, "mm", P::none, 2000},
    {"2 m/s2", D::acceleration, "cm", P::none, 200},
    {"1 mm/s3", D::jerk, "um", P::none, 1000},
    {"-3 cm", D::position, "mm", P::none, -30},
    {"360 deg", D::position, "deg", P::none, 360},
    {"1 rev", D::position, "deg", P::none, 360},
    {"90 deg", D::position, "rev", P::none, 0.25},
    {"60 rpm", D::velocity, "rev", P::none, 1},
    {"50 Hz", D::frequency, "", P::none, 50},
    {"0.5 Nm", D::torque, "", P::none, 0.5},
    {"500 mNm", D::torque, "", P::none, 0.5},
    {"2e-4 kg m2", D::inertia, "", P::none, 2e-4},
    {"2e-4 kgm2", D::inertia, "", P::none, 2e-4},
    {"2e-4 kg m^2", D::inertia, "", P::none, 2e-4},
    {"1e-3 Nm s/rad", D::friction, "", P::none, 1e-3},
    {"20 ppm", D::ratio_ppm, "", P::none, 20},
    {"4 cycles", D::cycles, "", P::none, 4},
    {"100", D::velocity, "mm", P::no_unit, 0},
    {"100 mm", D::velocity, "mm", P::wrong_unit, 0},
    {"100 mm/s", D::velocity, "deg", P::wrong_unit, 0},
    {"100 deg/s", D::velocity, "mm", P::wrong_unit, 0},
    {"100 ms", D::velocity, "mm", P::wrong_unit, 0},
    {"1 mm", D::time, "", P::wrong_unit, 0},
    {"100 furlong/s", D::velocity, "mm", P::unknown_unit, 0},
    {"100 mm/s4", D::velocity, "mm", P::unknown_unit, 0},
    {"1 mss", D::time, "", P::unknown_unit, 0},
    {"fast", D::velocity, "mm", P::not_a_number, 0},
    {"", D::velocity, "mm", P::not_a_number, 0},
    {"nan mm/s", D::velocity, "mm", P::not_a_number, 0},
    {"inf mm/s", D::velocity, "mm", P::not_a_number, 0},
    {"1e400 s", D::time, "", P::not_a_number, 0},
    {"1e305 m", D::position, "um", P::not_a_number, 0},
    {"0x10 mm", D::position, "mm", P::unknown_unit, 0},
};

TEST(Quantity, IsReadInTheUnitOfItsDimensionOrRefusedForAReason) {
    for (const auto& row : rows) {
        const auto found = parse_quantity(row.text, row.dimension, row.axis_unit);
        EXPECT_EQ(found.problem, row.problem) << row.text;
        if (row.problem != P::none) continue;
        EXPECT_DOUBLE_EQ(found.value, row.value) << row.text;
    }
}

TEST(Quantity, ConversionsThatAreWholeAreExact) {
    EXPECT_EQ(parse_quantity("0.3 m", D::position, "mm").value, 300.0);
    EXPECT_EQ(parse_quantity("7 mm", D::position, "m").value, 0.007);
    EXPECT_EQ(parse_quantity("0.25 rev", D::position, "deg").value, 90.0);
}

TEST(Number, MayBeDecimalOrHexadecimalInBothSpellings) {
    EXPECT_EQ(parse_integer("1600h"), 0x1600);
    EXPECT_EQ(parse_integer("0x1600"), 0x1600);
    EXPECT_EQ(parse_integer("-7"), -7);
    EXPECT_EQ(parse_integer("+7"), 7);
    EXPECT_EQ(parse_integer("9223372036854775807"), 9223372036854775807);
    for (const char* wrong : {"", "-", "--7", "7.0", "1e3", "0x", "h", "9223372036854775808", "abc"})
        EXPECT_FALSE(parse_integer(wrong)) << wrong;
    EXPECT_FALSE(parse_number("1.5 mm"));
    EXPECT_EQ(parse_number("1.5"), 1.5);
}

TEST(Object, IsWrittenAsManualsPrintItOrAsCWritesIt) {
    EXPECT_EQ(parse_object("607Ah"), (ObjectAddress{0x607A, 0, 0}));
    EXPECT_EQ(parse_object("2005h:0B"), (ObjectAddress{0x2005, 11, 0}));
    EXPECT_EQ(parse_object("2000h:10"), (ObjectAddress{0x2000, 16, 0})) << "manual style: the sub-index is hexadecimal";
    EXPECT_EQ(parse_object("0x2000:10"), (ObjectAddress{0x2000, 10, 0}));
    EXPECT_EQ(parse_object("0x2000:0x10"), (ObjectAddress{0x2000, 16, 0}));
    EXPECT_EQ(parse_object("60FDh/16"), (ObjectAddress{0x60FD, 0, 16}));
    for (const char* wrong : {"", "607A", "6071", "12345h", "0h", "607Ah:", "607Ah:100", "0x607A:256", "607Ah/0", "607Ah/65", "h", "0x"})
        EXPECT_FALSE(parse_object(wrong)) << wrong;
    EXPECT_EQ(show_object(0x2005, 11), "2005h:0B");
}

TEST(Fraction, IsTwoWholeNumbers) {
    EXPECT_EQ(parse_fraction("25/2")->numerator, 25);
    EXPECT_EQ(parse_fraction("25/2")->denominator, 2);
    EXPECT_EQ(parse_fraction("5 : 1")->numerator, 5);
    EXPECT_EQ(parse_fraction("5")->denominator, 1);
    EXPECT_FALSE(parse_fraction("2.5/1"));
    EXPECT_FALSE(parse_fraction("5/"));
}

}  // namespace
}  // namespace taktwerk::config
