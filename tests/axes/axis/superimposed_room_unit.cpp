// The axis' velocity holds for the sum of base and addition in both senses: what an addition does that has no room, that gets room, and that turns
// round. 100 u/s, 1000 u/s2, 20000 u/s3. The rig's oracle watches the sum in every cycle.

#include <functional>

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// The base runs at the whole limit in the sense 1 or -1 and an addition in the same sense waits beside it.
struct Waiting {
    explicit Waiting(double sense) : speed(at_velocity(sense * 100)) {
        rig.power_on();
        base = rig.accept(speed);
        rig.run(400);
        addition = rig.accept(on_top(sense * 5, 20));
        rig.run(200);
        EXPECT_EQ(rig.status(addition), CommandStatus::active);
        EXPECT_EQ(rig.view().superimposed_covered, 0);
    }
    void expect_done(double sense) {
        // 5 u at 20 u/s, or at 10 with the override, are 0.5 s, and some for the ramps of both.
        EXPECT_TRUE(rig.run_until([&] { return rig.status(addition) == CommandStatus::done; }, 800));
        EXPECT_NEAR(rig.view().superimposed_covered, sense * 5, 1e-9);
        EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
    }
    Rig rig;
    AxisCommand speed;
    CommandId base = 0, addition = 0;
};

// -60 u are on their way when they become -0.1: the addition cannot stop there, comes back in the sense of the base, which uses all there is, and
// waits where it has come to rest. Once the base leaves room it goes back the way it went too far.
TEST(SuperimposedRoom, AnOvershotWayGoesBackOnlyWhereThereIsRoom) {
    for (const double sense : {1.0, -1.0})
        for (const double velocity : {50.0, 100.0}) {
            Rig rig;
            rig.power_on();
            rig.accept(at_velocity(sense * 100));
            rig.run(400);
            rig.accept(on_top(sense * -60, velocity));
            rig.run(250);
            const auto shorter = rig.accept(on_top(sense * -0.1, velocity));
            rig.run(1500);
            EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
            EXPECT_NEAR(rig.view().set_velocity, sense * 100, 1e-9);
            EXPECT_EQ(rig.status(shorter), CommandStatus::active);
            EXPECT_LT(sense * rig.view().superimposed_covered, -1);

            rig.accept(at_velocity(sense * 40));
            const auto again = rig.accept(on_top(sense * -0.1, velocity));
            EXPECT_TRUE(rig.run_until([&] { return rig.status(again) == CommandStatus::done; }, 1000));
            EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
        }
}

// Likewise on a table over time, whose rows nobody can slow down: it waits until the rows leave room.
TEST(SuperimposedRoom, AnOvershotWayOnATableWaitsForTheRowsThatLeaveRoom) {
    MotionTables tables;
    const auto table = tables.add_time_table(std::vector<TimePoint>{{300ms, 95.0}, {1s, 95.0}, {200ms, 30.0}, {2s, 30.0}}, 8);
    Rig rig;
    rig.axis.bind({&rig.axis, 1, &tables, {}});
    rig.power_on();
    rig.accept({.kind = CommandKind::velocity_profile, .details = TimeProfileDetails{table, 1, 1, 0}});
    rig.run(500);
    rig.accept(on_top(-60, 100));
    rig.run(250);
    const auto shorter = rig.accept(on_top(-0.1, 100));
    rig.run(500);
    EXPECT_EQ(rig.status(shorter), CommandStatus::active);  // 5 u/s for the 10 u and more
    EXPECT_TRUE(rig.run_until([&] { return rig.status(shorter) == CommandStatus::done; }, 700));
    EXPECT_NEAR(rig.view().superimposed_covered, -0.1, 1e-9);
    EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
}

TEST(SuperimposedRoom, AWaitingOneBeginsWhenTheBaseGetsSlowerForWhateverReason) {
    const std::array<std::function<void(Waiting&, double)>, 4> slower{
        [](Waiting& it, double sense) {
            it.speed.velocity = sense * 50;
            EXPECT_EQ(it.rig.axis.update(it.base, it.speed, Owner::program), ErrorId::none);
        },
        [](Waiting& it, double sense) { it.rig.accept(at_velocity(sense * 50, mcBuffered)); },
        [](Waiting& it, double) {
            EXPECT_EQ(it.rig.axis.set(Override{0.5, 1, 1}, Owner::program), ErrorId::none);
        },
        [](Waiting& it, double sense) { it.rig.accept(at_velocity(sense * -100, mcBuffered)); },
    };
    for (std::size_t i = 0; i < slower.size(); ++i)
        for (const double sense : {1.0, -1.0}) {
            SCOPED_TRACE(i);
            Waiting it(sense);
            slower[i](it, sense);
            it.expect_done(sense);
        }
}

