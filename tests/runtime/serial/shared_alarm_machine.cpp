// An alarm of a whole drive concerns the axes of that drive only: two axes that are on no bus are two drives.

#include "axes/axis/alarms.hpp"
#include "tests/axes/drives/xp200/plain_profile.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;
constexpr std::uint16_t axis_u = 1, axis_v = 2, axis_w = 3;

AxisBinding axis(const std::string& name) {
    AxisBinding binding;
    binding.axis.name = name;
    binding.axis.gearing = {.counts_per_revolution = 10000, .feed = 10};
    binding.axis.limits = {.velocity = 100,
                           .acceleration = 200,
                           .deceleration = 200,
                           .jerk = std::numeric_limits<double>::infinity(),
                           .stop_deceleration = 400};
    binding.axis.homing.kind = axes::HomingKind::set_here;
    return binding;
}

/// x on the bus; u and v are drives at two stations of one line; w is virtual. Alarm 12 is one of a whole drive here.
MachineConfig three_off_the_bus() {
    auto m = machine_config(1);
    auto profile = std::make_shared<axes::DriveProfile>(*axes::xp200::plain_profile());
    for (auto& alarm : profile->alarms) alarm.whole_drive = alarm.code == 12;
    SerialLineConfig line;
    line.name = "rs485";
    line.settings.baud = 38400;
    for (const auto& [name, station] : {std::pair<const char*, std::uint8_t>{"u", std::uint8_t{1}}, {"v", std::uint8_t{2}}}) {
        SerialDriveConfig entry;
        entry.drive.name = std::string(name) + "_drive";
        entry.drive.profile = profile;
        entry.drive.station = station;
        entry.drive.parameters = {{97, 33}, {108, 9}};
        entry.unsupervised_line = UnsupervisedLine::accepted;
        line.drives.push_back(entry);
        auto binding = axis(name);
        binding.axis.control = {.mode = axes::ControlMode::velocity, .kv = 3};
        binding.axis.windows = {.in_position = 0.05, .in_position_time = 10ms, .standstill_velocity = 0.1};
        binding.axis.following = {.window = 10, .time = 50ms};
        binding.drive = entry.drive.name;
        binding.profile = profile;
        m.axes.push_back(binding);
    }
    m.serial.push_back(line);
    m.axes.push_back(axis("w"));
    return m;
}

// TSVM 7.1 is the only manual with such alarms; it has six axes behind one slave.
TEST(SharedAlarmMachine, DrivesThatAreOnNoBusDoNotStopEachOther) {
    TestMachine m{three_off_the_bus()};
    ASSERT_TRUE(m.up()) << m.alarms();
    ASSERT_TRUE(m.until([&] { return m.axis(axis_u).online && m.axis(axis_v).online; }, 5s)) << m.alarms();
    for (const auto axis : {axis_u, axis_v, axis_w}) m.enable(axis);

    m.world.serial().drive("u")->servo().raise(12);
    ASSERT_TRUE(m.until([&] { return m.axis(axis_u).state == AxisState::ErrorStop; }, 1s)) << m.alarms();
    m.run(200ms);

    EXPECT_EQ(m.axis(axis_v).state, AxisState::Standstill) << m.alarms();
    EXPECT_EQ(m.axis(axis_w).state, AxisState::Standstill) << m.alarms();
    EXPECT_TRUE(m.axis(axis_w).powered);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
