// An override that is lowered while the next path is prepared already: that one does not begin faster than is wished now.

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// X, then Y from rest, which is prepared while the tool is still on X.
struct TwoLines {
    explicit TwoLines(std::size_t served_every) : rig(3, cartesian_arm()) {
        rig.served_every = served_every;
        rig.enable();
        (void)rig.give(line({20, 0, 0}, 100));
        second = rig.give(line({20, 60, 0}, 100, mcBuffered)).id;
        rig.run(150);
        EXPECT_EQ(rig.axis(1).set_position, 0) << "on the first line still";
        EXPECT_GT(rig.axis(0).set_position, 1);
    }
    double fastest_on_second(int cycles) {
        double most = 0;
        for (int i = 0; i < cycles; ++i) {
            rig.step();
            most = std::max(most, std::abs(rig.axis(1).set_velocity));
        }
        return most;
    }
    GroupRig rig;
    CommandId second = 0;
};

// G-070
TEST(GroupLoweredOverride, HoldsFromTheBeginningOfWhatWaits) {
    for (const std::size_t served_every : {1, 20}) {
        for (const double factor : {0.1, 0.5}) {
            TwoLines two(served_every);
            ASSERT_EQ(two.rig.set(Override{.velocity = factor}), ErrorId::none);
            EXPECT_LE(two.fastest_on_second(3000), factor * 100 * (1 + 1e-6)) << factor;
            EXPECT_GT(two.rig.axis(1).set_position, 20) << factor;
        }
    }
}

// Not even a little: whoever holds the machine by the override reaches into it.
TEST(GroupLoweredOverride, OfNothingHoldsWhatWaitsUntilItRises) {
    for (const std::size_t served_every : {1, 20}) {
        TwoLines two(served_every);
        ASSERT_EQ(two.rig.set(Override{.velocity = 0}), ErrorId::none);
        EXPECT_EQ(two.fastest_on_second(2000), 0);
        EXPECT_EQ(two.rig.view().state, GroupState::GroupMoving);
        ASSERT_EQ(two.rig.set(Override{.velocity = 1}), ErrorId::none);
        EXPECT_TRUE(two.rig.until([&] { return two.rig.status(two.second) == CommandStatus::done; }, 4000));
    }
}

// The acceleration, too: what it was planned with before would be the whole of it.
TEST(GroupLoweredOverride, OfTheAccelerationCountsFromTheBeginningOfWhatWaits) {
    TwoLines two(1);
    ASSERT_EQ(two.rig.set(Override{.velocity = 1, .acceleration = 0.2}), ErrorId::none);
    double most = 0;
    ASSERT_TRUE(two.rig.until([&] { return two.rig.axis(1).set_velocity != 0; }, 2000));
    for (int i = 0; i < 1500; ++i) {
        two.rig.step();
        most = std::max(most, std::abs(two.rig.axis(1).set_acceleration));
    }
    EXPECT_LE(most, 200 * (1 + 1e-6));
    EXPECT_TRUE(two.rig.until([&] { return two.rig.status(two.second) == CommandStatus::done; }, 4000));
}

// An override that never stands still (a wheel that trembles, a ramp in a program) holds nothing up for ever.
TEST(GroupLoweredOverride, ThatTremblesLetsTheNextPathBegin) {
    for (const std::size_t served_every : {1, 7}) {
        TwoLines two(served_every);
        int n = 0;
        EXPECT_TRUE(two.rig.until(
            [&] {
                EXPECT_EQ(two.rig.set(Override{.velocity = 0.5 + 0.01 * ((n * 37) % 11 - 5)}), ErrorId::none);
                ++n;
                return two.rig.status(two.second) == CommandStatus::done;
            },
            6000));
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