TEST(SuperimposedRoom, AWaitingOneBeginsWhenTheAxisMayBeFaster) {
    Rig rig;
    rig.power_on();
    ASSERT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 50}, Owner::program), ErrorId::none);
    rig.accept(at_velocity(50));
    rig.run(400);
    const auto addition = rig.accept(on_top(5, 20));
    rig.run(300);
    ASSERT_EQ(rig.status(addition), CommandStatus::active);
    ASSERT_EQ(rig.view().superimposed_covered, 0);
    ASSERT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 100}, Owner::program), ErrorId::none);
    EXPECT_TRUE(rig.run_until([&] { return rig.status(addition) == CommandStatus::done; }, 500));
}

TEST(SuperimposedRoom, AWaitingOneBeginsWhenTheMasterGetsSlowerOrTurns) {
    for (const double later : {50.0, -100.0}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(100));
        rig.accept(1, gear_in(0));
        rig.run(500);
        const auto addition = rig.accept(1, on_top(5, 20));
        rig.run(300);
        ASSERT_EQ(rig.status(1, addition), CommandStatus::active);
        rig.accept(0, at_velocity(later));
        EXPECT_TRUE(rig.run_until([&] { return rig.status(1, addition) == CommandStatus::done; }, 700)) << later;
        EXPECT_NEAR(rig.view(1).superimposed_covered, 5, 1e-9);
        rig.expect_clean();
    }
}

TEST(SuperimposedRoom, AWaitingOneBeginsWhenAFeedGetsSlower) {
    Rig rig;
    rig.power_on();
    rig.accept({.kind = CommandKind::external});
    rig.run(2);
    double position = 0, velocity = 0;
    int scans = 0;
    rig.program = [&] {
        const double wanted = ++scans < 400 ? 100 : 50;
        const double next = velocity < wanted ? std::min(velocity + 0.9, wanted) : std::max(velocity - 0.9, wanted);
        position += (velocity + next) / 2 * 1e-3;
        velocity = next;
        ASSERT_EQ(rig.axis.set(SetpointFeed{position, velocity, 0}, Owner::program), ErrorId::none) << scans;
    };
    rig.run(300);
    const auto addition = rig.accept(on_top(5, 20));
    rig.run(90);
    EXPECT_EQ(rig.view().superimposed_covered, 0);
    EXPECT_TRUE(rig.run_until([&] { return rig.status(addition) == CommandStatus::done; }, 600));
}

// 10 of 80 u/s are left when it begins. Then the base slows down to 20 and leaves all 80: it takes them.
TEST(SuperimposedRoom, OneThatBeganWithLittleRoomTakesWhatItGets) {
    for (const bool coupled : {false, true}) {
        CouplingRig rig({plain_axis(), plain_axis()});
        rig.start();
        rig.accept(0, at_velocity(90));
        if (coupled) rig.accept(1, gear_in(0));
        rig.run(500);
        const std::size_t axis = coupled ? 1 : 0;
        const auto addition = rig.accept(axis, on_top(50, 80));
        rig.run(300);
        EXPECT_NEAR(rig.view(axis).set_velocity, 100, 1e-6);
        const double slow = rig.view(axis).superimposed_covered;
        EXPECT_NEAR(slow, 3, 0.5);
        rig.accept(0, at_velocity(20, mcBuffered));  // an aborting one would end the addition
        // 47 u at 80 u/s are 0.6 s; at 10 u/s they were 4.7 s.
        EXPECT_TRUE(rig.run_until([&] { return rig.status(axis, addition) == CommandStatus::done; }, 900)) << coupled;
        EXPECT_GT(rig.traces[axis].largest_velocity, 99);
        rig.expect_clean();
    }
}

// A base at 60 is speeding up to 100 again with less jerk than its acceleration was made with, while the addition takes the rest: what the base
// cannot help gaining counts, and what the addition cannot.
TEST(SuperimposedRoom, ABaseThatIsUpdatedWithLessJerkLeavesRoomForWhatTheAdditionStillGains) {
    for (int later = 60; later < 130; ++later) {
        Rig rig;
        rig.power_on();
        const auto base = rig.accept(at_velocity(67));
        rig.run(34);
        rig.accept(on_top(22, 40));
        rig.run(later - 34);
        auto gentle = at_velocity(-30);
        gentle.jerk = 13983;
        ASSERT_EQ(rig.axis.update(base, gentle, Owner::program), ErrorId::none);
        rig.run(400);
        ASSERT_LE(rig.largest_velocity, 100 * (1 + 1e-9)) << later;
    }
}

