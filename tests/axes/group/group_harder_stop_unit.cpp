// Who brakes softly already is stopped harder by whoever wants that, and never softer.

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr PathDynamics soft{.deceleration = 20, .jerk = 500}, hard{.deceleration = 800, .jerk = 10000};

/// Cruises at 50 u/s; 300 cycles behind the first the second comes. From there: u to rest.
struct Cruise {
    Cruise() : rig(3, cartesian_arm()) {
        rig.enable();
        auto far = line({2000, 0, 0}, 50);
        far.dynamics.deceleration = soft.deceleration;
        far.dynamics.jerk = soft.jerk;
        (void)rig.give(far);
        rig.run(1500);
    }
    double stop_now() {
        rig.run(300);
        const double from = rig.axis(0).set_position;
        EXPECT_GT(rig.axis(0).set_velocity, 45);
        EXPECT_EQ(rig.give(simply(GroupCommandKind::stop, hard)).error, ErrorId::none);
        return rest() - from;
    }
    double rest() {
        EXPECT_TRUE(rig.until([&] { return rig.axis(0).set_velocity == 0; }, 20000));
        return rig.axis(0).set_position;
    }
    GroupRig rig;
};

// G-063, G-065
TEST(GroupHarderStop, NeedsNoMoreOfTheWayBehindASoftHaltThanOutOfACruise) {
    // v2/2a + va/2j = 3.6 u, and what it goes until the planner has answered: 70 ms at most, by group-decisions.md.
    const double most = 3.6 + 50 * 0.07;
    Cruise out_of_it;
    EXPECT_LE(out_of_it.stop_now(), most);
    for (const auto first : {GroupCommandKind::halt, GroupCommandKind::interrupt}) {
        Cruise cruise;
        ASSERT_EQ(cruise.rig.give(simply(first, soft)).error, ErrorId::none);
        EXPECT_LE(cruise.stop_now(), most) << static_cast<int>(first);
    }
    Cruise held;
    ASSERT_EQ(held.rig.set(Override{.velocity = 0}), ErrorId::none);
    EXPECT_LE(held.stop_now(), most) << "an override of 0";
}

// A program may halt as softly as it likes; a person's stop, a program's end, another mode do not wait for that.
TEST(GroupHarderStop, TheMachinesHandDoesNotWaitForASoftHalt) {
    for (const auto first : {GroupCommandKind::halt, GroupCommandKind::interrupt, GroupCommandKind::stop, GroupCommandKind::disable}) {
        Cruise cruise;
        ASSERT_EQ(cruise.rig.give(simply(first, soft)).error, ErrorId::none);
        cruise.rig.run(first == GroupCommandKind::disable ? 20 : 300);
        const double from = cruise.rig.axis(0).set_position;
        EXPECT_GT(cruise.rig.axis(0).set_velocity, 45);
        cruise.rig.step([&] { cruise.rig.groups[0].halt(); });
        // By the axes' limits: v2/2a + va/2j = 3.8 u.
        EXPECT_LE(cruise.rest() - from, 3.8 + 50 * 0.07) << static_cast<int>(first);
    }
}

TEST(GroupHarderStop, ASofterOneLengthensNothing) {
    Cruise alone, both;
    (void)alone.rig.give(simply(GroupCommandKind::halt, hard));
    (void)both.rig.give(simply(GroupCommandKind::halt, hard));
    alone.rig.run(60);
    both.rig.run(60);
    EXPECT_GT(both.rig.axis(0).set_velocity, 5);
    (void)both.rig.give(simply(GroupCommandKind::halt, soft));
    EXPECT_NEAR(both.rest(), alone.rest(), 1e-9);
}

}  // namespace
}  // namespace taktwerk::axes::test
