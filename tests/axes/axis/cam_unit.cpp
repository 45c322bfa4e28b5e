// MC_CamTableSelect, MC_CamIn, MC_CamOut: a slave on a cam.

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

CamPoint point(double master, double slave) { return {.master = master, .slave = slave}; }

/// 0 -> height -> 0 over `length`, resting at each point: at a quarter of the way 10/64 - 15/256 + 6/1024 of ... by symmetry half the height.
std::vector<CamPoint> hump(double begin, double length, double height) {
    return {point(begin, 0), point(begin + length / 2, height), point(begin + length, 0)};
}

CamId select(CouplingRig& rig, std::size_t axis, CamRef table, bool periodic, bool master_absolute = true, bool slave_absolute = true) {
    EXPECT_EQ(rig.axes[axis].set(SelectCam{table, periodic, master_absolute, slave_absolute}, Owner::program), ErrorId::none);
    return rig.view(axis).selected_cam;
}

struct CamRig : CouplingRig {
    explicit CamRig(const std::vector<CamPoint>& points) : CouplingRig(2) { table = tables.add_cam(points, points.size() + 4); }
    CamRef table;
    /// What the table says where the master is, its own interpolation asked apart from the axis.
    [[nodiscard]] double expected(CamId id, double master, double length) const {
        double at = std::fmod(master, length);
        if (at < 0) at += length;
        return tables.prepared(id)->at(at).position;
    }
};

// P1-253, P1-262, P1-264, P1-267, P1-268, P1-270
TEST(Cam, AnAbsolutePeriodicCamIsEnteredOnTheFly) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    const auto id = select(rig, 1, rig.table, true);
    rig.accept(0, at_velocity(25));
    rig.run(307);
    const auto cam = rig.accept(1, cam_in(0, id));
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    ASSERT_TRUE(rig.run_to_sync(1, cam, 1000));
    const auto ends = rig.view(1).cam_ends;
    const double from = rig.view(0).set_position;
    for (int i = 0; i < 4000; ++i) {
        if (i == 2000) rig.accept(0, at_velocity(-35));  // and backwards
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, rig.expected(id, rig.view(0).set_position, 20), 1e-9) << i;
        ASSERT_EQ(rig.status(1, cam), CommandStatus::in_target) << i;
        if (i == 1999) {
            EXPECT_EQ(rig.view(1).cam_ends - ends,
                      static_cast<std::uint32_t>(std::floor(rig.view(0).set_position / 20) - std::floor(from / 20)));
        }
    }
    // 2000 cycles back at 35 u/s, less the reversal: 3 or 4 first points passed, each once.
    EXPECT_GE(rig.view(1).cam_ends, ends + 2 + 3);
    rig.expect_no_jump();
}

// P1-254, P1-268
TEST(Cam, ACamThatIsNotPeriodicEndsOnceAndTheSlaveStaysSynchronized) {
    CamRig rig({point(10, 0), point(20, 8)});
    rig.start();
    const auto id = select(rig, 1, rig.table, false);
    const auto cam = rig.accept(1, cam_in(0, id));
    rig.accept(0, absolute(30, 40));
    ASSERT_TRUE(rig.run_until([&] { return rig.view(0).state == AxisState::Standstill; }));
    EXPECT_NEAR(rig.view(1).set_position, 8, 1e-9);
    EXPECT_EQ(rig.view(1).cam_ends, 1u);
    EXPECT_EQ(rig.status(1, cam), CommandStatus::in_target);
    rig.accept(0, absolute(0, 40));
    for (Patience patience; patience.lasts(rig.view(0).state != AxisState::Standstill || rig.view(0).active != 0);) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, 8, 1e-9);
    }
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    EXPECT_EQ(rig.view(1).cam_ends, 1u);
    rig.expect_no_jump();
}

