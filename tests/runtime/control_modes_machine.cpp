// Position loop of the axis over a drive in CSV, and torque over a drive in CST: blocks, real frames, simulated drives.

#include <algorithm>
#include <cmath>
#include <limits>

#include "fb_library/all_blocks.hpp"
#include "runtime/check/machine_check.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;

/// Powers x, makes its place 100 mm, and then does one thing after the other as the test presses the button.
class Moves : public Program {
public:
    AxisRef x;
    MC_Power power;
    MC_Home home;
    MC_MoveAbsolute move;
    Input<bool> button;
    bool ready = false;
    void declare(Declaration& d) override {
        x = d.axis("x");
        button = d.input("button");
        d.monitor("ready", ready);
        d.monitor("done", move.Done);
        d.monitor("aborted", aborted);
        d.monitor("in_target", in_target);
        d.task<&Moves::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = home.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        home.Execute = power.Status;
        home.Position = 100;
        home(ctx);
        ready = ready || home.Done;
        pressed = ctx.get(button);
        first(ctx);
        move.Position = 600;
        move.Velocity = 100;
        move.Execute = ready && pressed;
        move(ctx);
    }
    virtual void first(TaskContext& ctx) = 0;

protected:
    bool pressed = false, aborted = false, in_target = false;
};

struct VelocityThenMove final : Moves {
    MC_MoveVelocity run;
    void first(TaskContext& ctx) override {
        run.Axis = x;
        run.Velocity = 100;
        run.Execute = ready;
        run(ctx);
        in_target = run.InVelocity;
        aborted = run.CommandAborted;
    }
};

struct TorqueThenMove final : Moves {
    MC_TorqueControl push;
    void first(TaskContext& ctx) override {
        push.Axis = x;
        push.Torque = 0.2;
        push.TorqueRamp = 0.5;
        push.Velocity = 60;
        push.Execute = ready;
        push(ctx);
        in_target = push.InTorque;
        aborted = push.CommandAborted;
    }
};

struct LimitThenMove final : Moves {
    MC_SetTorqueLimit limit;
    void first(TaskContext& ctx) override {
        limit.Axis = x;
        limit.PositiveLimit = 0.2;
        limit.NegativeLimit = 0.3;
        limit.Execute = ready;
        limit(ctx);
        in_target = limit.Done;
        aborted = limit.Error;
    }
};

/// Up by the button, and down again as soon as it is there.
struct UpAndDown final : Moves {
    MC_MoveAbsolute down;
    void first(TaskContext& ctx) override {
        down.Axis = x;
        down.Position = 100;
        down.Velocity = 100;
        down.Execute = move.Done || down.Busy;
        down(ctx);
        in_target = in_target || down.Done;
    }
};

/// A servo that also takes velocities and torques (60FFh, 6071h mapped). 10 mm a turn; mechanics of the simulation's defaults:
/// 1.27 N m on 2e-4 kg m2 are 6350 rad/s2 or 10106 mm/s2 at rated torque.
MachineConfig versatile(const ProgramEntry* (*program)()) {
    auto config = with_program(1, program);
    auto device = std::make_shared<ecat::DeviceDescription>(*servo_device());
    const auto target = [&](std::uint16_t index, ecat::DataType type, std::uint8_t bits) {
        auto object = *std::find_if(device->objects.begin(), device->objects.end(), [](const auto& o) { return o.index == 0x607A; });
        object.index = index;
        object.type = type;
        device->objects.push_back(object);
        device->rx_pdos[0].entries.push_back({index, 0, bits});
    };
    target(0x60FF, ecat::DataType::I32, 32);
    target(0x6071, ecat::DataType::I16, 16);
    auto profile = std::make_shared<axes::DriveProfile>(*servo_profile());
    profile->modes.push_back(axes::DriveMode::cyclic_velocity);
    profile->modes.push_back(axes::DriveMode::cyclic_torque);
    config.bus.slaves[0].device = device;
    auto& binding = config.axes[0];
    binding.profile = profile;
    binding.simulation.start = 50;
    binding.axis.homing.kind = axes::HomingKind::set_here;
    binding.axis.control.rated_acceleration = 10106;
    return config;
}

/// Set position less where the motor really is, u: with the dead time of the bus in it.
double true_lag(TestMachine& m) { return m.axis(0).set_position - (m.world.drive("x")->plant().position() / 1000 + 50); }

