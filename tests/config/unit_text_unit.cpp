// Numbers with units where only somebody else knows the unit that is wanted.

#include "config/reading/unit_text.hpp"

#include <gtest/gtest.h>

namespace taktwerk::config {
namespace {

double value(std::string_view text, std::string_view unit) {
    const auto read = value_in(text, unit);
    if (!read) ADD_FAILURE() << text << " as " << unit << ": " << read.error().text();
    return read ? *read : -1;
}

// 1200 mm/min = 20 mm/s; 90 r/min = 1.5 rev/s = 540 deg/s.
TEST(UnitText, ANumberIsToldInTheUnitThatIsWanted) {
    EXPECT_DOUBLE_EQ(value("20", "mm/s"), 20) << "a bare number is taken as it is";
    EXPECT_DOUBLE_EQ(value("20mm/s", "mm/s"), 20);
    EXPECT_DOUBLE_EQ(value("-20 mm/s", "mm/s"), -20);
    EXPECT_DOUBLE_EQ(value("1200 mm/min", "mm/s"), 20);
    EXPECT_DOUBLE_EQ(value("20 mm/s", "mm/min"), 1200);
    EXPECT_DOUBLE_EQ(value("1.2m/min", "mm/s"), 20);
    EXPECT_DOUBLE_EQ(value("90 rpm", "deg/s"), 540);
    EXPECT_DOUBLE_EQ(value("540 deg/s", "r/min"), 90);
    EXPECT_DOUBLE_EQ(value("6cm", "mm"), 60);
    EXPECT_DOUBLE_EQ(value("2 m/s^2", "mm/s²"), 2000);
    EXPECT_DOUBLE_EQ(value("1500 ms", "s"), 1.5);
    EXPECT_DOUBLE_EQ(value("2 min", "s"), 120);
    EXPECT_DOUBLE_EQ(value("40 %", "%"), 40);
    EXPECT_DOUBLE_EQ(value("3 parts", "parts"), 3) << "the unit's own spelling is right";
    EXPECT_DOUBLE_EQ(value("7", ""), 7);
}

TEST(UnitText, AnythingElseIsRefusedWithTheRightForm) {
    for (const auto& [text, unit] :
         {std::pair{"20 mm", "mm/s"}, std::pair{"20 deg/s", "mm/s"}, std::pair{"5 s", "mm"}, std::pair{"5 mm", ""}}) {
        const auto read = value_in(text, unit);
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().code, "unit.other") << text;
    }
    EXPECT_EQ(value_in("20 mm", "mm/s").error().remedy, "write it as `5 mm/s`");
    EXPECT_EQ(value_in("5 mm", "").error().remedy, "write it as `5`");
    for (const char* text : {"", "fast", "20 furlongs", "nan", "inf", "1e999"})
        EXPECT_EQ(value_in(text, "mm/s").error().code, "unit.not_a_number") << text;
}

}  // namespace
}  // namespace taktwerk::config