// Four combinations of coordinates from places that are not zero: master at 7, slave at 3, a hump of 5 over 20.
// P1-260, P1-264
TEST(Cam, AbsoluteAndRelativeCoordinates) {
    for (const bool master_absolute : {true, false})
        for (const bool slave_absolute : {true, false}) {
            CamRig rig({point(0, 1), point(10, 6), point(20, 1)});
            rig.start();
            rig.accept(0, absolute(7));
            rig.accept(1, absolute(3));
            rig.run(500);
            const auto id = select(rig, 1, rig.table, true, master_absolute, slave_absolute);
            const auto cam = rig.accept(1, cam_in(0, id));
            ASSERT_TRUE(rig.run_to_sync(1, cam));
            rig.accept(0, at_velocity(15));
            const auto& table = *rig.tables.prepared(id);
            const double entry = master_absolute ? 7 : 0;
            for (int i = 0; i < 1500; ++i) {
                rig.step();
                const double master = rig.view(0).set_position - (master_absolute ? 0 : 7);
                const double value = table.at(std::fmod(master, 20)).position;
                const double expected = slave_absolute ? value : 3 + value - table.at(entry).position;
                ASSERT_NEAR(rig.view(1).set_position, expected, 1e-9) << i;
            }
            rig.expect_no_jump();
        }
}

// slave = 2 * f((master - 5) / 0.5) + 3
// P1-265
TEST(Cam, ScalingsAndOffsets) {
    CamRig rig(hump(0, 20, 2));
    rig.start();
    const auto id = select(rig, 1, rig.table, true);
    auto command = cam_in(0, id);
    auto& details = std::get<CamDetails>(command.details);
    details.master_offset = 5;
    details.slave_offset = 3;
    details.master_scaling = 0.5;
    details.slave_scaling = 2;
    rig.accept(0, at_velocity(8));
    const auto cam = rig.accept(1, command);
    ASSERT_TRUE(rig.run_to_sync(1, cam));
    for (int i = 0; i < 3000; ++i) {
        rig.step();
        double at = std::fmod((rig.view(0).set_position - 5) / 0.5, 20);
        if (at < 0) at += 20;
        ASSERT_NEAR(rig.view(1).set_position, 2 * rig.tables.prepared(id)->at(at).position + 3, 1e-9);
    }
    details.master_scaling = 0;
    EXPECT_EQ(rig.refuse(1, command), ErrorId::invalid_parameter);
    rig.expect_no_jump();
}

// The slave stands until the master is 6 before its 16, and is on the cam at 16.
// P1-266
TEST(Cam, StartDistanceAndSyncPosition) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    const auto id = select(rig, 1, rig.table, true);
    auto command = cam_in(0, id);
    auto& details = std::get<CamDetails>(command.details);
    details.master_start_distance = 6;
    details.master_sync_position = 16;
    const auto cam = rig.accept(1, command);
    rig.accept(0, at_velocity(20));
    for (Patience patience; patience.lasts(rig.view(0).set_position < 40);) {
        const double before = rig.view(0).set_position;
        rig.step();
        const double master = rig.view(0).set_position;
        if (master < 10) {
            ASSERT_EQ(rig.view(1).set_velocity, 0);
            ASSERT_EQ(rig.view(1).set_position, 0);
        }
        ASSERT_EQ(rig.status(1, cam) == CommandStatus::in_target, master >= 16) << master;
        if (before >= 16) {
            ASSERT_NEAR(rig.view(1).set_position, rig.expected(id, master, 20), 1e-9) << master;
        }
    }
    rig.expect_no_jump();
}

// The same for a slave that moves, with and against the master: its motion goes on until the master is there, and it meets the cam.
// P1-266
TEST(Cam, AMovingSlaveGoesOnUntilTheStartDistance) {
    for (const double initial : {4.0, -3.0}) {
        CamRig rig(hump(0, 20, 5));
        rig.start();
        const auto id = select(rig, 1, rig.table, true);
        auto command = cam_in(0, id);
        auto& details = std::get<CamDetails>(command.details);
        details.master_start_distance = 14;
        details.master_sync_position = 24;
        rig.accept(1, at_velocity(initial));
        rig.run(100);
        const auto cam = rig.accept(1, command);
        rig.accept(0, at_velocity(20));
        double place = rig.view(1).set_position;
        for (Patience patience; patience.lasts(rig.view(0).set_position < 60);) {
            rig.step();
            const double master = rig.view(0).set_position;
            ASSERT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
            ASSERT_EQ(rig.view(1).sync_started, master >= 10 && master < 24) << master;
            ASSERT_EQ(rig.status(1, cam) == CommandStatus::in_target, master >= 24) << master;
            place += initial * 1e-3;
            if (master < 10) {
                ASSERT_NEAR(rig.view(1).set_velocity, initial, 1e-9);
                ASSERT_NEAR(rig.view(1).set_position, place, 1e-9);
            } else if (master >= 24) {
                ASSERT_NEAR(rig.view(1).set_position, rig.expected(id, master, 20), 1e-9) << master;
            }
        }
        rig.expect_no_jump();
    }
}

