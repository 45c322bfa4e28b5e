// A TSVM-D6 in a ring of two interfaces, from a machine file: the drive alarms when one of its links changes (manual V1.1, 7.1: common alarm 22,
// 603Fh = 92, all six axes), and a reset clears that, also while the ring is still broken.

#include <gmock/gmock.h>

#include "config/machine_file/machine_loader.hpp"
#include "ecat/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk {
namespace {

using namespace std::chrono_literals;
using runtime::OperatorAction;

runtime::MachineConfig robot_in_a_ring() {
    const std::string text =
        "version: 1\nname: ring\ncycle: 1 ms\nbus:\n  interface: simulated\n  ring: { interface2: simulated }\n  slaves:\n"
        "    - { name: robot, profile: tsvm-d6 }\n    - { name: x_drive, profile: sv33-e }\n    - { name: y_drive, profile: sv33-e "
        "}\naxes:\n"
        "  j1: { slave: robot, axis: 1, unit: deg, gearing: { counts_per_revolution: 131072, gear: 80/1, feed: 360 deg }, "
        "limits: { velocity: 180 deg/s, acceleration: 900 deg/s2, jerk: 18000 deg/s3 }, following_error: { window: 2 deg, time: 10 ms }, "
        "homing: { kind: set_here } }\n"
        "  x: { slave: x_drive, unit: mm, gearing: { counts_per_revolution: 131072, feed: 10 mm }, "
        "limits: { velocity: 200 mm/s, acceleration: 2000 mm/s2, jerk: 40000 mm/s3 }, homing: { kind: set_here } }\n"
        "  y: { slave: y_drive, unit: mm, gearing: { counts_per_revolution: 131072, feed: 10 mm }, "
        "limits: { velocity: 200 mm/s, acceleration: 2000 mm/s2, jerk: 40000 mm/s3 }, homing: { kind: set_here } }\n";
    config::LoadOptions options;
    options.simulate = true;
    options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
    auto loaded = config::load_machine_text("ring.yaml", text, options);
    if (const auto* errors = std::get_if<1>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    return std::move(std::get<0>(loaded).machine);
}

TEST(TsvmInARing, ABreakBesideTheDriveIsItsLinkAlarmAndAResetClearsIt) {
    runtime::testing::TestMachine m{robot_in_a_ring()};
    ASSERT_TRUE(m.up()) << m.alarms();
    for (std::uint16_t i = 0; i < 3; ++i) {
        m.enable(i);
        m.home(i);
    }
    m.run(500ms);
    for (std::uint16_t i = 1; i < 3; ++i)
        ASSERT_EQ(m.command(OperatorAction::move_absolute, i, false, 400, 20).answer, runtime::Answer::accepted);
    m.run(300ms);

    m.world.set_cable("y_drive", false);  // between the two others: no link of the robot changes
    m.run(300ms);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Standstill) << m.alarms();
    m.world.set_cable("y_drive", true);
    m.run(300ms);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Standstill) << m.alarms();

    m.world.set_cable("x_drive", false);
    m.run(300ms);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::ErrorStop);
    EXPECT_THAT(m.alarms(), ::testing::HasSubstr("bus link changed")) << "the drive's own words";
    EXPECT_TRUE(m.has_alarm(id(ecat::BusAlarm::ring_broken)));
    for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(m.axis(i).state, axes::AxisState::DiscreteMotion) << i;

    // Cleared with the ring still broken; and once more when it has been mended, for that is a changed link, too.
    for (const bool mended : {false, true}) {
        if (mended) m.world.set_cable("x_drive", true);
        m.run(300ms);
        (void)m.command(OperatorAction::reset);
        ASSERT_TRUE(m.until([&] { return m.axis(0).state == axes::AxisState::Disabled; }, 3s)) << m.alarms();
        m.enable(0);
        ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, mended ? 0 : 20, 30).answer, runtime::Answer::accepted);
        m.run(1s);
        EXPECT_EQ(m.axis(0).state, axes::AxisState::Standstill) << m.alarms();
        for (std::size_t i = 1; i < 3; ++i) EXPECT_EQ(m.axis(i).state, axes::AxisState::DiscreteMotion) << i;
    }
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk
