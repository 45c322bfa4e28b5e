// The drive's own profiles on the machine: blocks, axis, real frames, and the drives as their files say. Each machine is one axis "x".

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "axes/axis/alarms.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "fb_library/all_blocks.hpp"
#include "tests/drives/one_drive_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;
using axes::DriveMode;

/// Blocks on the axis, called in each scan; the test sets their inputs between cycles (one thread, virtual time).
class Desk final : public Program {
public:
    static inline Desk* here = nullptr;
    Desk() { here = this; }
    MC_Power power;
    MC_Reset reset;
    MC_Home home;
    Drive_MoveAbsolute to, next;
    Drive_MoveRelative by;
    Drive_MoveVelocity at;
    Drive_Torque push;
    MC_MoveAbsolute move;
    MC_Stop stop;

    void declare(Declaration& d) override {
        const auto x = d.axis("x");
        power.Axis = reset.Axis = home.Axis = to.Axis = next.Axis = by.Axis = at.Axis = push.Axis = move.Axis = stop.Axis = x;
        d.task<&Desk::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Enable = true;
        power(ctx), reset(ctx), home(ctx);
        to(ctx), next(ctx), by(ctx), at(ctx), push(ctx), move(ctx), stop(ctx);
    }
};

struct Bench {
    explicit Bench(const std::string& slave, const std::string& axis) : m{one_drive_machine<Desk>(slave, axis)}, desk{*Desk::here} {
        m.replayed.leave_out();  // the test works its blocks
        EXPECT_TRUE(m.up());
        EXPECT_TRUE(m.until([&] { return desk.power.Status; }, 5s)) << m.alarms();
        desk.home.Execute = true;
        EXPECT_TRUE(m.until([&] { return desk.home.Done; }, 1s)) << m.alarms();
    }
    [[nodiscard]] const axes::AxisView& x() { return m.axis(0); }
    axes::sim::Cia402Axis& drive() { return *m.world.drive("x"); }
    /// Of the motor itself, mm/s.
    double speed() { return drive().plant().velocity() / m.machine->config().axes[0].axis.gearing.counts_per_unit(); }
    /// The largest change of the motor's velocity in a cycle while `span` goes by, mm/s.
    double largest_kick(Duration span) {
        double most = 0, before = speed();
        m.on_cycle = [&] {
            const double now = speed();
            most = std::max(most, std::abs(now - before));
            before = now;
        };
        m.run(span);
        m.on_cycle = nullptr;
        return most;
    }
    bool until_speed(double wanted) {
        return m.until([&] { return std::abs(speed() - wanted) < 1; }, 5s);
    }

    TestMachine m;
    Desk& desk;
};

/// 607Fh besides, without which nothing keeps the velocity of PT in its limit. One revolution of 131072 counts is 20 mm.
Bench sv33() {
    return Bench{
        "      profile: sv33-e\n"
        "      pdo: { rx: [6040h, 607Ah, 60FFh, 6071h, 6060h, 607Fh] }\n"
        "      startup:\n"
        "        - { object: 6085h, value: 13107200, if_changed: true }\n"
        "        - { object: 6065h, value: 32768, if_changed: true }\n",
        "    gearing: { counts_per_revolution: 131072, feed: 20 mm }\n"
        "    limits: { velocity: 400 mm/s, acceleration: 3000 mm/s2, jerk: 60000 mm/s3, position: [-200 mm, 400 mm] }\n"
        "    following_error: { window: 5 mm, time: 10 ms }\n"};
}
/// Its 6067h has no stated value.
Bench da200() {
    return Bench{
        "      profile: sv-da200\n"
        "      startup:\n"
        "        - { object: 6067h, value: 10, if_changed: true }\n",
        "    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
        "    limits: { velocity: 250 mm/s, acceleration: 2000 mm/s2, jerk: 40000 mm/s3, position: [-200 mm, 400 mm] }\n"
        "    following_error: { window: 5 mm, time: 10 ms }\n"};
}
/// 60FFh (1603h) besides: its target velocity is not in the profile's mapping.
Bench se808() {
    return Bench{
        "      profile: se-808x\n"
        "      pdo: { rx: [1600h, 1602h, 1603h] }\n"
        "      stored:\n"
        "        - { object: 2000h:02, value: 10000 }\n"
        "        - { object: 2000h:01, value: 40 }\n",
        "    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
        "    limits: { velocity: 100 mm/s, acceleration: 500 mm/s2, jerk: 10000 mm/s3, position: [-200 mm, 400 mm] }\n"
        "    following_error: { window: 5 mm, time: 20 ms }\n"};
}

