// Cams from CSV files: what is read, and what is said, where, of what cannot be.

#include "config/machine_file/cam_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace taktwerk::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const CamUnits deg_mm{"deg", "mm"};

CamFile csv(std::string_view text, const CamUnits& units = deg_mm) { return parse_cam_file("flap.csv", text, units); }

/// `LINE:COL what` of each error, and that each says what to do.
std::vector<std::string> said(const CamFile& file) {
    std::vector<std::string> out;
    for (const auto& error : file.errors) {
        EXPECT_FALSE(error.remedy.empty()) << error.what;
        EXPECT_EQ(error.subject.rfind("flap.csv", 0), 0u) << error.subject;
        out.push_back((error.subject.size() > 9 ? error.subject.substr(9) : "") + " " + error.what + " / " + error.remedy);
    }
    return out;
}

void expect_points(const CamFile& file, const std::vector<std::array<double, 3>>& expected) {
    ASSERT_THAT(said(file), IsEmpty());
    ASSERT_EQ(file.points.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(file.points[i].master, expected[i][0]) << i;
        EXPECT_EQ(file.points[i].slave, expected[i][1]) << i;
        EXPECT_EQ(file.points[i].velocity, expected[i][2]) << i;
    }
}

TEST(CamFile, HasTwoColumnsWithUnits) {
    const auto file = csv("master [deg], slave [mm]\n0, 0\n90.5, -12.25\n180, 1e1\n");
    expect_points(file, {{0, 0, 0}, {90.5, -12.25, 0}, {180, 10, 0}});
    EXPECT_FALSE(file.velocities);
    EXPECT_THAT(file.lines, ElementsAre(2, 3, 4));
}

TEST(CamFile, MayHaveVelocitiesInAnyColumn) {
    const auto file = csv("slave mm;velocity (mm/deg);master [deg]\n0;0;0\n5;0.25;45\n");
    expect_points(file, {{0, 0, 0}, {45, 5, 0.25}});
    EXPECT_TRUE(file.velocities);
}

// 0.25 turns are 90 degrees, 1.2 cm are 12 mm; 360 mm in a turn are 1 mm in a degree.
TEST(CamFile, ConvertsUnitsToThoseOfTheAxes) {
    expect_points(csv("master [rev]\tslave [cm]\tvelocity [mm/rev]\n0\t0\t0\n0.25\t1.2\t360\n"), {{0, 0, 0}, {90, 12, 1}});
}

TEST(CamFile, CommentsEmptyLinesCrLfAndAByteOrderMarkDoNotCount) {
    expect_points(csv("\xEF\xBB\xBF# measured\r\n\r\nmaster [deg],slave [mm]\r\n  # here it rests\r\n0,0\r\n\r\n10,1"),
                  {{0, 0, 0}, {10, 1, 0}});
}

TEST(CamFile, WithoutAHeaderNobodyKnowsTheUnits) {
    EXPECT_THAT(
        said(csv("0, 0\n10, 1\n")),
        ElementsAre("1:1 there is no line that names the columns and their units / begin the file with `master [deg], slave [mm]`"));
    EXPECT_THAT(said(csv("")), ElementsAre(HasSubstr("no line that names the columns")));
    EXPECT_THAT(said(csv("# only words\n")), ElementsAre(HasSubstr("no line that names the columns")));
}

TEST(CamFile, TheHeaderIsReadStrictly) {
    EXPECT_THAT(said(csv("master [deg], slave\n0, 0\n")), ElementsAre("1:15 the column `slave` has no unit / write it as `slave [mm]`"));
    EXPECT_THAT(said(csv("master [mm], slave [mm]\n0, 0\n")),
                ElementsAre("1:1 `mm` is no unit for the column `master`: it is in deg / write it as `master [deg]`"));
    EXPECT_THAT(said(csv("master [deg], slave [mm], velocity [mm/s]\n0, 0, 0\n")),
                ElementsAre("1:27 `mm/s` is no unit for the column `velocity`: it is in mm/deg / write it as `velocity [mm/deg]`"));
    EXPECT_THAT(said(csv("angle [deg], slave [mm]\n0, 0\n")), ElementsAre(HasSubstr("1:1 `angle [deg]` is no column of a cam")));
    EXPECT_THAT(said(csv("master [deg], master [deg]\n0, 0\n")), ElementsAre(HasSubstr("1:15 the column `master` stands here twice")));
    EXPECT_THAT(said(csv("master [deg]\n0\n1\n")), ElementsAre(HasSubstr("1:1 there is no column `slave`")));
}

TEST(CamFile, EachBadNumberIsNamedAtItsPlace) {
    EXPECT_THAT(said(csv("master [deg], slave [mm]\n0, nan\n-inf, 1\nx, 2\n3,\n4, 1e999\n5 deg, 1\n6, 0x10\n")),
                ElementsAre(HasSubstr("2:4 `nan` is no finite number"), HasSubstr("3:1 `-inf` is no finite number"),
                            HasSubstr("4:1 `x` is no number"), HasSubstr("5:3 there is no value"), HasSubstr("6:4 `1e999` is no number"),
                            HasSubstr("7:1 `5 deg` is no number / write it such as 12.5 or -1e-3; units stand in the header"),
                            HasSubstr("8:4 `0x10` is no number")));
}