// P1-269
TEST(Cam, AnotherTableTakesOverOnTheFly) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    const auto first = select(rig, 1, rig.table, true);
    rig.accept(0, at_velocity(20));
    const auto one = rig.accept(1, cam_in(0, first));
    ASSERT_TRUE(rig.run_to_sync(1, one));
    rig.run(333);
    rig.tables.cam(rig.table)->points[1].slave = -3;
    const auto second = select(rig, 1, rig.table, true);
    const auto two = rig.accept(1, cam_in(0, second));
    EXPECT_EQ(rig.status(1, one), CommandStatus::aborted);
    ASSERT_TRUE(rig.run_to_sync(1, two));
    for (int i = 0; i < 500; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, rig.expected(second, rig.view(0).set_position, 20), 1e-9);
    }
    rig.expect_no_jump();
}

// The table is edited and selected anew while the slave follows: it follows what it was given, to the last bit.
// P1-257, P1-261
TEST(Cam, EditingATableInUseChangesNothing) {
    CamRig plain(hump(0, 20, 5)), edited(hump(0, 20, 5));
    for (auto* rig : {&plain, &edited}) {
        rig->start();
        const auto id = select(*rig, 1, rig->table, true);
        rig->accept(0, at_velocity(20));
        rig->accept(1, cam_in(0, id));
    }
    for (int i = 0; i < 1000; ++i) {
        if (i % 100 == 50) {
            edited.tables.cam(edited.table)->points[1].slave = i;
            (void)select(edited, 1, edited.table, i % 200 == 50);
        }
        plain.step();
        edited.step();
        ASSERT_EQ(plain.view(1).set_position, edited.view(1).set_position) << i;
    }
}

// Ramp-in, cycle, ramp-out as three tables, each relative and buffered behind the one before: the slave moves 4 + 2 * ... without a step.
// P1-092, P1-255
TEST(Cam, TablesAreChainedByTheBuffer) {
    CouplingRig rig(2);
    const auto in = rig.tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 8, .slave = 4, .velocity = 1}});
    const auto middle =
        rig.tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0, .velocity = 1}, {.master = 10, .slave = 10, .velocity = 1}});
    const auto out = rig.tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0, .velocity = 1}, {.master = 8, .slave = 4}});
    rig.start();
    rig.accept(0, at_velocity(23));
    rig.run(100);
    const double from = rig.view(0).set_position;
    const auto one = rig.accept(1, cam_in(0, select(rig, 1, in, false, false, false)));
    const auto two = rig.accept(1, cam_in(0, select(rig, 1, middle, false, false, false), mcAbsolute, mcBuffered));
    const auto three = rig.accept(1, cam_in(0, select(rig, 1, out, false, false, false), mcAbsolute, mcBuffered));
    rig.step();
    const auto& first = *rig.tables.prepared(CamId{1});
    const auto& last = *rig.tables.prepared(CamId{3});
    for (int i = 0; i < 2000; ++i) {
        const double master = rig.view(0).set_position - from;
        const double expected = master < 8    ? first.at(master).position
                                : master < 18 ? 4 + (master - 8)
                                : master < 26 ? 14 + last.at(master - 18).position
                                              : 18;
        ASSERT_NEAR(rig.view(1).set_position, expected, 0.02) << master;  // a table takes over at a cycle, and makes up what that cost
        if (master > 9 && master < 17) {
            ASSERT_NEAR(rig.view(1).set_position, expected, 1e-9) << master;
        }
        rig.step();
    }
    EXPECT_EQ(rig.status(1, one), CommandStatus::aborted);
    EXPECT_EQ(rig.status(1, two), CommandStatus::aborted);
    EXPECT_EQ(rig.status(1, three), CommandStatus::in_target);
    EXPECT_EQ(rig.view(1).cam_ends, 3u);
    rig.expect_no_jump();
}

