// Cams as relations: passes, ends, scaling, and no creep over many turns.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "axes/coupling/cam_curve.hpp"

namespace taktwerk::axes {
namespace {

PreparedCam wave(double begin, double length, double height, double stroke, bool periodic) {
    PreparedCam cam(3);
    const std::vector<CamPoint> points{
        {.master = begin, .slave = 0}, {.master = begin + length / 2, .slave = height}, {.master = begin + length, .slave = stroke}};
    EXPECT_EQ(cam.prepare(points, periodic, true, true), ErrorId::none);
    return cam;
}

double where(const EndlessPlace& place, double feed) { return way({}, place, feed); }

// 90 degrees on a turn of 360: the same four times a turn, and inversely backwards.
// P1-253
TEST(CamCurve, APeriodicCamRepeatsEvenIfItDoesNotFillTheTurn) {
    const auto cam = wave(0, 90, 8, 0, true);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_feed = 360, .slave_feed = 10}));
    std::vector<double> first;
    for (int i = 0; i < 360; ++i) {
        const double slave = where(curve.at({{0, static_cast<double>(i)}, 0, 0}).place, 10);
        if (i < 90) first.push_back(slave);
        EXPECT_NEAR(slave, first[static_cast<std::size_t>(i % 90)], 1e-12) << i;
    }
    EXPECT_NEAR(first[45], 8, 1e-12);
    EXPECT_EQ(curve.ends(), 3u);
    for (int i = 359; i >= -90; --i)
        EXPECT_NEAR(where(curve.at({{0, static_cast<double>(i)}, 0, 0}).place, 10), first[static_cast<std::size_t>((i + 360) % 90)], 1e-12);
    EXPECT_EQ(curve.ends(), 3u + 4u);
}

// A pass of a third of a turn that moves the slave by 0.7: after 3 * 10^9 passes there is no error but that of the last pass. 120 fits
// 360 exactly; 0.7 in feeds of 10 is taken for the double that it is.
TEST(CamCurve, PassesAndStrokesDoNotCreep) {
    const auto cam = wave(0, 120, 5, 0.7, true);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_feed = 360, .slave_feed = 10}));
    (void)curve.at({});
    std::int64_t turns = 0;
    for (int i = 0; i < 1000; ++i) turns += 1'000'003, (void)curve.at({{turns, 0}, 0, 0});
    const auto place = curve.at({{turns, 60}, 0, 0}).place;
    EXPECT_EQ(curve.ends(), static_cast<std::uint32_t>(3 * turns));
    // 0.7 = 6305039478318694 / 2^53, digit by digit.
    __extension__ using Wide = __int128;
    const Wide total = static_cast<Wide>(6305039478318694) * (3 * turns), feed = static_cast<Wide>(10) << 53;
    EXPECT_NEAR(way({static_cast<std::int64_t>(total / feed), 0}, place, 10),
                10 * static_cast<double>(total % feed) / static_cast<double>(feed) + 5, 1e-12);
}

// P1-254
TEST(CamCurve, ACamThatIsNotPeriodicRunsOnceAndHoldsItsEnd) {
    const auto cam = wave(100, 50, 4, 6, false);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_origin = {0, 100}, .master_feed = 10, .slave_feed = 10}));
    const auto at = [&](double master) { return where(curve.at({{0, master}, 10, 0}).place, 10); };
    EXPECT_EQ(at(90), 0);  // before it
    EXPECT_EQ(at(99), 0);
    EXPECT_EQ(curve.at({{0, 99}, 10, 0}).velocity, 0);
    EXPECT_NEAR(at(125), 4, 1e-12);
    EXPECT_FALSE(curve.over());
    EXPECT_NEAR(at(153), 6, 1e-12);
    EXPECT_TRUE(curve.over());
    EXPECT_EQ(curve.ends(), 1u);
    EXPECT_NEAR(way({0, 150}, curve.end(), 10), 0, 1e-12);
    for (const double master : {151.0, 149.0, 125.0, 90.0, 200.0}) EXPECT_NEAR(at(master), 6, 1e-12);  // not again
    EXPECT_EQ(curve.ends(), 1u);
}

// P1-254, P1-268
TEST(CamCurve, BackwardsTheFirstPointIsTheEnd) {
    const auto cam = wave(100, 50, 4, 6, false);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_origin = {0, 100}, .master_feed = 10, .slave_feed = 10}));
    (void)curve.at({{0, 110}, -10, 0});
    const auto out = curve.at({{0, 99.5}, -10, 0});
    EXPECT_EQ(where(out.place, 10), 0);
    EXPECT_EQ(out.velocity, 0);
    EXPECT_TRUE(curve.over());
    EXPECT_EQ(curve.ends(), 1u);
    EXPECT_EQ(where(curve.at({{0, 125}, 10, 0}).place, 10), 0);
}

// slave = SlaveScaling * f((master - MasterOffset) / MasterScaling) + SlaveOffset, derivatives by the chain rule.
// P1-265
TEST(CamCurve, ScalingsStretchAndMirror) {
    PreparedCam cam(2);
    const std::vector<CamPoint> points{{.master = 10, .slave = 1, .velocity = 2, .acceleration = 3}, {.master = 20, .slave = 30}};
    ASSERT_EQ(cam.prepare(points, false, true, true), ErrorId::none);
    for (const double master_scaling : {1.0, 2.5, -2.0})
        for (const double slave_scaling : {1.0, -3.0}) {
            CamCurve curve;
            const double master_offset = 7, slave_offset = -4;
            ASSERT_TRUE(curve.set(cam, {.master_origin = {0, master_offset + master_scaling * 10},
                                        .slave_origin = {0, slave_offset},
                                        .master_scaling = master_scaling,
                                        .slave_scaling = slave_scaling,
                                        .master_feed = 360,
                                        .slave_feed = 10}));
            for (double table = 10.5; table < 20; table += 1.5) {
                const auto slave = curve.at({{0, master_offset + master_scaling * table}, 6, 5});
                const auto f = cam.at(table - 10);
                EXPECT_NEAR(where(slave.place, 10), slave_offset + slave_scaling * f.position, 1e-11);
                EXPECT_NEAR(slave.velocity, slave_scaling * f.first / master_scaling * 6, 1e-11);
                EXPECT_NEAR(slave.acceleration,
                            slave_scaling * (f.first / master_scaling * 5 + f.second / (master_scaling * master_scaling) * 36), 1e-10);
            }
        }
}

// 8 mm over 90 degrees at 30 deg/s, modified sine: Cv = 1.75960 in the middle, Ca = 5.52796 at an eighth, -Ca at seven eighths.
TEST(CamCurve, ALawGivesTheSlavesVelocityAndAcceleration) {
    PreparedCam cam(2);
    const std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::modified_sine}, {.master = 90, .slave = 8}};
    ASSERT_EQ(cam.prepare(points, false, true, true), ErrorId::none);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_feed = 360, .slave_feed = 10}));
    const auto at = [&](double master) { return curve.at({{0, master}, 30, 0}); };
    EXPECT_NEAR(at(11.25).acceleration, 5.52796 * 8 / 8100 * 900, 1e-4);
    EXPECT_NEAR(where(at(45).place, 10), 4, 1e-12);
    EXPECT_NEAR(at(45).velocity, 1.75960 * 8 / 90 * 30, 1e-4);
    EXPECT_NEAR(at(45).acceleration, 0, 1e-12);
    EXPECT_NEAR(at(78.75).acceleration, -5.52796 * 8 / 8100 * 900, 1e-4);
}

}  // namespace
}  // namespace taktwerk::axes
