// MC_SyncGroupToAxis under a careless hand, on every kind of arm. In each cycle the rig holds the members to their limits and to one motion; the world holds the tool to the program's lines
// and arcs, the path to the master's way where it says InSync, and the block to one output; in the end everything to an end.

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "tests/fb_library/gcode_path/driven_world.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::fb {
namespace {

class DrivenWorlds : public testing::TestWithParam<JogArm> {};
std::string name_of(const testing::TestParamInfo<JogArm>& info) { return info.param.name; }

std::vector<std::uint32_t> seeds() {
    if (const char* one = std::getenv("TAKTWERK_SEED")) return {static_cast<std::uint32_t>(std::atoi(one))};
    std::vector<std::uint32_t> all(property_cases(5));
    std::iota(all.begin(), all.end(), 1);
    return all;
}

// G-093, G-095, G-031. Every other world has troubles too: faults and losses of power of the master and of members, a master that follows another axis.
TEST_P(DrivenWorlds, NothingSlipsNothingJumpsNothingHangs) {
    std::size_t compared = 0, synced = 0;
    for (const auto seed : seeds()) {
        SCOPED_TRACE(seed);
        DrivenWorld world(GetParam(), seed);
        world.troubles = seed % 2 == 0;
        world.calm = seed % 3 == 0 ? 0.1 : 0.4;
        for (int i = 0; i < 6000 && !testing::Test::HasFailure(); ++i) world.live();
        if (!testing::Test::HasFailure()) world.calm_down();
        ASSERT_FALSE(testing::Test::HasFailure()) << world.story();
        compared += world.compared;
        synced += world.synced;
    }
    EXPECT_GT(compared, 500u);
    EXPECT_TRUE(std::getenv("TAKTWERK_SEED") != nullptr || synced > 500u);
}
std::vector<JogArm> arms() {
    std::vector<JogArm> some;
    for (const auto& arm : axes::test::every_kind_of_arm())
        for (const char* name : {"cartesian", "scara", "rotary_delta", "linear_delta", "six_with_wrist", "six_without_wrist"})
            if (arm.name == name) some.push_back(arm);
    return some;
}
INSTANTIATE_TEST_SUITE_P(Arms, DrivenWorlds, testing::ValuesIn(arms()), name_of);

}  // namespace
}  // namespace taktwerk::fb
