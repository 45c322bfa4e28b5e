// MC_GearInPos: a sync point that is met exactly, and what happens before it.

#include <algorithm>
#include <iterator>

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

// Figure 44: the slave rests, the master runs at constant velocity.
// P1-280, P1-281, P1-285
TEST(GearInPos, TheSlaveIsAtItsSyncPositionWhenTheMasterIs) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(30));
    const auto id = rig.accept(1, gear_in_pos(0, 50, 12, 20, 2, 3));
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    for (Patience patience; patience.lasts(rig.view(0).set_position < 120);) {
        const double before = rig.view(0).set_position;
        rig.step();
        const double master = rig.view(0).set_position;
        if (master < 30) {
            ASSERT_FALSE(rig.view(1).sync_started);
            ASSERT_EQ(rig.view(1).set_velocity, 0);
        } else if (master < 50) {
            ASSERT_TRUE(rig.view(1).sync_started) << master;
            if (before > 30.1) {
                ASSERT_GT(rig.view(1).set_velocity, 0);
            }
        }
        ASSERT_EQ(rig.status(1, id) == CommandStatus::in_target, master >= 50) << master;
        if (master < 50) continue;
        ASSERT_FALSE(rig.view(1).sync_started);
        ASSERT_NEAR(rig.view(1).set_position, 12 + (master - 50) * 2 / 3, 1e-9);
        ASSERT_NEAR(rig.view(1).set_velocity, 20, 1e-9);
    }
    rig.expect_no_jump();
}

// A master that slows down, stands and hurries inside the approach: the point is met all the same.
// P1-280
TEST(GearInPos, AChangingMasterVelocityDoesNotBreakTheSyncPoint) {
    auto master = plain_slave();
    master.limits.jerk = 20000;
    CouplingRig rig({master, plain_slave()});
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto id = rig.accept(1, gear_in_pos(0, 50, -10, 30, -1, 2));
    ASSERT_TRUE(rig.run_until([&] { return rig.view(1).sync_started; }));
    rig.run(200);
    rig.accept(0, halt());
    rig.run(300);
    EXPECT_EQ(rig.view(1).set_velocity, 0);
    EXPECT_TRUE(rig.view(1).sync_started);
    auto gentle = at_velocity(60);
    gentle.acceleration = 100;
    rig.accept(0, gentle);
    ASSERT_TRUE(rig.run_to_sync(1, id));
    for (int i = 0; i < 300; ++i) {
        ASSERT_NEAR(rig.view(1).set_position, -10 - (rig.view(0).set_position - 50) / 2, 1e-9);
        rig.step();
    }
    rig.expect_no_jump();
}

// Both signs of the distance; crossing in the wrong sense is nothing.
// P1-281
TEST(GearInPos, TheStartCountsInTheSenseOfTheDistanceOnly) {
    for (const double sense : {1.0, -1.0}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, absolute(sense * 60, 80));
        rig.run(1200);
        const auto id = rig.accept(1, gear_in_pos(0, sense * 50, sense * 8, sense * 10));  // starts at 40
        rig.accept(0, absolute(sense * 20, 80));                                           // over 40 against the sense
        for (Patience patience; patience.lasts(rig.view(0).active != 0);) {
            rig.step();
            ASSERT_FALSE(rig.view(1).sync_started);
            ASSERT_EQ(rig.view(1).set_position, 0);
        }
        rig.accept(0, absolute(sense * 60, 20));
        ASSERT_TRUE(rig.run_until([&] { return rig.view(1).sync_started; }));
        EXPECT_NEAR(rig.view(0).set_position, sense * 40, 0.03);
        ASSERT_TRUE(rig.run_to_sync(1, id));
        rig.run(1000);
        EXPECT_NEAR(rig.view(1).set_position, sense * 18, 1e-9);
        rig.expect_no_jump();
    }
}

