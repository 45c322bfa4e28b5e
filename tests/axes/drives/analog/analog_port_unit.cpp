// The amplifier over +-10 V, cycle by cycle: 10 V are 500 u/s, a u is 100 counts, so 1 V is 5000 counts/s. Bears 2 u the wrong way, needs 20 ms to be
// enabled, brakes for 50 ms.

#include <gtest/gtest.h>

#include "axes/drives/analog/analog_port.hpp"

namespace taktwerk::axes::analog {
namespace {

using namespace std::chrono_literals;

/// An encoder whose answer a test writes by hand.
class HandEncoder final : public DrivePort {
public:
    DriveFeedback says;
    DriveCapabilities can;
    bool holds = true;
    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return can; }
    const DriveFeedback& decode(Instant now) noexcept override {
        says.fresh = says.online && holds;
        if (says.fresh) says.latched = now;
        return says;
    }
    void encode(const DriveCommand&, Instant) noexcept override {}
    [[nodiscard]] Instant setpoint_effective(Instant send) const noexcept override { return send + 2ms; }
    [[nodiscard]] DriveAlarm alarm() const noexcept override {
        DriveAlarm told;
        if (!holds) told.kind = DriveAlarmKind::encoder;
        return told;
    }
};

struct AnalogRig {
    explicit AnalogRig(AnalogDrive drive = plain(), double counts_per_unit = 100) {
        auto owned = std::make_unique<HandEncoder>();
        encoder = owned.get();
        encoder->says.online = true;
        port = std::make_unique<AnalogPort>(std::move(owned), drive, counts_per_unit, 2, false);
        in.reachable = true;
        cycle();
    }
    static AnalogDrive plain() {
        AnalogDrive drive;
        drive.velocity_at_10v = 500;
        drive.enable_delay = 20ms;
        drive.stop_time = 50ms;
        return drive;
    }
    const DriveFeedback& cycle() {
        now += 1ms;
        port->wires(in);
        const auto& feedback = port->decode(now);
        port->encode(command, now);
        return feedback;
    }
    const DriveFeedback& run(int cycles) {
        for (int i = 1; i < cycles; ++i) cycle();
        return cycle();
    }
    void enable() {
        command.power = PowerRequest::on;
        run(30);
        ASSERT_EQ(cycle().power, PowerState::enabled);
    }
    [[nodiscard]] const AnalogWiresOut& out() const { return std::as_const(*port).wires(); }

    HandEncoder* encoder;
    std::unique_ptr<AnalogPort> port;
    AnalogWiresIn in;
    DriveCommand command;
    Instant now{};
};

TEST(AnalogPort, WithoutPowerItGetsNothing) {
    AnalogDrive drive = AnalogRig::plain();
    drive.offset = 0.2;
    AnalogRig rig(drive);
    rig.command.velocity = 10000;
    rig.run(10);
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_FALSE(rig.out().enable);
    EXPECT_EQ(rig.cycle().power, PowerState::disabled);
    EXPECT_EQ(rig.cycle().mode, DriveMode::cyclic_velocity);
}

TEST(AnalogPort, IsEnabledAfterItsDelayAndThenFollows) {
    AnalogRig rig;
    rig.command.power = PowerRequest::on;
    rig.command.velocity = 10000;
    rig.cycle();
    EXPECT_TRUE(rig.out().enable);
    EXPECT_EQ(rig.out().volts, 0) << "it does not follow yet";
    EXPECT_EQ(rig.run(20).power, PowerState::switched_on);
    EXPECT_EQ(rig.cycle().power, PowerState::enabled);
    EXPECT_DOUBLE_EQ(rig.out().volts, 2) << "10000 counts/s are 100 u/s, a fifth of 10 V";
    rig.command.velocity = -25000;
    rig.cycle();
    EXPECT_DOUBLE_EQ(rig.out().volts, -5);
    rig.command.velocity = 90000;
    rig.cycle();
    EXPECT_DOUBLE_EQ(rig.out().volts, 10) << "18 V are none";
}

TEST(AnalogPort, OffsetLimitAndSenseAreTheAmplifiers) {
    AnalogDrive drive = AnalogRig::plain();
    drive.offset = 0.1;
    drive.voltage_limit = 8;
    drive.velocity_at_10v = -500;
    AnalogRig rig(drive);
    rig.enable();
    EXPECT_DOUBLE_EQ(rig.out().volts, 0.1);
    rig.command.velocity = 10000;
    rig.cycle();
    EXPECT_DOUBLE_EQ(rig.out().volts, -1.9);
    rig.command.velocity = 90000;
    rig.cycle();
    EXPECT_DOUBLE_EQ(rig.out().volts, -8);
}

// An axis that counts against its unit: what is positive for the axis is positive for the voltage all the same.
TEST(AnalogPort, AnInvertedEncoderTurnsNoVoltage) {
    AnalogRig rig(AnalogRig::plain(), -100);
    rig.enable();
    rig.command.velocity = -10000;  // +100 u/s
    rig.cycle();
    EXPECT_DOUBLE_EQ(rig.out().volts, 2);
}

TEST(AnalogPort, WithoutReadyItIsNotEnabledAndSaysSo) {
    AnalogRig rig;
    rig.in.ready = false;
    rig.command.power = PowerRequest::on;
    EXPECT_EQ(rig.run(100).power, PowerState::not_ready);
    EXPECT_FALSE(rig.out().enable);
    EXPECT_EQ(rig.port->alarm().found, PortFault::not_ready);
    rig.in.ready = true;
    EXPECT_EQ(rig.run(30).power, PowerState::enabled);
    EXPECT_EQ(rig.port->alarm().found, PortFault::none);
}

TEST(AnalogPort, ReadyThatGoesTakesTheEnableInTheSameCycle) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.cycle();
    rig.in.ready = false;
    rig.cycle();
    EXPECT_FALSE(rig.out().enable);
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_EQ(rig.cycle().fault, false) << "it has lost its power, and no more is known";
}

TEST(AnalogPort, ItsFaultIsToldUntilItIsGoneAndReset) {
    AnalogRig rig;
    rig.enable();
    rig.in.fault = true;
    const auto& feedback = rig.cycle();
    EXPECT_TRUE(feedback.fault);
    EXPECT_EQ(rig.port->alarm().found, PortFault::amplifier);
    EXPECT_FALSE(rig.out().enable);
    rig.command.power = PowerRequest::off;
    rig.command.reset_fault = true;
    rig.run(5);
    EXPECT_TRUE(rig.out().reset);
    EXPECT_TRUE(rig.cycle().fault) << "the wire still says so";
    rig.in.fault = false;
    rig.run(2);
    EXPECT_FALSE(rig.cycle().fault);
    EXPECT_FALSE(rig.out().reset);
}

// 0 V in the cycle that knows it, and 50 ms later no enable.
TEST(AnalogPort, ABrokenEncoderOpensTheLoopAtOnceAndBrakes) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.encoder->says.position = 12345;
    rig.cycle();
    rig.encoder->holds = false;
    rig.cycle();
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_TRUE(rig.out().enable);
    EXPECT_EQ(rig.port->alarm().found, PortFault::encoder);
    rig.command.power = PowerRequest::off;  // as an axis asks whose drive fell
    const auto& feedback = rig.run(20);
    EXPECT_EQ(feedback.power, PowerState::fault_reaction);
    EXPECT_TRUE(feedback.fresh) << "or nobody would learn why";
    EXPECT_EQ(feedback.position, 12345) << "the last that held";
    EXPECT_TRUE(rig.out().enable);
    rig.run(31);
    EXPECT_FALSE(rig.out().enable);
    EXPECT_EQ(rig.cycle().power, PowerState::fault);
    rig.command.reset_fault = true;
    EXPECT_TRUE(rig.run(5).fault);
    rig.encoder->holds = true;
    rig.run(2);
    EXPECT_FALSE(rig.cycle().fault);
}

TEST(AnalogPort, AMotorThatRunsAgainstItsSetpointIsStopped) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    for (int i = 0; i < 20; ++i) {  // 10 counts a cycle, to 200
        rig.cycle();
        ASSERT_EQ(rig.port->alarm().found, PortFault::none) << i;
        rig.encoder->says.position -= 10;
    }
    rig.cycle();
    EXPECT_EQ(rig.port->alarm().found, PortFault::none) << "2 u are borne";
    rig.encoder->says.position -= 10;
    rig.cycle();
    EXPECT_EQ(rig.port->alarm().found, PortFault::polarity);
    EXPECT_EQ(rig.port->alarm().detail, 210u);
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_TRUE(rig.out().enable);
    rig.run(51);
    EXPECT_FALSE(rig.out().enable);
}

TEST(AnalogPort, AnotherZeroOfTheEncoderIsNoMotion) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.cycle();
    rig.encoder->says.position -= 100000;
    ++rig.encoder->says.position_epoch;
    EXPECT_EQ(rig.cycle().velocity, 0);
    EXPECT_EQ(rig.port->alarm().found, PortFault::none);
}

TEST(AnalogPort, AQuickStopIsNoVoltageWithItsEnable) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.cycle();
    rig.command.power = PowerRequest::quick_stop;
    rig.cycle();
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_TRUE(rig.out().enable);
    EXPECT_EQ(rig.cycle().power, PowerState::quick_stop);
    rig.command.power = PowerRequest::off;
    rig.cycle();
    EXPECT_FALSE(rig.out().enable);
}

// A terminal of its wires is away: nothing is known, nothing is given, and nothing comes back by itself.
TEST(AnalogPort, WithoutItsWiresNothingIsFresh) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.cycle();
    rig.in.reachable = false;
    EXPECT_FALSE(rig.cycle().fresh);
    EXPECT_TRUE(rig.cycle().online) << "its encoder counts on: it is homed still";
    EXPECT_FALSE(rig.out().enable);
    EXPECT_EQ(rig.out().volts, 0);
    rig.command.power = PowerRequest::off;
    rig.run(5);
    rig.in.reachable = true;
    EXPECT_TRUE(rig.cycle().fresh);
    EXPECT_FALSE(rig.out().enable);
}

TEST(AnalogPort, AnEncoderThatIsAwayBrakesItToo) {
    AnalogRig rig;
    rig.enable();
    rig.command.velocity = 10000;
    rig.cycle();
    rig.encoder->says.online = false;
    rig.cycle();
    EXPECT_EQ(rig.out().volts, 0);
    EXPECT_TRUE(rig.out().enable);
    rig.run(51);
    EXPECT_FALSE(rig.out().enable);
}

}  // namespace
}  // namespace taktwerk::axes::analog
