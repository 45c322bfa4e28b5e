// What may become of the axis that an object goes with: its drive is switched off and on, homed, moved by hand; an encoder trembles, is silent, jumps. Whatever
// that is, an error of the group is one that docs/motion/tracking.md names, and its members stay inside their limits.

#include <gtest/gtest.h>

#include <random>

#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {

bool named_by_tracking(std::uint16_t error) {
    const auto id = static_cast<ErrorId>(error);
    return id == ErrorId::frame_lost || id == ErrorId::frame_too_fast || id == ErrorId::frame_limit;
}

struct Picker : TrackRig {
    explicit Picker(AxisConfig belt = belt_axis()) : TrackRig(3, cartesian_arm(), std::move(belt)) {}
    void pick() {
        ASSERT_EQ(track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
        const auto there = give(on_product(line({0, 0, 4}, 30)));
        ASSERT_EQ(there.error, ErrorId::none);
        ASSERT_TRUE(done(there.id)) << static_cast<int>(error_of(there.id)) << " " << view().error;
    }
    /// It follows, or it is in an error that is named, and stands then.
    void follows_or_says_why(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            step();
            const bool failed = view().state == GroupState::GroupErrorStop;
            ASSERT_TRUE(failed ? named_by_tracking(view().error) : view().state == GroupState::GroupMoving) << view().error;
        }
        const bool failed = view().state == GroupState::GroupErrorStop;
        for (std::size_t i = 0; failed && i < 3; ++i) EXPECT_EQ(axis(i).set_velocity, 0);
    }
};

// G-088: power off and on again while the belt stands: it is the same place.
TEST(GroupTrackingMasters, ABeltThatIsSwitchedOffAndOnAgain) {
    Picker rig;
    rig.run(100);
    ASSERT_NO_FATAL_FAILURE(rig.pick());
    for (int i = 0; i < 3; ++i) {
        rig.powered[rig.last] = false;
        rig.step([&] { (void)rig.axes[rig.last].power(false, true, true, Owner::program); });
        ASSERT_NO_FATAL_FAILURE(rig.follows_or_says_why(200));
        ASSERT_EQ(rig.view().state, GroupState::GroupMoving);
        rig.powered[rig.last] = true;
        ASSERT_NO_FATAL_FAILURE(rig.follows_or_says_why(200));
        ASSERT_EQ(rig.view().state, GroupState::GroupMoving);
        expect_place(rig.on_object(), 0, 0, 4);
    }
}

// Without power somebody pushes it, and power comes on the way.
TEST(GroupTrackingMasters, ABeltThatIsPushedByHandAndSwitchedOn) {
    for (const double push : {0.2, 1.0, 5.0, 20.0}) {
        SCOPED_TRACE(push);
        Picker rig;
        rig.trembles = true;  // without power it is measured
        rig.run(100);
        ASSERT_NO_FATAL_FAILURE(rig.pick());
        rig.powered[rig.last] = false;
        rig.step([&] { (void)rig.axes[rig.last].power(false, true, true, Owner::program); });
        rig.run(100);
        for (int i = 1; i <= 100; ++i) {  // softly
            rig.drives[rig.last]->coasting = push * i / 100;
            rig.step();
        }
        rig.run(100);
        rig.powered[rig.last] = true;
        ASSERT_NO_FATAL_FAILURE(rig.follows_or_says_why(800));
    }
}

// G-088: homing gives the belt's places other numbers, whichever way; by the drive it also moves.
TEST(GroupTrackingMasters, ABeltThatIsHomed) {
    for (const auto kind : {HomingKind::set_here, HomingKind::drive})
        for (const std::int64_t place : {-50, -150, 3000}) {
            SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + " " + std::to_string(place));
            auto belt = belt_axis();
            belt.homing.kind = kind;
            Picker rig(belt);
            rig.run(100);
            ASSERT_NO_FATAL_FAILURE(rig.pick());
            rig.drives[rig.last]->homing_place = place;
            rig.step([&] { ASSERT_EQ(rig.axes[rig.last].submit(home(77), Owner::program).error, ErrorId::none); });
            ASSERT_NO_FATAL_FAILURE(rig.follows_or_says_why(1500));
            EXPECT_TRUE(rig.axis(rig.last).homed);
            if (kind != HomingKind::set_here) continue;
            rig.reference += 77 - 0.0;  // it stood at 0
            EXPECT_EQ(rig.view().state, GroupState::GroupMoving);
            expect_place(rig.on_object(), 0, 0, 4);
        }
}

AxisConfig counter() {
    auto belt = belt_axis();
    belt.encoder = true;
    belt.limits = {.velocity = 100};
    return belt;
}

// G-086: noise of so many u: it is followed, or it is named what cannot be. Of a place that trembles by n the filter makes 0.62 n / T^2 of acceleration at most (the sum of
// the second differences of its answer to one wrong place, two cycles ahead). A member has 1000 u/s2, of which the belt takes 200 and joining 250: 0.88e-3 u.
TEST(GroupTrackingMasters, AnEncoderThatTrembles) {
    for (const double noise : {2e-4, 8e-4, 3e-3, 1e-2, 4e-2}) {
        SCOPED_TRACE(noise);
        auto fine = counter();
        fine.gearing.counts_per_revolution = 1'000'000;
        Picker rig(fine);
        rig.trembles = true;
        std::mt19937 dice(7);
        double velocity = 0, wrong = 0;
        const auto tremble = [&] {
            const double now = std::uniform_real_distribution<double>(-noise, noise)(dice);
            rig.drives[rig.last]->position += 1e5 * (now - wrong);
            wrong = now;
        };
        const auto run = [&](int cycles, double to) {
            for (int i = 0; i < cycles; ++i) {
                velocity += std::clamp(to - velocity, -0.2, 0.2);  // u/s in a cycle: 200 u/s2
                rig.drives[rig.last]->coasting = 1e5 * velocity * 1e-3;
                tremble();
                rig.step();
                ASSERT_TRUE(rig.view().state != GroupState::GroupErrorStop || named_by_tracking(rig.view().error)) << rig.view().error;
            }
        };
        ASSERT_NO_FATAL_FAILURE(run(500, 30));
        ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
        const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
        ASSERT_EQ(there.error, ErrorId::none);
        ASSERT_NO_FATAL_FAILURE(run(1500, 30));
        if (noise < 8.8e-4) {
            EXPECT_EQ(rig.status(there.id), CommandStatus::done) << rig.view().error;
        }
        ASSERT_NO_FATAL_FAILURE(run(600, -20));
        ASSERT_NO_FATAL_FAILURE(run(600, 0));
        if (noise < 8.8e-4) {
            EXPECT_EQ(rig.view().state, GroupState::GroupMoving) << rig.view().error;
        }
    }
}

// G-088: its telegrams stay away, or its place jumps: frame_lost, and at rest without a jump.
TEST(GroupTrackingMasters, AnEncoderThatIsSilentOrJumps) {
    for (const double jump : {0.0, 0.02, 0.1, 0.15, 5.0, 1000.0}) {
        SCOPED_TRACE(jump);
        Picker rig(counter());
        rig.trembles = true;
        rig.drives[rig.last]->coasting = 20;
        rig.run(500);
        ASSERT_NO_FATAL_FAILURE(rig.pick());
        if (jump == 0) rig.drives[rig.last]->silent = true;
        else rig.drives[rig.last]->position += 1000 * jump;
        ASSERT_NO_FATAL_FAILURE(rig.follows_or_says_why(3000));
        if (jump == 0 || jump > 1) {
            EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_lost));
        }
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
