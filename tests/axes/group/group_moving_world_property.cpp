// Every kind of arm on belts and tables, with whatever a careless hand may ask of the group, of its members and of what moves the objects.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/axes/group/moving_world.hpp"

namespace taktwerk::axes::test {
namespace {

int worlds() {
    const char* more = std::getenv("TAKTWERK_CASES");
    return more != nullptr ? std::max(1, std::atoi(more)) : 1;
}

class MovingWorlds : public testing::TestWithParam<JogArm> {};

TEST_P(MovingWorlds, NothingSlipsNothingJumpsNothingHangs) {
    std::size_t compared = 0, reached = 0;
    std::array<int, 1000> errors{};
    for (int seed = 1; seed <= worlds(); ++seed) {
        const char* only = std::getenv("SEED");
        if (only != nullptr && std::atoi(only) != seed) continue;
        SCOPED_TRACE(seed);
        MovingWorld world(GetParam(), static_cast<std::uint32_t>(seed), {.velocity = 100, .acceleration = 250, .deceleration = 250, .jerk = 1000});
        world.troubles = seed % 2 == 0;
        auto before = world.view().state;
        for (int i = 0; i < 12000; ++i) {
            world.live(world.once_in(40) ? world.whole(1, 3) : 0);
            if (world.view().state == GroupState::GroupErrorStop && before != GroupState::GroupErrorStop && world.view().error < 1000) ++errors[world.view().error];
            before = world.view().state;
            if (testing::Test::HasFailure()) { std::cout << "seed " << seed << "\n" << world.story() << std::endl; return; }
        }
        world.calm_down();
        if (testing::Test::HasFailure()) { std::cout << "seed " << seed << "\n" << world.story() << std::endl; return; }
        compared += world.compared;
        reached += world.reached;
    }
    std::cout << GetParam().name << " compared " << compared << " reached " << reached << " errors";
    for (std::size_t i = 0; i < errors.size(); ++i)
        if (errors[i] != 0) std::cout << " " << i << "x" << errors[i];
    std::cout << std::endl;
}
INSTANTIATE_TEST_SUITE_P(Arms, MovingWorlds, testing::ValuesIn(every_kind_of_arm()), [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace taktwerk::axes::test
