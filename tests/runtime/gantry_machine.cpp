// A portal of two simulated drives over real frames: one axis for whoever moves it.

#include "axes/axis/alarms.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "runtime/check/machine_check.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisAlarm;
using axes::AxisState;

struct Portal : ::testing::Test {
    Portal() : m(config()) {}
    static MachineConfig config() {
        auto config = machine_config(2);
        auto& x = config.axes[0];
        x.axis.gantry = {.on = true, .warning = 1, .error = 2};
        axes::choose_for_gantry(x.axis.reactions);
        x.axis.homing.kind = axes::HomingKind::set_here;
        x.axis.following.window = 50;  // the skew is what is looked at here
        x.follower = {.slave = "y_drive", .drive_axis = 0, .mirrored = true, .profile = x.profile, .stored = {}};
        config.axes.pop_back();
        return config;
    }
    double left() { return m.world.drive("x")->plant().position() / 1000; }
    double right() { return -m.world.drive("x.follower")->plant().position() / 1000; }  // mirrored
    void start() {
        ASSERT_TRUE(m.up());
        m.enable(0);
        m.home(0);
        apart = right() - left();
        ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 700, 150).answer, Answer::accepted);
        ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 140; }, 3s));
    }
    TestMachine m;
    double apart = 0;
};

TEST_F(Portal, MovesAsOneAxis) {
    ASSERT_EQ(m.machine->layout().axes.size(), 1u);
    start();
    double widest = 0;
    m.on_cycle = [&] { widest = std::max(widest, std::abs(right() - left() - apart)); };
    ASSERT_TRUE(m.until([&] { return m.axis(0).in_position && m.axis(0).set_position == 700; }, 10s)) << m.alarms();
    m.run(100ms);
    EXPECT_LT(widest, 0.05);
    EXPECT_NEAR(left(), m.axis(0).actual_position + left() - 700, 0.01);
    EXPECT_EQ(m.alarms(), "");
    EXPECT_EQ(m.command(OperatorAction::power, 0, false).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).drive_state == axes::PowerState::disabled; }, 1s));
    EXPECT_EQ(m.world.drive("x.follower")->state(), axes::sim::Cia402Axis::State::disabled);
    m.expect_no_jump();
}

TEST_F(Portal, ABlockedSideStopsBoth) {
    start();
    m.world.drive("x.follower")->jam(true);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 1s));
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::gantry_skew))) << m.alarms();
    EXPECT_LT(m.axis(0).skew, -1.9);
    m.run(1s);
    EXPECT_EQ(m.axis(0).set_velocity, 0);
}

TEST_F(Portal, AFaultOfTheFollowerStopsBothAndNamesItsSlave) {
    start();
    m.world.drive("x.follower")->raise(0x3130);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 100ms));
    m.run(10ms);
    EXPECT_NE(m.alarms().find("phase failure"), std::string::npos) << m.alarms();
    EXPECT_NE(m.alarms().find("slave 'y_drive'"), std::string::npos) << m.alarms();
    EXPECT_EQ(m.world.drive("x")->state(), axes::sim::Cia402Axis::State::enabled) << "it ramps down";
    ASSERT_TRUE(m.until([&] { return m.world.drive("x")->state() == axes::sim::Cia402Axis::State::disabled; }, 2s));
    EXPECT_LT(std::abs(m.axis(0).actual_velocity), 1);
    m.run(500ms);
    ASSERT_TRUE(m.until(
        [&] {
            (void)m.command(OperatorAction::reset);
            m.run(200ms);
            return m.axis(0).state != AxisState::ErrorStop;
        },
        5s))
        << m.alarms();
    m.enable(0);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 300, 150).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill; }, 5s)) << m.alarms();
}

TEST(PortalCheck, SaysWhatIsWrong) {
    const auto problem_of = [](const std::function<void(MachineConfig&)>& change) {
        auto config = Portal::config();
        change(config);
        const auto errors = check(config);
        return errors.empty() ? std::string{} : errors[0].text();
    };
    EXPECT_EQ(problem_of([](MachineConfig&) {}), "");
    EXPECT_NE(problem_of([](MachineConfig& c) { c.axes[0].follower.slave = "z_drive"; }).find("'z_drive'"), std::string::npos);
    EXPECT_NE(problem_of([](MachineConfig& c) { c.axes[0].follower.slave = "x_drive"; }).find("already belongs to another axis"),
              std::string::npos);
    EXPECT_NE(problem_of([](MachineConfig& c) {
                  c.axes[0].follower.profile = std::make_shared<axes::DriveProfile>();
              }).find("another type of drive"),
              std::string::npos);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
