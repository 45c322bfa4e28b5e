// The winder by its physics: what goes onto the roll is what the line gives, and the web stays tight when it stands.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::winder_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// Of the machine file and the program.
constexpr double core = 50, thickness = 1, full = 75;    // mm
constexpr double tension = 20, gear = 10, rated = 1.27;  // N, 1, Nm
constexpr double acceleration = 40, ramp = 0.5;          // rad/s2, rated torques per s
constexpr double period = 1e-3;                          // s
constexpr double holding = 10;                           // the program's step

/// The roll by its area: independent of the program, which counts turns.
double radius(double wound) { return std::sqrt(core * core + thickness * wound / std::numbers::pi); }

struct Watch {
    explicit Watch(ExampleMachine& machine) : m(machine) {
        m.each_cycle = [this] { look(); };
    }
    void look() {
        const double line_now = m.place("line"), roll_now = m.place("winder");
        if (seen) {
            wound += radius(line_now - begin) * (roll_now - roll);
            length += line_now - line;
        } else begin = line_now;
        line = line_now, roll = roll_now;
        const auto& axis = m.axis("winder");
        if (seen && powered && axis.powered) {
            largest_kink = std::max(largest_kink, std::abs(axis.set_velocity - velocity));
            largest_torque_step = std::max(largest_torque_step, std::abs(axis.actual_torque - torque));
        }
        powered = axis.powered;
        velocity = axis.set_velocity, torque = axis.actual_torque;
        seen = true;
    }
    double speed_error() const { return m.axis("winder").set_velocity * radius(line - begin) / m.axis("line").set_velocity - 1; }

    ExampleMachine& m;
    double begin = 0, line = 0, roll = 0, wound = 0, length = 0;  // mm, rad, mm, mm
    double velocity = 0, torque = 0, largest_kink = 0, largest_torque_step = 0;
    bool seen = false, powered = false;
};

// From the empty core to the full roll, half as large again: the web comes onto the roll as fast as the line gives it, at any time and in all.
TEST(Winder, WindsAsFastAsTheLineRunsWhileTheRollGrows) {
    ExampleMachine m{"winder"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    ASSERT_TRUE(m.until([&] { return m.axis("line").set_velocity >= 500 - 1e-9; }, 5s)) << m.alarms();
    watch.wound = watch.length = 0;
    double worst = 0;
    const auto look = m.each_cycle;
    m.each_cycle = [&] {
        look();
        if (m.axis("line").set_velocity >= 500 - 1e-9) worst = std::max(worst, std::abs(watch.speed_error()));
    };

    ASSERT_TRUE(m.until([&] { return m.variable("radius") > 65; }, 30s)) << m.variable("radius") << "; alarms " << m.alarms();

    EXPECT_LT(worst, 1e-3) << "web speed over line speed";
    EXPECT_NEAR(watch.wound / watch.length, 1, 5e-4) << "of the mechanics, over " << watch.length << " mm";
    EXPECT_NEAR(m.variable("radius"), radius(watch.line - watch.begin), 0.05);
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

// The line stops: the winder stops with it, and then holds 20 N at the radius it has. What the motor had as torque becomes the holding
// torque over its ramp: no step, and the web does not move. And back again.
TEST(Winder, HoldsTheTensionAtStandstillWithoutAJump) {
    ExampleMachine m{"winder"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    ASSERT_TRUE(m.until([&] { return m.axis("line").set_velocity >= 500 - 1e-9; }, 5s)) << m.alarms();
    m.run(2s);

    m.world().set_input("run", false);
    ASSERT_TRUE(m.until([&] { return m.variable("step") == holding; }, 5s)) << m.alarms();
    const double at = watch.roll;
    watch.largest_torque_step = 0;
    m.run(1s);

    const double wanted = tension * radius(watch.line - watch.begin) / 1000 / gear / rated;
    EXPECT_EQ(m.axis("winder").drive_mode, axes::DriveMode::cyclic_torque);
    EXPECT_NEAR(m.axis("winder").actual_torque, wanted, 0.002);
    EXPECT_NEAR(watch.roll, at, 0.002) << "rad: a tenth of a millimetre of web";

    m.world().set_input("run", true);
    ASSERT_TRUE(m.until([&] { return m.variable("step") != holding; }, 1s)) << m.alarms();
    double handover = 0;  // without the torque that accelerates the roll once it turns
    ASSERT_TRUE(m.until(
        [&] {
            if (m.axis("winder").set_velocity == 0) handover = watch.largest_torque_step;
            return m.axis("winder").set_velocity != 0;
        },
        1s))
        << m.alarms();
    EXPECT_NEAR(watch.roll, at, 0.002);
    EXPECT_LE(handover, ramp * period + 0.003) << "rated torques in a cycle; 0.001 is what the drive shows";
    ASSERT_TRUE(m.until([&] { return m.axis("line").set_velocity >= 500 - 1e-9; }, 5s)) << m.alarms();
    EXPECT_LT(std::abs(watch.speed_error()), 1e-3);
    EXPECT_LE(watch.largest_kink, acceleration * period * 1.000001);
    EXPECT_EQ(m.alarms(), "");
}

TEST(Winder, StopsTheLineWhenTheRollIsFull) {
    ExampleMachine m{"winder"};
    ASSERT_TRUE(m.up());
    Watch watch{m};
    m.set_parameter("largest", 55);

    ASSERT_TRUE(m.until([&] { return m.output("full"); }, 30s)) << m.alarms();
    ASSERT_TRUE(m.until([&] { return m.variable("step") == holding; }, 5s)) << m.alarms();

    EXPECT_THAT(m.alarms(), ::testing::HasSubstr("The roll is full"));
    EXPECT_EQ(m.axis("line").set_velocity, 0);
    // 500 mm/s at 400 mm/s2 and 2000 mm/s3: 500 * (500 / 400 + 400 / 2000) / 2 = 362.5 mm more web.
    EXPECT_NEAR(watch.line - watch.begin, std::numbers::pi * (55 * 55 - core * core) / thickness + 362.5, 5);
    EXPECT_NEAR(watch.wound, watch.length, 1);

    // An empty core: it goes on.
    m.world().set_input("new_core", true);
    m.run(10ms);
    m.world().set_input("new_core", false);
    EXPECT_NEAR(m.variable("radius"), core, 0.01);
    ASSERT_TRUE(m.until([&] { return m.axis("line").set_velocity > 100; }, 5s)) << m.alarms();
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::winder_example