// 100 / 50 = 2 mm of lag without feed-forward, none with it. What the simulation knows of the motor agrees: the lags differ by just that.
TEST(VelocityDrive, LagsByVelocityOverGainWithoutFeedForwardAndNotAtAllWithIt) {
    double lag[2] = {};
    for (const int feed_forward : {0, 1}) {
        auto config = versatile(&entry_of<VelocityThenMove>);
        config.axes[0].axis.control.mode = axes::ControlMode::velocity;
        config.axes[0].axis.control.kv = 50;
        config.axes[0].axis.control.feed_forward = feed_forward;
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return variable(m, "in_target") != 0; }, 5s)) << m.alarms();
        m.run(1s);
        EXPECT_EQ(m.axis(0).drive_mode, axes::DriveMode::cyclic_velocity);
        EXPECT_NEAR(m.axis(0).actual_velocity, 100, 0.5);
        EXPECT_NEAR(m.axis(0).following_error, feed_forward == 1 ? 0 : 2, 0.03);
        lag[feed_forward] = true_lag(m);

        m.world.set_input("button", true);
        ASSERT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 10s)) << m.alarms();
        EXPECT_NE(variable(m, "aborted"), 0);
        m.run(500ms);
        EXPECT_NEAR(m.axis(0).actual_position, 600, 0.02);
        EXPECT_NEAR(true_lag(m), 0, 0.02);
        EXPECT_TRUE(m.axis(0).in_position);
        EXPECT_EQ(m.alarms(), "");
    }
    EXPECT_NEAR(lag[0] - lag[1], 2, 0.03);
}

// Against a jammed axis the torque rises by 0.5 / s to 0.2: 0.4 s. Set free, the axis runs at the velocity limit with what friction takes:
// 0.05 N m + 0.001 N m s/rad * 37.7 rad/s = 0.0877 N m, 0.069 of the rated one. A move takes over in motion without a bump.
// P1-180, P1-182
TEST(TorqueDrive, RampsHoldsItsVelocityLimitAndGoesOnIntoAMove) {
    TestMachine m{versatile(&entry_of<TorqueThenMove>)};
    ASSERT_TRUE(m.up());
    auto& drive = *m.world.drive("x");
    drive.jam(true);
    ASSERT_TRUE(m.until([&] { return m.axis(0).drive_mode == axes::DriveMode::cyclic_torque; }, 5s)) << m.alarms();
    ASSERT_TRUE(m.until([&] { return m.axis(0).actual_torque > 0.05; }, 1s));
    m.run(200ms);  // 0.1 more
    EXPECT_NEAR(m.axis(0).actual_torque, 0.15, 0.003);
    EXPECT_EQ(variable(m, "in_target"), 0);
    m.run(150ms);
    EXPECT_NEAR(m.axis(0).actual_torque, 0.2, 1e-9);
    EXPECT_NE(variable(m, "in_target"), 0);
    EXPECT_NEAR(m.axis(0).actual_position, 100, 0.01);

    double fastest = 0;
    m.on_cycle = [&] { fastest = std::max(fastest, drive.plant().velocity() / 1000); };
    drive.jam(false);
    m.run(1s);
    EXPECT_NEAR(drive.plant().velocity() / 1000, 60, 1);
    EXPECT_LT(fastest, 66);
    EXPECT_NEAR(m.axis(0).actual_torque, 0.069, 0.005);

    double slowest = 1e9, hardest = 0, before = drive.plant().velocity() / 1000;
    m.on_cycle = [&] {
        const double now = drive.plant().velocity() / 1000;
        slowest = std::min(slowest, now);
        hardest = std::max(hardest, std::abs(now - before));
        before = now;
    };
    m.world.set_input("button", true);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 99; }, 1s)) << m.alarms();
    EXPECT_EQ(m.axis(0).drive_mode, axes::DriveMode::cyclic_position);
    EXPECT_NE(variable(m, "aborted"), 0);
    EXPECT_GT(slowest, 55);
    EXPECT_LT(hardest, 1.5 * 5);  // 5000 mm/s2 are 5 mm/s in a cycle; the loop of the drive follows with some overshoot
    ASSERT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 10s)) << m.alarms();
    m.run(200ms);
    EXPECT_NEAR(m.axis(0).actual_position, 600, 0.02);
    m.expect_no_jump();
    EXPECT_EQ(m.alarms(), "");
}

/// The drive has one object more; mapped, or to be written by SDO.
void has_object(MachineConfig& config, std::uint16_t index, ecat::DataType type, std::int64_t value, bool mapped) {
    auto device = std::make_shared<ecat::DeviceDescription>(*config.bus.slaves[0].device);
    auto object = *std::find_if(device->objects.begin(), device->objects.end(), [](const auto& o) { return o.index == 0x607A; });
    object.index = index;
    object.type = type;
    object.value = value;
    device->objects.push_back(object);
    if (mapped) device->rx_pdos[0].entries.push_back({index, 0, 16});
    config.bus.slaves[0].device = device;
}

// 100 mm/s at a gain of 50 /s are 2 mm of lag: inside 0.5 mm and 30 ms for each mm/s, beyond 0.5 mm alone.
TEST(VelocityDrive, ALagThatGrowsWithTheVelocityIsInsideAWindowThatDoes) {
    for (const Duration per_velocity : {30ms, 0ms}) {
        auto config = versatile(&entry_of<VelocityThenMove>);
        auto& axis = config.axes[0].axis;
        axis.control = {.mode = axes::ControlMode::velocity, .kv = 50, .feed_forward = 0};
        axis.limits.stop_deceleration = 5000;
        axis.limits.acceleration = axis.limits.deceleration = 500;  // braking adds 500 / 50^2 = 0.2 mm
        axis.following = {.window = 0.5, .time = 10ms, .per_velocity = per_velocity};
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        const bool runs = m.until([&] { return variable(m, "in_target") != 0; }, 2s);
        EXPECT_EQ(runs, per_velocity > 0ms);
        EXPECT_EQ(m.has_alarm(axes::id(axes::AxisAlarm::following_error)), !runs);
        if (!runs) continue;
        m.run(500ms);
        EXPECT_NEAR(m.axis(0).following_error, 2, 0.03);
        EXPECT_NEAR(m.axis(0).following_window, 3.5, 0.05);
        m.world.set_input("button", true);
        ASSERT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 10s)) << m.alarms();
        m.run(500ms);
        EXPECT_EQ(m.axis(0).following_window, 0.5);
        EXPECT_EQ(m.alarms(), "");
    }
}

// A tenth of the velocity is not fed forward: 100 / 50 / 10 = 0.2 mm stay, and the I part takes them away.
TEST(VelocityDrive, TheIPartEndsAStandingLag) {
    for (const bool integrates : {false, true}) {
        auto config = versatile(&entry_of<VelocityThenMove>);
        auto& control = config.axes[0].axis.control;
        control = {.mode = axes::ControlMode::velocity, .kv = 50, .feed_forward = 0.9};
        if (integrates) control.integral = {.time = 200ms, .limit = 20};
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return variable(m, "in_target") != 0; }, 5s)) << m.alarms();
        m.run(2s);
        EXPECT_NEAR(m.axis(0).following_error, integrates ? 0 : 0.2, 0.03);
        m.world.set_input("button", true);
        ASSERT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 10s)) << m.alarms();
        m.run(2s);
        EXPECT_NEAR(m.axis(0).actual_position, 600, 0.02);
        EXPECT_EQ(m.alarms(), "");
    }
}

// Friction of 0.2 N m, which is 0.157 of 1.27 N m, and 0.001 N m s/rad, which are 0.000495 of it for each mm/s, told to the drive by 60B2h: its loop need not
// find them at the start, at the reversal and at the end. The acceleration is fed forward in both runs.
TEST(LoadedDrive, FollowsCloserWithItsFrictionFedForward) {
    double lag[2] = {};
    for (const int fed : {0, 1}) {
        auto config = versatile(&entry_of<UpAndDown>);
        has_object(config, 0x60B2, ecat::DataType::I16, 0, true);
        config.axes[0].simulation.coulomb_friction = 0.2;
        auto& control = config.axes[0].axis.control;
        control.torque_feed_forward = 1;
        if (fed == 1) control.load = {.coulomb_friction = 0.157, .viscous_friction = 0.000495, .friction_velocity = 0.5};
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return variable(m, "ready") != 0; }, 5s)) << m.alarms();
        m.on_cycle = [&] { lag[fed] = std::max(lag[fed], std::abs(m.axis(0).following_error)); };
        m.world.set_input("button", true);
        ASSERT_TRUE(m.until([&] { return variable(m, "in_target") != 0; }, 20s)) << m.alarms();
        EXPECT_EQ(m.alarms(), "");
        m.expect_no_jump();
    }
    EXPECT_LT(lag[1], lag[0] / 2) << lag[0] << " mm without";
}