// SV33-E 3.4.3(5) case 1, SV-DA200 3.2.7, SE-808X 3.2.4. 40 mm at 80 mm/s with ramps of 400 mm/s2: 0.2 s each and 24 mm between them, 0.7 s.
TEST(DriveProfiles, AMoveInPpEndsAtItsTarget) {
    for (auto make : {sv33, da200, se808}) {
        auto b = make();
        auto& to = b.desk.to;
        to.Position = 40, to.Velocity = 80, to.Acceleration = to.Deceleration = 400;
        to.Execute = true;
        double fastest = 0, moved_for = 0;
        b.m.on_cycle = [&] {
            fastest = std::max(fastest, b.speed());
            if (b.speed() <= 0.5) return;
            moved_for += 0.001;
            EXPECT_EQ(b.x().drive_mode, DriveMode::profile_position);
        };
        ASSERT_TRUE(b.m.until([&] { return to.Done; }, 5s)) << b.m.alarms();
        EXPECT_NEAR(fastest, 80, 2);
        EXPECT_NEAR(moved_for, 0.7, 0.03);
        EXPECT_NEAR(b.x().actual_position, 40, 0.02);
        b.m.run(100ms);
        EXPECT_EQ(b.x().state, AxisState::Standstill);
        EXPECT_EQ(b.x().drive_mode, DriveMode::cyclic_position);
        EXPECT_NEAR(b.x().actual_position, 40, 0.02);
        EXPECT_EQ(b.m.alarms(), "");
    }
}

// SV33-E 3.4.3(5) case 2: with the second set-point in its buffer bit 12 stays until the first is over; the motor stands between the two.
TEST(DriveProfiles, TwoSetPointsAreInTheDriveAtOnce) {
    auto b = sv33();
    auto &first = b.desk.to, &second = b.desk.next;
    first.Position = 40, second.Position = 60;
    first.Velocity = second.Velocity = 80;
    second.BufferMode = mcBuffered;
    first.Execute = second.Execute = true;
    ASSERT_TRUE(b.until_speed(80));
    b.m.run(100ms);
    EXPECT_NE(b.x().status_word & 0x1000, 0) << "the buffer is full";
    EXPECT_TRUE(first.Active);
    EXPECT_TRUE(second.Busy);
    EXPECT_FALSE(second.Active);
    ASSERT_TRUE(b.m.until([&] { return first.Done; }, 5s));
    EXPECT_NEAR(b.x().actual_position, 40, 0.1);
    EXPECT_LT(std::abs(b.speed()), 10);
    ASSERT_TRUE(b.m.until([&] { return second.Done; }, 5s));
    EXPECT_NEAR(b.x().actual_position, 60, 0.02);
    EXPECT_EQ(b.m.alarms(), "");
}

// SV-DA200 3.2.7: its buffer takes eight; bit 12 says nothing of them. The first is over where the motor has come to it.
TEST(DriveProfiles, TheBufferOfTheSvDa200) {
    auto b = da200();
    auto& first = b.desk.to;
    auto& second = b.desk.by;
    first.Position = 40, second.Distance = -15;
    first.Velocity = second.Velocity = 80;
    second.BufferMode = mcBuffered;
    first.Execute = second.Execute = true;
    ASSERT_TRUE(b.m.until([&] { return first.Done; }, 5s)) << b.m.alarms();
    EXPECT_NEAR(b.x().actual_position, 40, 0.1);
    ASSERT_TRUE(b.m.until([&] { return second.Done; }, 5s)) << b.m.alarms();
    EXPECT_NEAR(b.x().actual_position, 25, 0.02);
}

