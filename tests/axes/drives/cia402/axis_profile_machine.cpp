// The drive's own profile as a whole: axis, port, real frames; the drive is a puppet that answers its words and what the test lets it.

#include <gtest/gtest.h>

#include "axes/axis/axis.hpp"
#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

/// 1000 counts are 1 u. In CSP the motor is where it is told to be, in PP where it is.
struct AxisRig : DriveRig {
    AxisRig() {
        profile.modes = {DriveMode::cyclic_position, DriveMode::profile_position};
        others.insert(others.end(), {{0x6081, 0}, {0x6083, 0}, {0x6084, 0}});
        EXPECT_TRUE(build()) << refusal.text();
        puppet->on_exchange = [this] { answer(); };
        AxisConfig config;
        config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10};
        config.limits.position_min = -100;
        config.limits.position_max = 100;
        config.require_homed = false;
        axis_ = std::make_unique<Axis>(config, *drive, cycle);
        user = [this](Instant at) {
            axis_->update(at);
            axis_->supervise(at);
            (void)axis_->power(true, true, true, Owner::program);
            axis_->plan(at, cycle);
            axis_->encode(at);
        };
        run(200);
        EXPECT_EQ(axis().view().state, AxisState::Standstill);
    }
    Axis& axis() { return *axis_; }
    ErrorId error_of(CommandId id) {
        ErrorId error = ErrorId::none;
        (void)axis().view().status(id, &error);
        return error;
    }

    bool acknowledges = true;
    std::uint16_t bit_10 = 0;
    int edges = 0;  ///< of control word bit 4 in PP

private:
    void answer() {
        const auto word = control();
        static constexpr std::uint16_t ready = 0x0231, on = 0x0233, enabled = 0x0237, off = 0x0250;
        const auto state = (word & 0xFu) == 15 ? enabled : (word & 0xFu) == 7 ? on : (word & 0xFu) == 6 ? ready : off;
        const auto wanted = got(0x6060);
        mode(wanted);
        const bool start = wanted == 1 && (word & 0x10u) != 0;
        edges += start && !started_;
        started_ = start;
        if (wanted == 8 && state == enabled) put(0x6064, got(0x607A));
        const unsigned bit_12 = wanted == 8 || (start && acknowledges) ? 0x1000u : 0u;
        status(static_cast<std::uint16_t>(state | bit_12 | (wanted == 1 ? bit_10 : 0u)));
    }
    std::unique_ptr<Axis> axis_;
    bool started_ = false;
};

// Never acknowledged: 500 ms after the edge the port takes it back, after 2 s the axis gives up; the axis is in its own mode and goes on.
TEST(AxisProfile, ADriveThatNeverAcknowledgesHasRefusedTheSetPoint) {
    AxisRig rig;
    rig.acknowledges = false;
    const auto answer = rig.axis().submit({.kind = CommandKind::drive_move_absolute, .position = 5, .velocity = 50}, Owner::program);
    ASSERT_EQ(answer.error, ErrorId::none);
    rig.run(300);
    EXPECT_EQ(rig.control(), 0x1F);
    EXPECT_EQ(rig.got(0x6081), 50000);
    rig.run(500);
    EXPECT_EQ(rig.control(), 0x0F);
    EXPECT_EQ(rig.axis().view().status(answer.id), CommandStatus::active);
    rig.run(1500);
    EXPECT_EQ(rig.error_of(answer.id), ErrorId::drive_setpoint_refused);
    EXPECT_EQ(rig.edges, 1);
    EXPECT_EQ(rig.axis().view().state, AxisState::Standstill);
    EXPECT_EQ(rig.got(0x6060), 8);
    EXPECT_TRUE(rig.axis().active_alarms().empty());
}

// "Target reached" of a target before (bit 10 stands from the start) ends nothing while the motor is elsewhere; at the target it does.
TEST(AxisProfile, AnOldTargetReachedEndsNothing) {
    AxisRig rig;
    rig.bit_10 = 0x0400;
    const auto answer = rig.axis().submit({.kind = CommandKind::drive_move_absolute, .position = 5, .velocity = 50}, Owner::program);
    rig.run(1000);
    EXPECT_EQ(rig.axis().view().status(answer.id), CommandStatus::active);
    rig.bit_10 = 0;
    rig.put(0x606C, 50000);
    rig.run(100);
    rig.put(0x606C, 0);
    rig.put(0x6064, 5004);
    rig.run(20);
    EXPECT_EQ(rig.axis().view().status(answer.id), CommandStatus::active) << "the drive has not said so";
    rig.bit_10 = 0x0400;
    rig.run(20);
    EXPECT_EQ(rig.axis().view().status(answer.id), CommandStatus::done);
    EXPECT_EQ(rig.got(0x6060), 8);
    EXPECT_EQ(rig.got(0x607A), 5004) << "its own mode goes on from where the motor is";
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test
