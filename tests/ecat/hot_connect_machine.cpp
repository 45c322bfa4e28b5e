// Groups that come and go, through real frames.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "ecat/alarms.hpp"
#include "tests/ecat/hot_connect_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::AnyOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t tool_head = 3, tool_servo = 4;

/// Looks at every cycle: whoever is always there is exchanged whenever a frame came back, and nothing is said of anybody.
class Residents {
public:
    explicit Residents(HotConnectBus& bus) : bus_(bus) {
        bus.on_cycle = [this] { look(); };
    }
    [[nodiscard]] const std::vector<AlarmId>& said() const noexcept { return said_; }
    [[nodiscard]] int missed() const noexcept { return missed_; }
    [[nodiscard]] int looked() const noexcept { return looked_; }

private:
    void look() {
        if (bus_.master->phase() != Master::Phase::operational) return;
        ++looked_;
        const bool frames = bus_.master->statistics().lost_in_a_row == 0;
        for (std::size_t slave = 0; slave < 3; ++slave)
            if (frames && !bus_.master->health(slave).fresh) ++missed_;
        for (const auto id : bus_.faults()) said_.push_back(id);
    }
    HotConnectBus& bus_;
    std::vector<AlarmId> said_;
    int missed_ = 0, looked_ = 0;
};

TEST(HotConnect, ABusComesUpWithoutAGroupThatIsAway) {
    HotConnectBus bus;
    bus.plug(false);
    ASSERT_THAT(check(bus.config), IsEmpty());
    const Residents residents{bus};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(5s);
    EXPECT_EQ(bus.presence(), GroupPresence::absent);
    EXPECT_THAT(residents.said(), IsEmpty());
    EXPECT_EQ(residents.missed(), 0);
    EXPECT_GT(residents.looked(), 4000);
    EXPECT_FALSE(bus.master->health(tool_head).fresh);
    EXPECT_FALSE(bus.master->health(tool_servo).fresh);
    EXPECT_TRUE(bus.master->input(tool_servo, 0x6064, 0)) << "its place in the process image is prepared";
}

TEST(HotConnect, AGroupThatIsPluggedInAtTheStartJoinsToo) {
    HotConnectBus bus;
    const Residents residents{bus};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    ASSERT_TRUE(bus.joins()) << ::testing::PrintToString(bus.master->notes());
    EXPECT_THAT(residents.said(), IsEmpty());
    EXPECT_EQ(residents.missed(), 0);
}

class PluggedIn : public ::testing::TestWithParam<Socket> {};

TEST_P(PluggedIn, JoinsWorksAndLeavesWhileNobodyElseNotices) {
    HotConnectBus bus{GetParam()};
    bus.plug(false);
    const Residents residents{bus};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(100ms);
    for (int round = 0; round < 3; ++round) {
        bus.plug(true);
        ASSERT_TRUE(bus.joins()) << ::testing::PrintToString(bus.master->notes());
        const auto target = bus.master->output(tool_servo, 0x607A, 0).value();
        const auto actual = bus.master->input(tool_servo, 0x6064, 0).value();
        const std::int64_t wanted = 123'456 + round;
        write_signal(bus.master->outputs(), target, wanted);
        bus.run_for(10ms);
        EXPECT_TRUE(bus.master->health(tool_head).fresh);
        EXPECT_TRUE(bus.master->health(tool_servo).fresh);
        EXPECT_EQ(read_signal(bus.master->inputs(), actual), wanted);
        bus.run_for(2s);
        EXPECT_EQ(bus.presence(), GroupPresence::present);
        EXPECT_LT(bus.master->statistics().dc_difference_ns, 1000);

        bus.plug(false);
        bus.run_for(5ms);
        EXPECT_EQ(bus.presence(), GroupPresence::absent);
        EXPECT_FALSE(bus.master->health(tool_servo).fresh);
        bus.run_for(1s);
        EXPECT_EQ(bus.presence(), GroupPresence::absent);
    }
    EXPECT_THAT(residents.said(), IsEmpty()) << ::testing::PrintToString(bus.master->notes());
    EXPECT_EQ(residents.missed(), 0);
}
INSTANTIATE_TEST_SUITE_P(HotConnect, PluggedIn, ::testing::Values(Socket::side_of_first, Socket::side_of_last, Socket::end));

}  // namespace
}  // namespace taktwerk::ecat::test