// The limit was lowered to 50 u/s below a base at 80, which comes down with 100 u/s2 only. An addition against it would be slow at its end, and the
// sum fast again: it waits until the base is inside the limit.
TEST(SuperimposedRoom, NothingBeginsOnTopOfABaseBeyondTheLimit) {
    for (const double sense : {1.0, -1.0}) {
        Rig rig;
        rig.power_on();
        auto base = at_velocity(sense * 80);
        base.deceleration = 100;
        rig.accept(base);
        rig.run(400);
        ASSERT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 50}, Owner::program), ErrorId::none);
        ASSERT_EQ(rig.axis.set(Override{.velocity = 0.9}, Owner::program), ErrorId::none);
        const auto addition = rig.accept(on_top(sense * -0.3, 20));
        double before = 80;
        for (int i = 0; i < 600; ++i) {
            rig.step();
            const double speed = sense * rig.view().set_velocity;
            EXPECT_LE(speed, std::max(50.0, before) * (1 + 1e-9)) << i;
            before = speed;
        }
        EXPECT_EQ(rig.status(addition), CommandStatus::done);
        EXPECT_NEAR(before, 45, 1e-9);
    }
}

// An addition of 80 u/s is faster than the limit since that was lowered to 50 u/s. What its base wants in the other sense, or no more, waits for no
// room: a jog whose lease is over ends.
TEST(SuperimposedRoom, AJogEndsAlsoAgainstAnAdditionThatIsBeyondTheLimit) {
    for (const double sense : {1.0, -1.0}) {
        Rig rig;
        rig.power_on();
        const auto back = rig.accept(jog(sense * -10));
        rig.run(50);
        const auto addition = rig.accept(on_top(sense * 30, 80));
        rig.run(140);  // of a lease of 200 ms
        ASSERT_GT(sense * rig.view().set_velocity, 60);
        ASSERT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 50}, Owner::program), ErrorId::none);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(addition) == CommandStatus::done; }, 2000));
        EXPECT_TRUE(rig.run_until([&] { return rig.status(back) == CommandStatus::error; }, 100));
        EXPECT_EQ(rig.view().state, AxisState::Standstill);
    }
}

// The master speeds up while an addition does, which is quicker by far than the slave slows down: the room for it was measured when it began.
TEST(SuperimposedRoom, ASlaveGetsNoFasterThanTheAdditionThatSpeedsUpLeavesRoomFor) {
    for (const double sense : {1.0, -1.0}) {
        for (int instant = 100; instant < 400; instant += 20) {
            auto master = plain_slave(), slave = plain_slave();
            master.limits.acceleration = 48;
            slave.limits = {.velocity = 20, .acceleration = 30'000, .deceleration = 50, .jerk = 3e6};
            CouplingRig rig({master, slave});
            rig.start();
            rig.accept(1, gear_in(0));
            rig.accept(0, at_velocity(sense * 100));
            rig.run(instant);
            const auto addition = rig.accept(1, on_top(sense * 3, 0));
            double fastest = 0;
            for (int i = 0; i < 400; ++i) {
                rig.step();
                fastest = std::max(fastest, std::abs(rig.view(1).set_velocity));
            }
            EXPECT_LE(fastest, 20 * (1 + 1e-9)) << "sense " << sense << " after " << instant;
            EXPECT_GT(rig.view(1).superimposed_covered * sense, 0) << addition;
        }
    }
}

// A slave and its addition speed up together; then they are one motion at a velocity, whose jerk could not release that below the limit.
TEST(SuperimposedRoom, WhatASlaveAndItsAdditionHadIsReleasedBelowTheLimit) {
    for (const double sense : {1.0, -1.0}) {
        for (int instant = 5; instant < 80; instant += 5) {
            auto master = plain_slave(), slave = plain_slave();
            master.limits.acceleration = 200;
            slave.limits = {.velocity = 20, .acceleration = 1000, .deceleration = 1000, .jerk = 3000};
            CouplingRig rig({master, slave});
            rig.start();
            rig.accept(1, gear_in(0));
            rig.run(20);
            rig.accept(0, at_velocity(sense * 100));
            rig.run(20);
            rig.accept(1, on_top(sense * 20, 0));
            rig.run(instant);
            rig.accept(1, at_velocity(sense * 15));
            double fastest = 0;
            for (int i = 0; i < 300; ++i) {
                rig.step();
                fastest = std::max(fastest, std::abs(rig.view(1).set_velocity));
            }
            EXPECT_LE(fastest, 20 * (1 + 1e-9)) << "sense " << sense << " after " << instant;
        }
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