// SV33-E 3.4.3(5) case 3, SV-DA200 3.2.7: bit 5 takes over in the drive. SE-808X 3.2.4: bit 5 would go on behind the first, so the axis stops first.
TEST(DriveProfiles, AnotherMoveTakesOverAtOnce) {
    for (auto make : {sv33, da200, se808}) {
        auto b = make();
        auto &first = b.desk.to, &second = b.desk.next;
        first.Position = 200, first.Velocity = 80;
        second.Position = -5, second.Velocity = 60;
        first.Execute = true;
        ASSERT_TRUE(b.until_speed(80));
        second.Execute = true;
        double farthest = 0;
        bool left = false;
        b.m.on_cycle = [&] {
            farthest = std::max(farthest, b.x().actual_position);
            left = left || (second.Busy && b.x().drive_mode != DriveMode::profile_position);
        };
        ASSERT_TRUE(b.m.until([&] { return second.Done; }, 10s)) << b.m.alarms();
        EXPECT_TRUE(first.CommandAborted);
        EXPECT_NEAR(b.x().actual_position, -5, 0.02);
        EXPECT_LT(farthest, 60) << "the first target is far behind";
        EXPECT_EQ(left, make == se808);
        EXPECT_EQ(b.m.alarms(), "");
    }
}

// PV, and a move that takes over: from where the motor is and as fast as it is. The SV33-E stops along its ramp before it changes the mode
// (3.4.3 (7)): 50 mm/s by 250 mm/s2 take 0.2 s; the axis follows it there.
TEST(DriveProfiles, AVelocityInPvAndAMoveThatTakesOver) {
    for (auto make : {sv33, da200, se808}) {
        auto b = make();
        auto& at = b.desk.at;
        at.Velocity = 50, at.Acceleration = at.Deceleration = 250;
        at.Execute = true;
        ASSERT_TRUE(b.m.until([&] { return at.InVelocity; }, 5s)) << b.m.alarms();
        EXPECT_NEAR(b.speed(), 50, 3.5) << "606Dh of the SV33-E is 10 r/min from the factory (7.3): 3.3 mm/s";
        ASSERT_TRUE(b.until_speed(50));
        EXPECT_EQ(b.x().state, AxisState::ContinuousMotion);
        EXPECT_EQ(b.x().drive_mode, DriveMode::profile_velocity);
        b.desk.move.Position = 150, b.desk.move.Velocity = 50;
        b.desk.move.Execute = true;
        double slowest = 100, hardest = 0, before = b.speed();
        int in_pv = 0;
        b.m.on_cycle = [&] {
            const double now = b.speed();
            slowest = std::min(slowest, now);
            hardest = std::max(hardest, std::abs(now - before));
            before = now;
            in_pv += b.x().drive_mode == DriveMode::profile_velocity;
        };
        b.m.run(400ms);
        EXPECT_TRUE(at.CommandAborted);
        if (make == sv33) {
            EXPECT_NEAR(in_pv, 200, 15);
            EXPECT_NEAR(slowest, 0, 1);
        } else {
            EXPECT_LT(in_pv, 10);
            EXPECT_GT(slowest, 44);
        }
        EXPECT_LT(hardest, 4);
        EXPECT_EQ(b.x().drive_mode, DriveMode::cyclic_position);
        ASSERT_TRUE(b.m.until([&] { return b.desk.move.Done; }, 10s)) << b.m.alarms();
        b.m.run(100ms);
        EXPECT_NEAR(b.x().actual_position, 150, 0.02);
        EXPECT_EQ(b.m.alarms(), "");
    }
}

// PT (SV33-E 3.4.3(8)): against a jammed axis 0.2 of the rated torque; set free, 607Fh keeps the speed.
TEST(DriveProfiles, ATorqueInPt) {
    auto b = sv33();
    b.drive().jam(true);
    auto& push = b.desk.push;
    push.Torque = 0.2, push.TorqueRamp = 0.5, push.Velocity = 60;
    push.Execute = true;
    ASSERT_TRUE(b.m.until([&] { return push.InTorque; }, 5s)) << b.m.alarms();
    EXPECT_NEAR(b.x().actual_torque, 0.2, 0.005);
    EXPECT_EQ(b.x().drive_mode, DriveMode::profile_torque);
    b.drive().jam(false);
    b.m.run(1s);
    EXPECT_LE(b.speed(), 60);
    EXPECT_GT(b.speed(), 55);
    b.desk.stop.Execute = true;
    ASSERT_TRUE(b.m.until([&] { return b.desk.stop.Done; }, 2s)) << b.m.alarms();
    EXPECT_TRUE(push.CommandAborted);
    EXPECT_EQ(b.m.alarms(), "");
}