TEST(Cam, NothingWaitsBehindACamThatNeverEnds) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    rig.accept(1, cam_in(0, select(rig, 1, rig.table, true)));
    EXPECT_EQ(rig.refuse(1, relative(5, 50, mcBuffered)), ErrorId::buffer_mode_not_supported);
}

// Nor behind one that became such by ContinuousUpdate before it had begun.
TEST(Cam, ACamThatHasNotBegunDoesNotBecomeEndlessBeforeAnother) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    const auto once = select(rig, 1, rig.table, false), for_ever = select(rig, 1, rig.table, true);
    const auto cam = rig.accept(1, cam_in(0, once));
    const auto behind = rig.accept(1, relative(5, 50, mcBuffered));
    EXPECT_EQ(rig.axes[1].update(cam, cam_in(0, for_ever), Owner::program), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(rig.axes[1].update(cam, cam_in(0, {}), Owner::program), ErrorId::invalid_table);
    rig.accept(0, absolute(30, 50));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, behind) == CommandStatus::done; }));
}

// P1-259
TEST(Cam, OnlySelectedTablesAreFollowed) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    EXPECT_EQ(rig.refuse(1, cam_in(0, CamId{})), ErrorId::invalid_table);
    EXPECT_EQ(rig.refuse(1, cam_in(0, CamId{1})), ErrorId::invalid_table);
    rig.tables.cam(rig.table)->points[2].master = 5;
    EXPECT_EQ(rig.axes[1].set(SelectCam{rig.table}, Owner::program), ErrorId::invalid_table);
    rig.tables.cam(rig.table)->points[2].master = 20;
    const auto id = select(rig, 1, rig.table, true);
    rig.accept(1, cam_in(0, id));
    rig.step();
    // A slave that leaves gives its table back; one in use is kept.
    for (int i = 0; i < 8; ++i) {
        rig.tables.cam(rig.table)->points[1].slave = i + 10;
        (void)select(rig, 0, rig.table, true);
    }
    EXPECT_NE(rig.tables.prepared(id), nullptr);
    rig.run(3);
    rig.accept(1, halt());
    rig.run(3);
    for (int i = 0; i < 8; ++i) {
        rig.tables.cam(rig.table)->points[1].slave = i + 20;
        (void)select(rig, 0, rig.table, true);
    }
    EXPECT_EQ(rig.tables.prepared(id), nullptr);
}

// A cam with corners and too steep for the slave: it does what it can and says when it is not on it.
TEST(Cam, ACamTooFastForTheSlaveKeepsItsLimits) {
    CamRig rig({{.master = 0, .slave = 0, .segment = CamSegment::linear},
                {.master = 10, .slave = 40, .segment = CamSegment::linear},
                {.master = 20, .slave = 0, .segment = CamSegment::linear},
                {.master = 60, .slave = 0, .segment = CamSegment::linear}});
    rig.start();
    rig.accept(0, at_velocity(30));  // the slave would need 120 u/s
    const auto cam = rig.accept(1, cam_in(0, select(rig, 1, rig.table, true)));
    int in = 0, out = 0;
    for (int i = 0; i < 8000; ++i) {
        rig.step();
        ++(rig.status(1, cam) == CommandStatus::in_target ? in : out);
    }
    EXPECT_GT(in, 1000);
    EXPECT_GT(out, 1000);
    rig.expect_no_jump();
}

// P1-031, P1-271
TEST(Cam, CamOutKeepsTheVelocity) {
    CamRig rig(hump(0, 40, 10));
    rig.start();
    rig.accept(0, at_velocity(30));
    const auto cam = rig.accept(1, cam_in(0, select(rig, 1, rig.table, true)));
    ASSERT_TRUE(rig.run_to_sync(1, cam));
    ASSERT_TRUE(rig.run_until([&] { return rig.view(1).set_velocity > 20; }));
    const double before = rig.view(1).set_velocity;
    const auto out = rig.accept(1, cam_out());
    EXPECT_EQ(rig.view(1).state, AxisState::ContinuousMotion);
    for (int i = 0; i < 1000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_velocity, before, 1e-9);
    }
    EXPECT_EQ(rig.status(1, out), CommandStatus::done);
    EXPECT_EQ(rig.status(1, cam), CommandStatus::aborted);
    rig.expect_no_jump();
}

