// Cams of a machine file: laws, units, files beside it, and what `taktwerk check` remarks of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "config/machine_file/machine_loader.hpp"

namespace taktwerk::config {
namespace {

using axes::CamSegment;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A machine with the axes press [rev] and feeder [mm], and what stands under `cams`.
LoadResult with_cams(const std::string& cams) {
    LoadOptions options;
    options.drive_dirs = {std::string(TAKTWERK_SOURCE_DIR) + "/config/drives"};
    options.resolve_programs = false;
    return load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/tests/config/cams/machine.yaml",
                             "version: 1\nname: cams\ncycle: 1 ms\nbus: { interface: simulated, slaves: [] }\naxes:\n"
                             "  press: { unit: rev, gearing: { counts_per_revolution: 36000, feed: 1 rev }, limits: { velocity: 10 rev/s, "
                             "acceleration: 10 rev/s2, jerk: none } }\n"
                             "  feeder: { unit: mm, gearing: { counts_per_revolution: 10000, feed: 10 mm }, limits: { velocity: 100 mm/s, "
                             "acceleration: 1000 mm/s2, jerk: none } }\n"
                             "cams:\n" +
                                 cams,
                             options);
}

struct LoadedCams {
    std::vector<runtime::CamConfig> cams;
    std::vector<std::string> remarks;  ///< CODE LINE: what
};

LoadedCams cams_of(const std::string& text) {
    auto loaded = with_cams(text);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    auto& machine = std::get<LoadedMachine>(loaded);
    LoadedCams out{std::move(machine.machine.cams), {}};
    for (const auto& warning : machine.warnings)
        if (warning.code.rfind("config.cam_", 0) == 0) {
            EXPECT_FALSE(warning.remedy.empty());
            out.remarks.push_back(warning.code + " " + warning.subject.substr(warning.subject.rfind('/') + 1) + ": " + warning.what);
        }
    return out;
}

// The velocities beside the straight line are its own: 30 mm in half a turn. No remark: the sine leaves and reaches it without acceleration.
TEST(Cams, HaveLawsAndTakeTheVelocityOfAStraightNeighbour) {
    const auto loaded = cams_of(R"(  saw:
    master: press
    slave: feeder
    periodic: true
    points:
      - { master: 0 rev, slave: 0 cm, law: inclined_sine }
      - { master: 90 deg, slave: 7.5 mm, law: straight_line }
      - { master: 0.75 rev, slave: 37.5 mm, law: modified_trapezoid }
      - { master: 1 rev, slave: 45 mm, law: modified_sine }
      - { master: 2 rev, slave: 0 mm }
)");
    ASSERT_EQ(loaded.cams.size(), 1u);
    const auto& saw = loaded.cams[0];
    EXPECT_EQ(saw.name, "saw");
    EXPECT_EQ(saw.master, "press");
    EXPECT_EQ(saw.slave, "feeder");
    EXPECT_TRUE(saw.periodic);
    ASSERT_EQ(saw.points.size(), 5u);
    EXPECT_EQ(saw.points[1].master, 0.25);
    EXPECT_EQ(saw.points[1].slave, 7.5);
    EXPECT_EQ(saw.points[0].segment, CamSegment::inclined_sine);
    EXPECT_EQ(saw.points[1].segment, CamSegment::linear);
    EXPECT_EQ(saw.points[2].segment, CamSegment::modified_trapezoid);
    EXPECT_EQ(saw.points[3].segment, CamSegment::modified_sine);
    EXPECT_EQ(saw.points[0].velocity, 0);
    EXPECT_EQ(saw.points[1].velocity, 60);
    EXPECT_EQ(saw.points[2].velocity, 60);
    EXPECT_EQ(saw.points[3].velocity, 0);
    EXPECT_THAT(loaded.remarks, IsEmpty());
}

// The first point of a periodic cam is its last one.
TEST(Cams, TheEndOfAPeriodicOneHasTheVelocityOfItsBeginning) {
    for (const bool straight_first : {true, false}) {
        const std::string first = straight_first ? "straight_line" : "polynomial_5",
                          second = straight_first ? "polynomial_5" : "straight_line";
        const auto loaded =
            cams_of("  belt: { master: press, slave: feeder, periodic: true, points: [{ master: 0 rev, slave: 0 mm, law: " + first +
                    " }, { master: 1 rev, slave: 10 mm, law: " + second + " }, { master: 2 rev, slave: 20 mm }] }\n");
        ASSERT_EQ(loaded.cams.size(), 1u);
        EXPECT_EQ(loaded.cams[0].points[0].velocity, 10);
        EXPECT_EQ(loaded.cams[0].points[2].velocity, 10);
        EXPECT_THAT(loaded.remarks, IsEmpty());
    }
}

TEST(Cams, TakeTheirOwnLawWhereAPointNamesNone) {
    const auto loaded = cams_of(R"(  flap:
    { master: press, slave: feeder, law: simple_sine,
      points: [{ master: 0 rev, slave: 0 mm }, { master: 1 rev, slave: 5 mm, law: quadratic_parabola }, { master: 2 rev, slave: 9 mm }] }
  plain: { master: press, slave: feeder, points: [{ master: 0 rev, slave: 0 mm }, { master: 1 rev, slave: 5 mm, velocity: 2 mm/rev, acceleration: 1 mm/rev2 }] }
)");
    ASSERT_EQ(loaded.cams.size(), 2u);
    EXPECT_EQ(loaded.cams[0].points[0].segment, CamSegment::simple_sine);
    EXPECT_EQ(loaded.cams[0].points[1].segment, CamSegment::quadratic_parabola);
    EXPECT_EQ(loaded.cams[1].points[0].segment, CamSegment::quintic);
    EXPECT_EQ(loaded.cams[1].points[1].velocity, 2);
    EXPECT_EQ(loaded.cams[1].points[1].acceleration, 1);
}

// Straight to straight: 0 and 10 mm/rev. A parabola from rest over 1 rev and 5 mm: acceleration 4 * 5 = 20 mm/rev2 at both ends.
TEST(Cams, StepsBetweenSegmentsAreRemarkedWithTheirPlace) {
    const auto loaded = cams_of(R"(  kinked:
    master: press
    slave: feeder
    points:
      - { master: 0 rev, slave: 0 mm, law: straight_line }
      - { master: 1 rev, slave: 0 mm, law: straight_line }
      - { master: 2 rev, slave: 10 mm }
  jerky:
    master: press
    slave: feeder
    points:
      - { master: 0 rev, slave: 0 mm, law: straight_line }
      - { master: 1 rev, slave: 0 mm, law: quadratic_parabola }
      - { master: 2 rev, slave: 5 mm, law: inclined_sine }
      - { master: 3 rev, slave: 0 mm }
  wraps:
    master: press
    slave: feeder
    periodic: true
    points:
      - { master: 0 rev, slave: 0 mm, velocity: 1 mm/rev }
      - { master: 1 rev, slave: 5 mm, velocity: 2 mm/rev }
)");
    EXPECT_THAT(
        loaded.remarks,
        ElementsAre(
            "config.cam_velocity_step machine.yaml:14:9: cam 'kinked': at master 1 rev the velocity steps from 0 to 10 mm/rev",
            "config.cam_acceleration_step machine.yaml:21:9: cam 'jerky': at master 1 rev the acceleration steps from 0 to 20 mm/rev2",
            "config.cam_acceleration_step machine.yaml:22:9: cam 'jerky': at master 2 rev the acceleration steps from -20 to 0 mm/rev2",
            "config.cam_velocity_step machine.yaml:29:9: cam 'wraps': where its end runs into its beginning the velocity steps from "
            "2 to 1 mm/rev"));
}

TEST(Cams, OfManyStepsThreeAreRemarked) {
    std::string text = "  zigzag:\n    master: press\n    slave: feeder\n    law: straight_line\n    points:\n";
    for (int i = 0; i < 50; ++i) text += "      - { master: " + std::to_string(i) + " rev, slave: " + std::to_string(i % 2) + " mm }\n";
    const auto loaded = cams_of(text);
    ASSERT_EQ(loaded.remarks.size(), 3u);
    EXPECT_THAT(loaded.remarks[2], HasSubstr("; 45 more like it"));
}

// x^3: velocities of the file, accelerations 6 x by hand. Beside the machine file.
TEST(Cams, FromAFileWithVelocitiesAreSmooth) {
    const auto loaded = cams_of("  flap: { master: press, slave: feeder, file: flap.csv }\n");
    ASSERT_EQ(loaded.cams.size(), 1u);
    const auto& points = loaded.cams[0].points;
    ASSERT_EQ(points.size(), 4u);
    for (const auto& p : points) {
        EXPECT_EQ(p.segment, CamSegment::quintic);
        EXPECT_DOUBLE_EQ(p.slave, p.master * p.master * p.master);
        EXPECT_DOUBLE_EQ(p.velocity, 3 * p.master * p.master);
        EXPECT_NEAR(p.acceleration, 6 * p.master, 1e-12);
    }
    EXPECT_THAT(loaded.remarks, IsEmpty());
}

std::string beside(const std::string& name, const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

TEST(Cams, FromAFileWithoutVelocitiesAreSplines) {
    const auto path = beside("spline.csv", "master [rev], slave [mm]\n0, 0\n1, 1\n2, 0\n");
    const auto loaded = cams_of("  flap: { master: press, slave: feeder, file: " + path +
                                " }\n  line: { master: press, slave: feeder, law: straight_line, file: " + path + " }\n");
    ASSERT_EQ(loaded.cams.size(), 2u);
    for (const auto& p : loaded.cams[0].points) EXPECT_EQ(p.segment, CamSegment::spline);
    for (const auto& p : loaded.cams[1].points) EXPECT_EQ(p.segment, CamSegment::linear);
    EXPECT_THAT(loaded.remarks,
                ElementsAre("config.cam_velocity_step spline.csv:3:1: cam 'line': at master 1 rev the velocity steps from 1 to -1 mm/rev"));
}

TEST(Cams, AFilesMistakesAreToldAtTheirPlaceInIt) {
    const auto path = beside("bad.csv", "master [rev], slave [mm]\n0, 0\n1, x\n");
    const auto loaded = with_cams("  flap: { master: press, slave: feeder, file: " + path + " }\n");
    const auto* errors = std::get_if<std::vector<Error>>(&loaded);
    ASSERT_NE(errors, nullptr);
    ASSERT_EQ(errors->size(), 1u);
    EXPECT_EQ(errors->front().subject, path + ":3:4");
    EXPECT_THAT(errors->front().what, HasSubstr("`x` is no number"));
}

}  // namespace
}  // namespace taktwerk::config