TEST(CamFile, ADecimalCommaIsToldAsSuch) {
    EXPECT_THAT(said(csv("master [deg]; slave [mm]\n0; 0\n10; 1,5\n")),
                ElementsAre("3:5 `1,5` is no number / write it with a decimal point: 12.5"));
    EXPECT_THAT(said(csv("master [deg], slave [mm]\n0,0, 0,0\n")),
                ElementsAre("2:6 the line has 4 values, the header 2 / write numbers with a decimal point: 12.5"));
}

TEST(CamFile, EveryLineHasAsManyValuesAsTheHeader) {
    EXPECT_THAT(said(csv("master [deg], slave [mm]\n0, 0\n1\n2, 2, 2\n3, 3,\n")),
                ElementsAre(HasSubstr("3:1 the line has 1 value, the header 2"), HasSubstr("4:7 the line has 3 values"),
                            HasSubstr("5:6 the line has 3 values")));
}

TEST(CamFile, TheMasterRises) {
    EXPECT_THAT(said(csv("slave [mm], master [deg]\n0, 0\n0, 10\n0, 10\n0, 9\n")),
                ElementsAre(HasSubstr("4:4 the master's position 10 deg is not above that of line 3, 10"),
                            HasSubstr("5:4 the master's position 9 deg is not above that of line 3, 10")));
}

TEST(CamFile, HasTwoPointsAndAtMostSoMany) {
    EXPECT_THAT(said(csv("master [deg], slave [mm]\n0, 0\n")), ElementsAre(HasSubstr(" the file has 1 point, a cam needs two")));
    std::string text = "master [deg], slave [mm]\n";
    for (std::size_t i = 0; i < max_cam_points; ++i) text += std::to_string(i) + ", 0\n";
    EXPECT_EQ(csv(text).points.size(), max_cam_points);
    EXPECT_THAT(said(csv(text + "99998, 0\n99999, 0\n")), ElementsAre(HasSubstr("4098:1 the cam has more than 4096 points")));
}

TEST(CamFile, ManyMistakesAreNotAllTold) {
    std::string text = "master [deg], slave [mm]\n";
    for (int i = 0; i < 1000; ++i) text += "1 000, 0\n";
    EXPECT_EQ(csv(text).errors.size(), 10u);
}

TEST(CamFile, HostileBytesDoNoHarm) {
    std::string all;
    for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
    EXPECT_FALSE(csv(all).errors.empty());
    EXPECT_FALSE(csv("master [deg], slave [mm]\n" + all + "\n").errors.empty());
    EXPECT_FALSE(csv(std::string(100'000, ',')).errors.empty());
    EXPECT_FALSE(csv(std::string_view("master [deg], slave [mm]\n0,0\0,\n", 31)).errors.empty());
    for (const auto& error : csv("\x1b[31m, slave [mm]\n").errors) EXPECT_EQ(error.what.find('\x1b'), std::string::npos);
}

TEST(CamFile, ThatCannotBeReadIsOneClearError) {
    const auto missing = read_cam_file("/nowhere/flap.csv", deg_mm);
    ASSERT_EQ(missing.errors.size(), 1u);
    EXPECT_EQ(missing.errors[0].subject, "/nowhere/flap.csv");
    EXPECT_THAT(missing.errors[0].what, HasSubstr("no such file"));
    EXPECT_THAT(read_cam_file(testing::TempDir(), deg_mm).errors[0].what, HasSubstr("not a regular file"));
}

TEST(CamDerivative, HasTheUnitsOfBothAxes) {
    EXPECT_EQ(parse_cam_derivative("0.5 mm/deg", 1, deg_mm), 0.5);
    EXPECT_EQ(parse_cam_derivative("0.5cm/deg", 1, deg_mm), 5);
    EXPECT_EQ(parse_cam_derivative("720 mm/rev", 1, deg_mm), 2);
    EXPECT_EQ(parse_cam_derivative("-3 mm/deg2", 2, deg_mm), -3);
    EXPECT_EQ(parse_cam_derivative("-3 mm/deg^2", 2, deg_mm), -3);
    EXPECT_EQ(parse_cam_derivative("129600 mm/rev2", 2, deg_mm), 1);
    EXPECT_EQ(parse_cam_derivative("1.5", 1, {"mm", "mm"}), 1.5);
    for (const auto* text : {"1.5", "1.5 mm", "1.5 mm/s", "1.5 deg/mm", "1.5 mm/deg2", "x mm/deg", "/", "", "1 mm/", "nan mm/deg"})
        EXPECT_EQ(parse_cam_derivative(text, 1, deg_mm), std::nullopt) << text;
    EXPECT_EQ(parse_cam_derivative("1 mm/deg", 2, deg_mm), std::nullopt);
    EXPECT_EQ(parse_cam_derivative("1e308 mm/um", 1, {"m", "mm"}), std::nullopt);  // beyond what a number can be
}

}  // namespace
}  // namespace taktwerk::config