// The motion before goes on until then: a velocity, a move, another coupling.
// P1-281
TEST(GearInPos, TheMotionBeforeGoesOn) {
    {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        rig.accept(1, at_velocity(12));
        rig.run(100);
        const auto id = rig.accept(1, gear_in_pos(0, 60, 40, 30));
        for (Patience patience; patience.lasts(!rig.view(1).sync_started);) {
            rig.step();
            if (!rig.view(1).sync_started) {
                ASSERT_NEAR(rig.view(1).set_velocity, 12, 1e-9);
            }
        }
        ASSERT_TRUE(rig.run_to_sync(1, id));
        EXPECT_NEAR(rig.view(1).set_position, 40 + rig.view(0).set_position - 60, 1e-9);
        rig.expect_no_jump();
    }
    {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        rig.run(50);
        const auto gear = rig.accept(1, gear_in(0, 1, 2));
        ASSERT_TRUE(rig.run_to_sync(1, gear));
        const auto id = rig.accept(1, gear_in_pos(0, 60, 40, 30));
        EXPECT_EQ(rig.status(1, gear), CommandStatus::aborted);
        for (Patience patience; patience.lasts(!rig.view(1).sync_started);) {
            ASSERT_NEAR(rig.view(1).set_velocity, 10, 1e-9);
            rig.step();
        }
        ASSERT_TRUE(rig.run_to_sync(1, id));
        rig.run(100);
        EXPECT_NEAR(rig.view(1).set_position, 40 + rig.view(0).set_position - 60, 1e-9);
        rig.expect_no_jump();
    }
}

// P1-282
TEST(GearInPos, AStopBeforeTheSyncPreventsIt) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto id = rig.accept(1, gear_in_pos(0, 50, 12, 20));
    rig.run(100);
    const auto stopped = rig.accept(1, stop());
    EXPECT_EQ(rig.status(1, id), CommandStatus::aborted);
    rig.run(5);
    EXPECT_EQ(rig.status(1, stopped), CommandStatus::done);
    rig.axes[1].release_stop(stopped, Owner::program);
    rig.run(4000);
    EXPECT_EQ(rig.view(1).state, AxisState::Standstill);
    EXPECT_EQ(rig.view(1).set_position, 0);
}

// Without a distance the approach begins at once, over the whole way to the sync point; a point that the master has passed is an error.
// P1-283
TEST(GearInPos, WithoutADistanceItBeginsAtOnce) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(30));
    rig.run(100);
    const auto id = rig.accept(1, gear_in_pos(0, 40, 10, 0));
    rig.step();
    EXPECT_TRUE(rig.view(1).sync_started);
    ASSERT_TRUE(rig.run_to_sync(1, id));
    EXPECT_NEAR(rig.view(0).set_position, 40, 0.031);
    EXPECT_NEAR(rig.view(1).set_position, 10 + rig.view(0).set_position - 40, 1e-9);
    rig.expect_no_jump();
}

// 30 u of the slave on 10 of the master at 20 u/s: more than 60 u/s on the way. With 50 allowed it is an error, and the slave stops;
// with the axis' 100 and a gentler way it works and keeps what it was given.
// P1-284
TEST(GearInPos, VelocityAndAccelerationOfTheApproachAreKept) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    auto fast = gear_in_pos(0, 30, 30, 10);
    fast.velocity = 50;
    const auto id = rig.accept(1, fast);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, id) == CommandStatus::error; }, 3000));
    EXPECT_EQ(rig.error_of(1, id), ErrorId::sync_impossible);
    rig.run(10);
    EXPECT_EQ(rig.view(1).state, AxisState::Standstill);
    EXPECT_EQ(rig.view(1).set_position, 0);

    auto gentle = gear_in_pos(0, 80, 20, 30);
    gentle.velocity = 40;
    gentle.acceleration = gentle.deceleration = 120;
    const auto next = rig.accept(1, gentle);
    double fastest = 0, hardest = 0;
    for (Patience patience; patience.lasts(rig.status(1, next) != CommandStatus::in_target && rig.view(0).set_position < 100);) {
        rig.step();
        fastest = std::max(fastest, std::abs(rig.view(1).set_velocity));
        hardest = std::max(hardest, std::abs(rig.view(1).set_acceleration));
    }
    EXPECT_EQ(rig.status(1, next), CommandStatus::in_target);
    EXPECT_LE(fastest, 40);
    EXPECT_LE(hardest, 120);
    rig.expect_no_jump();
}

AxisConfig rotary() {
    auto config = plain_slave();
    config.gearing = {.counts_per_revolution = 36000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 360};
    config.modulo = 360;
    config.limits = {.velocity = 1000, .acceleration = 10000, .deceleration = 10000, .jerk = std::numeric_limits<double>::infinity()};
    return config;
}

