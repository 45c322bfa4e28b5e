// The whole way from an unknown bus to OP, against simulated slaves that answer only to frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::HasSubstr;

class BringUpOf : public ::testing::TestWithParam<const char*> {};

TEST_P(BringUpOf, EndsInOpWithEverySlaveFreshAndSynchronised) {
    TestBus bus{GetParam()};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(200ms);

    for (std::size_t i = 0; i < bus.config.slaves.size(); ++i) {
        EXPECT_EQ(bus.state(i), sim::EsmState::op) << i;
        EXPECT_TRUE(bus.master->health(i).fresh) << i;
        EXPECT_EQ(bus.master->health(i).al_state, AlState::op) << i;
    }
    EXPECT_EQ(bus.master->statistics().frames_lost, 0u);
    EXPECT_EQ(bus.master->statistics().working_counter_errors, 0u);
    EXPECT_LE(bus.now, Instant{} + 5s);
}

INSTANTIATE_TEST_SUITE_P(Lines, BringUpOf, ::testing::Values("s", "t", "ss", "st", "ts", "sts", "sstt"));

}  // namespace
}  // namespace taktwerk::ecat::test