// Figure 22: slave and master are modulo 360, the cam takes the slave a turn further per turn of the master. A twin without the addition
// says what the cam is: the velocities differ by the addition's (20 u/s at 100 u/s2: 0.2 s up, 2.3 s, 0.2 s down), then not any more,
// and the places by 50 from then on, over the wraps of both.
// P1-159
TEST(Cam, ASuperimposedMotionLeavesAnOffset) {
    auto rotary = plain_slave();
    rotary.gearing = {.counts_per_revolution = 36000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 360};
    rotary.modulo = 360;
    rotary.limits = {.velocity = 2000, .acceleration = 20000, .deceleration = 20000, .jerk = std::numeric_limits<double>::infinity()};
    const std::vector<CamPoint> points{{.master = 0, .slave = 0}, {.master = 120, .slave = 80}, {.master = 360, .slave = 360}};
    CouplingRig rig({rotary, rotary, rotary});  // master, slave, twin
    const auto table = rig.tables.add_cam(points);
    rig.start();
    const auto id = select(rig, 1, table, true);
    rig.accept(0, at_velocity(300));
    rig.run(100);
    const auto cam = rig.accept(1, cam_in(0, id)), same = rig.accept(2, cam_in(0, id));
    ASSERT_TRUE(
        rig.run_until([&] { return rig.status(1, cam) == CommandStatus::in_target && rig.status(2, same) == CommandStatus::in_target; }));
    rig.run(200);
    const auto added =
        rig.accept(1, {.kind = CommandKind::move_superimposed, .position = 50, .velocity = 20, .acceleration = 100, .deceleration = 100});
    const auto turns = rig.view(2).turns;
    double way = 0;
    for (int i = 1; i <= 12000; ++i) {
        rig.step();
        const double addition = i <= 200 ? 0.1 * i : i <= 2500 ? 20 : i <= 2700 ? 0.1 * (2700 - i) : 0;
        const double before = i <= 1 ? 0 : i <= 201 ? 0.1 * (i - 1) : i <= 2501 ? 20 : i <= 2700 ? 0.1 * (2701 - i) : 0;
        way += (addition + before) / 2 * 1e-3;
        ASSERT_NEAR(rig.view(1).set_velocity, rig.view(2).set_velocity + addition, 1e-6) << i;
        double apart = rig.view(1).set_position - rig.view(2).set_position - way;
        apart -= 360 * std::round(apart / 360);
        ASSERT_NEAR(apart, 0, 1e-6) << i;
        ASSERT_EQ(rig.status(1, added) == CommandStatus::done, i >= 2700) << i;
        ASSERT_EQ(rig.status(1, cam), CommandStatus::in_target) << i;
        ASSERT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    }
    EXPECT_NEAR(way, 50, 1e-9);
    EXPECT_GE(rig.view(2).turns, turns + 9);
    rig.expect_no_jump();
}

// ContinuousUpdate: the hump grows while it runs; a relative slave keeps the place it started from.
TEST(Cam, AnUpdateScalesTheRunningCam) {
    CamRig rig(hump(0, 20, 5));
    rig.start();
    rig.accept(1, absolute(2));
    rig.run(300);
    const auto id = select(rig, 1, rig.table, true, true, false);
    rig.accept(0, at_velocity(20));
    auto command = cam_in(0, id);
    const auto cam = rig.accept(1, command);
    ASSERT_TRUE(rig.run_to_sync(1, cam));
    rig.run(100);
    std::get<CamDetails>(command.details).slave_scaling = 1.5;
    EXPECT_EQ(rig.axes[1].update(cam, command, Owner::program), ErrorId::none);
    rig.step();
    ASSERT_TRUE(rig.run_to_sync(1, cam));
    for (int i = 0; i < 1000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, 2 + 1.5 * rig.expected(id, rig.view(0).set_position, 20), 1e-6);
    }
    rig.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::axes::test