// Modulo axes: the first sync point farther away than the distance; CatchUp takes the slave's image ahead, SlowDown the one behind.
// P1-288
TEST(GearInPos, ModuloAxesChooseTheirImages) {
    double way[2] = {};
    for (const auto mode : {mcSlowDown, mcCatchUp}) {
        CouplingRig rig({rotary(), rotary()});
        rig.start();
        rig.accept(0, at_velocity(200));
        rig.accept(1, at_velocity(100));
        rig.run(500);  // master about 98, slave about 49.5; at the start 180 and 90: 300 is near to what it would come to, 660 ahead
        auto command = gear_in_pos(0, 120, 300, 300);
        std::get<GearInPosDetails>(command.details).mode = mode;
        const auto id = rig.accept(1, command);
        double master_way = 0, slave_way = 0;
        bool started = false;
        while (rig.status(1, id) != CommandStatus::in_target && master_way < 2000) {
            rig.step();
            master_way += 0.2;
            if (rig.view(1).sync_started) {
                if (!started) {
                    // 120 is nearer than 300: the next turn's, so it starts at 180.
                    EXPECT_NEAR(rig.view(0).set_position, 180, 0.4);
                }
                started = true;
                slave_way += rig.view(1).set_velocity * 1e-3;
            }
        }
        ASSERT_EQ(rig.status(1, id), CommandStatus::in_target);
        EXPECT_NEAR(rig.view(0).set_position, 120, 0.21);
        double apart = rig.view(1).set_position - 300 - (rig.view(0).set_position - 120);
        apart -= 360 * std::round(apart / 360);
        EXPECT_NEAR(apart, 0, 1e-9);
        way[mode == mcCatchUp] = slave_way;
        rig.expect_no_jump();
    }
    EXPECT_NEAR(way[1] - way[0], 360, 1);  // the images are a turn apart
}

/// A way into sync with a master at 200 u/s, 1:1, both modulo 360. It takes 240 u of the master, 1.2 s. Without hurry the slave would go
/// the mean of both velocities for that time; the sync position asked for lies `beyond` u further than that.
struct WayIntoSync {
    static constexpr double master = 200, length = 240, seconds = length / master;

    WayIntoSync(double initial, double beyond, MC_SyncMode mode) {
        CouplingRig rig({rotary(), rotary()});
        rig.start();
        rig.accept(0, at_velocity(master));
        rig.accept(1, at_velocity(initial));
        rig.run(500);
        const auto turn = [](double place) { return place - 360 * std::floor(place / 360); };
        auto command = gear_in_pos(0, turn(rig.view(0).set_position + length),
                                   turn(rig.view(1).set_position + (initial + master) / 2 * seconds + beyond), 0);
        std::get<GearInPosDetails>(command.details).mode = mode;
        const auto id = rig.accept(1, command);
        velocities.push_back(rig.view(1).set_velocity);
        for (int i = 0; i < 1200 && rig.status(1, id) != CommandStatus::in_target; ++i) {
            rig.step();
            velocities.push_back(rig.view(1).set_velocity);
        }
        EXPECT_EQ(rig.status(1, id), CommandStatus::in_target);
        EXPECT_NEAR(velocities.back(), master, 1e-9);
        for (std::size_t i = 1; i < velocities.size(); ++i) {
            const double change = velocities[i] - velocities[i - 1];
            way += (velocities[i] + velocities[i - 1]) / 2 * 1e-3;
            effort += change * change;
        }
        rig.expect_no_jump();
    }
    [[nodiscard]] bool rises() const { return std::is_sorted(velocities.begin(), velocities.end()); }
    [[nodiscard]] bool falls() const { return std::is_sorted(velocities.rbegin(), velocities.rend()); }
    /// Up to one highest velocity, and down from there.
    [[nodiscard]] bool has_one_maximum() const {
        const auto top = std::max_element(velocities.begin(), velocities.end());
        return std::is_sorted(velocities.begin(), top + 1) && std::is_sorted(velocities.rbegin(), std::make_reverse_iterator(top));
    }
    [[nodiscard]] double fastest() const { return *std::max_element(velocities.begin(), velocities.end()); }

    std::vector<double> velocities;
    double way = 0;     ///< u
    double effort = 0;  ///< sum of the squared changes of velocity
};

// Figure 45. 6 u behind where the slave would come to: SlowDown takes that image and only nears the master's velocity; CatchUp takes the
// one a turn further, for which the slave has to get faster than both. From a lower velocity and from a higher one.
// P1-286
TEST(GearInPos, SlowDownNearsTheMastersVelocityAndCatchUpExceedsBoth) {
    for (const double initial : {100.0, 300.0}) {
        const double natural = (initial + 200) / 2 * 1.2;
        const WayIntoSync slow(initial, -6, mcSlowDown), fast(initial, -6, mcCatchUp);
        EXPECT_TRUE(initial < 200 ? slow.rises() : slow.falls()) << initial;
        EXPECT_NEAR(slow.way, natural - 6, 1e-3);
        EXPECT_TRUE(fast.has_one_maximum()) << initial;
        EXPECT_GT(fast.fastest(), std::max(initial, 200.0) + 100);
        EXPECT_NEAR(fast.way, natural + 354, 1e-3);
    }
}

