// Every kind of arm on belts and tables, with whatever a careless hand may ask of the group, of its members and of what moves the objects, at any moment. In each
// cycle the rig holds the members to their limits and to one motion, told to shown; the world holds the tool to the object and the path, Done to the target, and in
// the end everything to an end. docs/motion/tracking.md, "What is guaranteed".

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "tests/axes/group/moving_world.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr AxisLimits calm_master{.velocity = 100, .acceleration = 250, .deceleration = 250, .jerk = 1000};

class MovingWorlds : public testing::TestWithParam<JogArm> {};
std::string name_of(const testing::TestParamInfo<JogArm>& info) { return info.param.name; }

/// TAKTWERK_SEED: that one alone.
std::vector<std::uint32_t> seeds() {
    if (const char* one = std::getenv("TAKTWERK_SEED")) return {static_cast<std::uint32_t>(std::atoi(one))};
    std::vector<std::uint32_t> all(property_cases(2));
    std::iota(all.begin(), all.end(), 1);
    return all;
}

// G-083, G-085 .. G-088, G-092. Every other world has troubles too: faults and losses of power of members, belt and table.
TEST_P(MovingWorlds, NothingSlipsNothingJumpsNothingHangs) {
    std::size_t compared = 0, reached = 0;
    for (const auto seed : seeds()) {
        SCOPED_TRACE(seed);
        MovingWorld world(GetParam(), seed, calm_master);
        world.troubles = seed % 2 == 0;
        for (int i = 0; i < 4000 && !testing::Test::HasFailure(); ++i) {
            world.live();
            const auto why = static_cast<ErrorId>(world.view().error);
            const bool known = world.troubles || world.view().state != GroupState::GroupErrorStop || why == ErrorId::frame_limit ||
                               why == ErrorId::frame_too_fast;
            EXPECT_TRUE(known) << world.view().error << "\n" << world.story();
        }
        if (!testing::Test::HasFailure()) world.calm_down();
        ASSERT_FALSE(testing::Test::HasFailure()) << world.story();
        compared += world.compared;
        reached += world.reached;
    }
    EXPECT_GT(compared, 100u);
    RecordProperty("compared", static_cast<int>(compared));
    RecordProperty("reached", static_cast<int>(reached));
}
INSTANTIATE_TEST_SUITE_P(Arms, MovingWorlds, testing::ValuesIn(every_kind_of_arm()), name_of);

// The same hand does the same to another world: the same bits of each member, belt and table in each cycle.
TEST(MovingWorld, TheSameHandMakesTheSameBits) {
    const auto arm = every_kind_of_arm()[3];
    MovingWorld one(arm, 7, calm_master), other(arm, 7, calm_master);
    one.troubles = other.troubles = true;
    for (int i = 0; i < 2500; ++i) {
        one.live();
        other.live();
        ASSERT_EQ(one.path.back(), other.path.back()) << one.story();
        ASSERT_EQ(one.view().active, other.view().active);
    }
    EXPECT_GT(one.compared, 0u);
}

}  // namespace
}  // namespace taktwerk::axes::test
