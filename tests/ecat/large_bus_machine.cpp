// 64 servos with mailbox, distributed clock and SYNC0 come up within ten seconds of machine time. The simulated EEPROM is busy for
// 100 us a read, a transition takes 200 us, a mailbox answer 200 us (sim::SlaveOptions); the cycle is 1 ms, so that every
// acyclic datagram takes at least a cycle there and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

TEST(LargeBus, SixtyFourServosReachOpWithinTenSeconds) {
    TestBus bus{std::string(64, 's')};
    bus.start();
    std::array<Instant, 10> entered{};
    const auto begun = bus.now;
    bus.run_until(
        [&] {
            auto& at = entered[static_cast<std::size_t>(bus.master->phase())];
            if (at == Instant{}) at = bus.now;
            return bus.master->phase() == Master::Phase::operational || bus.master->phase() == Master::Phase::failed;
        },
        60s);
    ASSERT_EQ(bus.master->phase(), Master::Phase::operational) << bus.why();

    const auto seconds = [&](Master::Phase phase) { return to_seconds(entered[static_cast<std::size_t>(phase)] - begun); };
    std::printf("64 servos: PREOP asked for after %.2f s, configuring from %.2f s, SAFEOP from %.2f s, OP after %.2f s\n",
                seconds(Master::Phase::preop), seconds(Master::Phase::configuring), seconds(Master::Phase::safeop),
                seconds(Master::Phase::operational));
    EXPECT_LE(seconds(Master::Phase::operational), 10.0);
    for (std::size_t s = 0; s < 64; ++s) {
        EXPECT_EQ(bus.state(s), sim::EsmState::op);
        EXPECT_TRUE(bus.master->health(s).fresh);
    }
}

// 150 terminals there and back take longer than the cycle (simulated: 1.16 us each and 174 us in all): the cycle is named, and no slave.
TEST(LargeBus, ACycleThatIsTooShortForTheWayIsNamedInsteadOfASlave) {
    TestBus bus{std::string(150, 't'), 125us};
    bus.start();
    bus.run_until([&] { return bus.master->phase() == Master::Phase::operational || bus.master->phase() == Master::Phase::failed; }, 60s);
    ASSERT_EQ(bus.master->phase(), Master::Phase::failed);
    const auto& error = bus.master->failure();
    EXPECT_EQ(error.code, "bus.no_frame") << error.text();
    EXPECT_EQ(error.subject, "bus");
    EXPECT_THAT(error.what, ::testing::HasSubstr("does not come back within the cycle of 125 us: 2 frame(s) of"));
    EXPECT_THAT(error.what, ::testing::HasSubstr("pass 150 slaves"));
    EXPECT_THAT(error.remedy, ::testing::HasSubstr("the cycle is too short for this bus"));
}

}  // namespace
}  // namespace taktwerk::ecat::test