// Figure 47. The slave runs against the master and turns: CatchUp to the upper image, SlowDown to the lower one.
// P1-289
TEST(GearInPos, ASlaveThatRunsAgainstTheMasterTurns) {
    const double natural = (-100.0 + 200) / 2 * 1.2;
    const WayIntoSync slow(-100, -6, mcSlowDown), fast(-100, -6, mcCatchUp);
    EXPECT_NEAR(slow.velocities.front(), -100, 1e-9);
    EXPECT_TRUE(slow.rises());  // from -100 to 200: through zero once
    EXPECT_NEAR(slow.way, natural - 6, 1e-3);
    EXPECT_NEAR(fast.velocities.front(), -100, 1e-9);
    EXPECT_TRUE(fast.has_one_maximum());
    EXPECT_GT(fast.fastest(), 300);
    EXPECT_NEAR(fast.way, natural + 354, 1e-3);
}

// The squared acceleration over the way is a constant for the change of velocity, and grows with the square of the distance between the
// image and the place that the slave would come to anyway. So SlowDown takes less than CatchUp where its image is the nearer one, and
// more where it is not: with images a turn apart, ahead and behind (P1-288), no choice makes it less everywhere. Shortest is the lesser.
// P1-287
TEST(GearInPos, SlowDownTakesLessEnergyWhereItsImageIsTheNearerOne) {
    for (const double initial : {100.0, 300.0, -100.0})
        for (const double behind : {6.0, 90.0, 170.0, 190.0, 270.0}) {
            const WayIntoSync slow(initial, -behind, mcSlowDown), fast(initial, -behind, mcCatchUp), nearest(initial, -behind, mcShortest);
            EXPECT_NEAR(fast.way - slow.way, 360, 1e-3);
            EXPECT_EQ(slow.effort < fast.effort, behind < 180) << initial << " " << behind;
            EXPECT_DOUBLE_EQ(nearest.effort, std::min(slow.effort, fast.effort)) << initial << " " << behind;
            // By parts: v' = 6x(1-x) (d + 10k (1-2x)), k the missing distance per second: the integral is 6/5 d^2 + 120/7 k^2, per second.
            const double d = 200 - initial, k = behind / 1.2;
            EXPECT_NEAR(slow.effort / 1e-3, (6.0 / 5 * d * d + 120.0 / 7 * k * k) / 1.2, 0.01 * slow.effort / 1e-3);
        }
}

// A gear between modulo axes runs over the wrap of both.
TEST(GearInPos, StaysLockedOverTheWrap) {
    CouplingRig rig({rotary(), rotary()});
    rig.start();
    rig.accept(0, at_velocity(700));
    const auto id = rig.accept(1, gear_in_pos(0, 180, 90, 170, 1, 2));
    ASSERT_TRUE(rig.run_to_sync(1, id));
    const double turns = static_cast<double>(rig.view(0).turns);
    for (int i = 0; i < 20000; ++i) {
        rig.step();
        const double master = rig.view(0).set_position + 360 * static_cast<double>(rig.view(0).turns);
        double apart = rig.view(1).set_position - 90 - (master - 180) / 2;
        apart -= 360 * std::round(apart / 360);
        // 180 lies in the first turn or in the next: half a turn of the slave between them.
        ASSERT_NEAR(std::min(std::abs(apart), 180 - std::abs(apart)), 0, 1e-8) << i;
    }
    EXPECT_GT(static_cast<double>(rig.view(0).turns), turns + 30);
    rig.expect_no_jump();
}

// A Jerk that is given limits the way into sync (P1-284). From rest to 20 u/s over 20 u of the master at 20 u/s, 1 s: the slave gains 10 u on that way,
// and x(s) = 10 (2 s^3 - s^4 + 0 s^5) has the jerk 10 (12 - 24 s), at most 120 u/s3.
// P1-284
TEST(GearInPos, AJerkThatIsGivenIsKeptOrTheSyncPointRefused) {
    for (const double jerk : {0.0, 125.0, 115.0}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        rig.run(100);
        auto command = gear_in_pos(0, 50, 10, 20);
        command.jerk = jerk;
        const auto id = rig.accept(1, command);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(1, id) != CommandStatus::active; }));
        EXPECT_EQ(rig.status(1, id), jerk == 115.0 ? CommandStatus::error : CommandStatus::in_target) << jerk;
        if (jerk == 115.0) {
            EXPECT_EQ(rig.error_of(1, id), ErrorId::sync_impossible);
            EXPECT_EQ(rig.view(1).state, AxisState::Standstill);
        }
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