// A weight of 0.4 N m, 0.315 of the rated torque, hangs on the axis and stands on its lower end until there is power. Fed forward it needs no error.
TEST(LoadedDrive, HoldsAWeightThatIsFedForward) {
    double lag[2] = {};
    for (const int fed : {0, 1}) {
        auto config = versatile(&entry_of<UpAndDown>);
        has_object(config, 0x60B2, ecat::DataType::I16, 0, true);
        auto& binding = config.axes[0];
        binding.simulation.load_torque = 0.4;
        binding.simulation.start = 50;
        binding.simulation.negative_stop = 50;
        binding.axis.control.torque_feed_forward = 1;
        if (fed == 1) binding.axis.control.load.gravity = 0.315;
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return variable(m, "ready") != 0; }, 5s)) << m.alarms();
        m.run(300ms);
        m.on_cycle = [&] { lag[fed] = std::max(lag[fed], std::abs(m.axis(0).following_error)); };
        m.world.set_input("button", true);
        m.run(30ms);  // it lifts off
        EXPECT_EQ(m.alarms(), "");
    }
    EXPECT_LT(lag[1], lag[0] / 2) << lag[0] << " mm without";
}

// Against a jammed axis the drive gives 0.2 of its rated torque and no more, whether the limits go with each frame or by SDO. P1 has no such block.
TEST(TorqueLimitedDrive, PressesNoHarderThanItsLimit) {
    for (const bool mapped : {true, false}) {
        auto config = versatile(&entry_of<LimitThenMove>);
        has_object(config, 0x60E0, ecat::DataType::U16, 3000, mapped);
        has_object(config, 0x60E1, ecat::DataType::U16, 3000, mapped);
        config.axes[0].axis.following.window = std::numeric_limits<double>::infinity();
        TestMachine m{config};
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return variable(m, "in_target") != 0; }, 5s)) << m.alarms();
        EXPECT_EQ(m.axis(0).torque_limit_positive, 0.2);
        auto& drive = *m.world.drive("x");
        drive.jam(true);
        double most = 0, least = 0;
        m.on_cycle = [&] {
            most = std::max(most, m.axis(0).actual_torque);
            least = std::min(least, m.axis(0).actual_torque);
        };
        m.world.set_input("button", true);
        m.run(200ms);  // 20 mm behind: the drive itself gives up at 30
        EXPECT_NEAR(m.axis(0).actual_torque, 0.2, 0.0006) << mapped;
        EXPECT_LE(most, 0.2006);
        EXPECT_GE(least, -0.3006);
        EXPECT_EQ(variable(m, "aborted"), 0);
        EXPECT_EQ(m.alarms(), "");
    }
}

// A drive with neither object: the block says so at once, and what is configured is refused before anything runs.
TEST(TorqueLimitedDrive, IsNamedWhereItHasNone) {
    auto config = versatile(&entry_of<LimitThenMove>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return variable(m, "ready") != 0; }, 5s)) << m.alarms();
    m.run(10ms);
    EXPECT_NE(variable(m, "aborted"), 0) << "Error";
    EXPECT_EQ(variable(m, "in_target"), 0);

    const auto code = [](const MachineConfig& machine) {
        const auto errors = check(machine);
        return errors.size() == 1 ? errors[0].code + " " + errors[0].subject : std::to_string(errors.size()) + " errors";
    };
    config.axes[0].axis.limits.torque = 1.5;
    EXPECT_EQ(code(config), "axis.no_torque_limit axes.x.limits.torque");
    has_object(config, 0x6072, ecat::DataType::U16, 3000, false);
    EXPECT_EQ(code(config), "0 errors");
    config.axes[0].axis.limits.negative.torque = 0.5;
    EXPECT_EQ(code(config), "axis.no_torque_limit axes.x.limits.negative.torque") << "6072h is one for both";
    config.axes[0].axis.limits = versatile(&entry_of<LimitThenMove>).axes[0].axis.limits;
    config.axes[0].axis.control.load.gravity = 0.1;
    EXPECT_EQ(code(config), "axis.not_mapped axes.x.control.load") << "no 60B2h";
}

// Down at most at 50 mm/s: the drive's own target, cycle by cycle.
TEST(TwoWaySpeeds, TheDriveIsToldNoFasterWayDownThanAllowed) {
    auto config = versatile(&entry_of<UpAndDown>);
    config.axes[0].axis.limits.negative = {.velocity = 50, .acceleration = 1000};
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return variable(m, "ready") != 0; }, 5s)) << m.alarms();
    double up = 0, down = 0;
    m.on_cycle = [&] {
        up = std::max(up, m.axis(0).set_velocity);
        down = std::min(down, m.axis(0).set_velocity);
    };
    m.world.set_input("button", true);
    ASSERT_TRUE(m.until([&] { return variable(m, "in_target") != 0; }, 30s)) << m.alarms();
    EXPECT_EQ(up, 100);
    EXPECT_EQ(down, -50);
    m.expect_no_jump();
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
