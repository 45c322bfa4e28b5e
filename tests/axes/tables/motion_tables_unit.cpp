// Who may use which prepared cam, and for how long.

#include <gtest/gtest.h>

#include <vector>

#include "axes/tables/motion_tables.hpp"

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;

const std::vector<CamPoint> ramp{{.master = 0, .slave = 0, .segment = CamSegment::linear}, {.master = 10, .slave = 5}};

// P1-259
TEST(MotionTables, AnIdNamesAPreparedCopyOnly) {
    MotionTables tables;
    const auto cam = tables.add_cam(ramp);
    EXPECT_EQ(tables.prepared(CamId{}), nullptr);
    EXPECT_EQ(tables.prepared(CamId{1}), nullptr);  // not selected yet

    const auto made = tables.prepare(cam, true, false, true);
    ASSERT_EQ(made.error, ErrorId::none);
    const auto* copy = tables.prepared(made.id);
    ASSERT_NE(copy, nullptr);
    EXPECT_TRUE(copy->periodic());
    EXPECT_FALSE(copy->master_absolute());
    EXPECT_TRUE(copy->slave_absolute());
    EXPECT_EQ(tables.prepare(CamRef{7}, true, true, true).error, ErrorId::invalid_table);
}

// The points may be edited at any time: who follows the cam keeps the copy, the next selection has the new points.
// P1-257
TEST(MotionTables, EditingTheSourceDoesNotTouchACopy) {
    MotionTables tables;
    const auto cam = tables.add_cam(ramp, 5);
    const auto before = tables.prepare(cam, false, true, true).id;

    auto& source = *tables.cam(cam);
    source.points[1].slave = 50;
    source.points[2] = {.master = 20, .slave = 50};
    source.used = 3;

    EXPECT_EQ(tables.prepared(before)->at(10).position, 5);
    const auto after = tables.prepare(cam, false, true, true).id;
    EXPECT_NE(after, before);
    EXPECT_EQ(tables.prepared(after)->at(10).position, 50);
    EXPECT_EQ(tables.prepared(after)->length(), 20);
    source.used = 9;
    EXPECT_EQ(tables.prepare(cam, false, true, true).error, ErrorId::invalid_table);
}

TEST(MotionTables, TheSameCurveIsPreparedOnceForAnyNumberOfSlaves) {
    MotionTables tables;
    const auto cam = tables.add_cam(ramp);
    const auto first = tables.prepare(cam, true, true, true).id;
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(tables.prepare(cam, true, true, true).id, first);
        tables.hold(first);
    }
    EXPECT_NE(tables.prepare(cam, false, true, true).id, first);
}

TEST(MotionTables, ACopyInUseIsKeptAndTheOldestUnusedOneGoes) {
    MotionTables tables;
    const auto cam = tables.add_cam(ramp);
    const auto select = [&](double height) {
        tables.cam(cam)->points[1].slave = height;
        return tables.prepare(cam, false, true, true);
    };
    const auto first = select(1).id, second = select(2).id, third = select(3).id;
    tables.hold(first);
    const auto fourth = select(4).id;  // takes the place of the second
    EXPECT_EQ(tables.prepared(first)->stroke(), 1);
    EXPECT_EQ(tables.prepared(second), nullptr);
    EXPECT_EQ(tables.prepared(third)->stroke(), 3);
    EXPECT_EQ(tables.prepared(fourth)->stroke(), 4);

    tables.hold(third);
    tables.hold(fourth);
    EXPECT_EQ(select(5).error, ErrorId::no_table_room);
    EXPECT_EQ(tables.prepared(fourth)->stroke(), 4);
    tables.release(first);
    const auto fifth = select(5);
    EXPECT_EQ(fifth.error, ErrorId::none);
    EXPECT_EQ(tables.prepared(first), nullptr);
}

TEST(MotionTables, OtherTablesAreFoundByTheirHandles) {
    MotionTables tables;
    const std::vector<TimePoint> rows{{10ms, 1}, {20ms, 2}};
    const auto time = tables.add_time_table(rows, 4);
    const std::vector<CamSwitch> switches{{.track = 2, .first = 1, .last = 3}};
    const auto cams = tables.add_cam_switches(switches, 3);
    const std::vector<TrackOptions> options(2, {.hysteresis = 0.5});
    const auto tracks = tables.add_tracks(options);

    ASSERT_NE(tables.time_table(time), nullptr);
    EXPECT_EQ(tables.time_table(time)->rows().size(), 2u);
    EXPECT_EQ(tables.time_table(time)->points.size(), 4u);
    ASSERT_EQ(tables.cam_switches(cams).size(), 3u);
    EXPECT_EQ(tables.cam_switches(cams)[0].track, 2);
    EXPECT_EQ(tables.cam_switches(cams)[2].mode, CamSwitchMode::time);  // a spare row is never on
    EXPECT_EQ(tables.cam_switches(cams)[2].duration, Duration{});
    ASSERT_EQ(tables.track_options(tracks).size(), 2u);
    EXPECT_EQ(tables.track_options(tracks)[1].hysteresis, 0.5);

    EXPECT_EQ(tables.time_table({}), nullptr);
    EXPECT_EQ(tables.cam({}), nullptr);
    EXPECT_TRUE(tables.cam_switches({}).empty());
    EXPECT_TRUE(tables.track_options({}).empty());
}

}  // namespace
}  // namespace taktwerk::axes