// The default mapping has no 607Fh: nobody would keep the velocity. The SV-DA200 documents no PT at all (2.3).
TEST(DriveProfiles, ATorqueThatNobodyKeepsInItsVelocityIsNotSupported) {
    auto b = da200();
    b.desk.push.Torque = 0.1;
    b.desk.push.Execute = true;
    b.m.run(5ms);
    EXPECT_TRUE(b.desk.push.Error);
    EXPECT_EQ(b.desk.push.ErrorID, ErrorId::not_supported);
}

// MC_Stop in the middle: 80 mm/s by 200 mm/s2 take 0.4 s and 16 mm; the axis is locked while Execute stands.
TEST(DriveProfiles, AStopInTheMiddleBrakesWithItsOwnDeceleration) {
    for (auto make : {sv33, da200, se808}) {
        auto b = make();
        b.desk.to.Position = 200, b.desk.to.Velocity = 80;
        b.desk.to.Execute = true;
        ASSERT_TRUE(b.until_speed(80));
        const double from = b.x().actual_position;
        b.desk.stop.Deceleration = 200;
        b.desk.stop.Execute = true;
        EXPECT_LT(b.largest_kick(100ms), 3);
        ASSERT_TRUE(b.m.until([&] { return b.desk.stop.Done; }, 3s)) << b.m.alarms();
        EXPECT_TRUE(b.desk.to.CommandAborted);
        EXPECT_NEAR(b.x().actual_position - from, 16, 2.5) << "with some cycles at full speed and the jerk's share";
        EXPECT_EQ(b.x().state, AxisState::Stopping);
        b.desk.stop.Execute = false;
        b.m.run(50ms);
        EXPECT_EQ(b.x().state, AxisState::Standstill);
        EXPECT_EQ(b.m.alarms(), "");
    }
}

// A jammed axis in PP: the drive's own watch of its following error (6065h, SV33-E E.423) is the one that counts. After a reset it moves again.
TEST(DriveProfiles, TheDrivesFollowingErrorEndsTheMove) {
    auto b = sv33();
    b.desk.to.Position = 200, b.desk.to.Velocity = 80;
    b.desk.to.Execute = true;
    ASSERT_TRUE(b.until_speed(80));
    b.drive().jam(true);
    ASSERT_TRUE(b.m.until([&] { return b.x().state == AxisState::ErrorStop; }, 5s));
    EXPECT_EQ(b.x().drive_error, 0x8611);
    EXPECT_TRUE(b.m.has_alarm(axes::id(axes::AxisAlarm::drive_fault)));
    EXPECT_FALSE(b.m.has_alarm(axes::id(axes::AxisAlarm::following_error)));
    EXPECT_TRUE(b.desk.to.Error);
    b.drive().jam(false);
    b.desk.to.Execute = false;
    b.desk.reset.Execute = true;
    ASSERT_TRUE(b.m.until([&] { return b.x().state == AxisState::Standstill; }, 5s)) << b.m.alarms();
    b.desk.to.Position = 10;
    b.desk.to.Execute = true;
    ASSERT_TRUE(b.m.until([&] { return b.desk.to.Done; }, 10s)) << b.m.alarms();
    EXPECT_NEAR(b.x().actual_position, 10, 0.02);
}

// A drive fault in PV: the motor stops by the drive's reaction, the axis follows it.
TEST(DriveProfiles, ADriveFaultEndsAVelocity) {
    auto b = da200();
    b.desk.at.Velocity = 50;
    b.desk.at.Execute = true;
    ASSERT_TRUE(b.until_speed(50));
    b.drive().raise(0x2320);
    ASSERT_TRUE(b.m.until([&] { return b.x().state == AxisState::ErrorStop; }, 1s));
    EXPECT_TRUE(b.desk.at.Error);
    b.m.run(2s);
    EXPECT_NEAR(b.speed(), 0, 0.1);
}

// Two runs are the same to the last bit.
TEST(DriveProfiles, AreDeterministic) {
    double place[2], seconds[2];
    for (int i = 0; i < 2; ++i) {
        auto b = sv33();
        b.desk.to.Position = 33, b.desk.to.Velocity = 70;
        b.desk.to.Execute = true;
        ASSERT_TRUE(b.m.until([&] { return b.desk.to.Done; }, 5s));
        place[i] = b.x().actual_position;
        seconds[i] = to_seconds(b.m.clock.now() - Instant{});
    }
    EXPECT_EQ(place[0], place[1]);
    EXPECT_EQ(seconds[0], seconds[1]);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
