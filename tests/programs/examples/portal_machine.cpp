// The portal by its physics: its sides stay together, its tool never falls, and it stops as the machine file says.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::portal_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

/// mm: how much further the right side, which is mirrored, is than the left one. 131072 counts * 5 are 100 mm.
double apart(ExampleMachine& m) {
    constexpr double counts_per_mm = 131072.0 * 5 / 100;
    return (-m.world().drive("portal.follower")->plant().position() - m.world().drive("portal")->plant().position()) / counts_per_mm;
}

TEST(PortalExample, CarriesItsToolAndTheSidesStayTogether) {
    ExampleMachine m{"portal"};
    ASSERT_TRUE(m.up());
    EXPECT_NEAR(apart(m), 0.4, 0.01) << "as somebody has left it";
    ASSERT_TRUE(m.until([&] { return m.axis("portal").homed; }, 30s)) << m.alarms();
    EXPECT_NEAR(apart(m), 0, 0.015) << "square: 5 mm/s at the edges are 5 um a cycle";
    double widest = 0, lowest = 0;
    bool told_open_without_power = false;
    m.each_cycle = [&] {
        widest = std::max(widest, std::abs(apart(m)));
        lowest = std::min(lowest, m.place("tool"));
        told_open_without_power =
            told_open_without_power || (m.output("tool_brake") && m.axis("tool").drive_state != axes::PowerState::enabled);
    };
    ASSERT_TRUE(m.until([&] { return m.variable("visits") >= 3; }, 60s)) << m.alarms();

    EXPECT_LT(widest, 0.5);
    EXPECT_GT(lowest, -100.5) << "it goes down 100 mm and hangs there on its brake";
    EXPECT_FALSE(told_open_without_power);
    EXPECT_EQ(m.alarms(), "");
}

// Down there the brake is closed, whatever the drive does.
TEST(PortalExample, HangsOnItsBrakeWhileItPauses) {
    ExampleMachine m{"portal"};
    ASSERT_TRUE(m.up());
    m.set_parameter("pause", 5);
    ASSERT_TRUE(m.until([&] { return m.axis("tool").set_position == -100 && !m.output("tool_brake"); }, 30s)) << m.alarms();
    m.run(200ms);
    EXPECT_TRUE(m.world().drive("tool")->brake_closed());
    EXPECT_EQ(m.axis("tool").drive_state, axes::PowerState::enabled);
    const double there = m.place("tool");
    m.run(2s);
    EXPECT_NEAR(m.place("tool"), there, 0.01);
}

// The right side is blocked in motion: beyond 2 mm both drives stop by their quick stop, as `reactions` says, and lose their power.
TEST(PortalExample, ABlockedSideStopsBoth) {
    ExampleMachine m{"portal"};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis("portal").set_velocity > 390; }, 30s)) << m.alarms();
    m.world().drive("portal.follower")->jam(true);
    bool quick_stop = false;
    m.each_cycle = [&] { quick_stop = quick_stop || m.axis("portal").drive_state == axes::PowerState::quick_stop; };
    ASSERT_TRUE(m.until([&] { return m.axis("portal").state == axes::AxisState::ErrorStop; }, 1s));
    EXPECT_THAT(m.alarms(), ::testing::HasSubstr("apart, more than 2 mm"));
    ASSERT_TRUE(m.until([&] { return m.axis("portal").drive_state == axes::PowerState::disabled; }, 5s));
    EXPECT_TRUE(quick_stop);
}

}  // namespace
}  // namespace taktwerk::portal_example
