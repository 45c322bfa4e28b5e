// PP, PV and PT through the port: handshake, ramps by SDO before the set-point, refusals. Real frames; the drive is a puppet.

#include <gtest/gtest.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

constexpr std::uint16_t enabled_word = 0x0237, acknowledging = 0x1237;

/// Operation enabled in `mode`, ramps in the dictionary but not mapped.
struct ProfileRig : DriveRig {
    explicit ProfileRig(DriveMode mode, std::int64_t code, std::vector<Quirk> quirks = {}) {
        profile.quirks = std::move(quirks);
        profile.modes = {DriveMode::cyclic_position, DriveMode::profile_position, DriveMode::profile_velocity};
        profile.profile_buffer = 1;
        rx.push_back({0x60FF, 0});
        others.insert(others.end(), {{0x6081, 0}, {0x6083, 0}, {0x6084, 0}});
        EXPECT_TRUE(build()) << refusal.text();
        status(enabled_word);
        this->mode(code);
        command.power = PowerRequest::on;
        command.mode = mode;
        run(10);
    }
    void set_point(std::uint32_t sequence, std::int64_t position, double velocity = 5000) {
        command.position = position;
        command.velocity = velocity;
        command.acceleration = 70000;
        command.deceleration = 80000;
        command.profile.sequence = sequence;
    }
};

// CiA 402-2, SV33-E 3.4.3(5): bit 4 stays until bit 12, falls, and rises again for the next only when bit 12 has fallen.
TEST(Cia402Profile, TheHandshakeOfTwoSetPoints) {
    ProfileRig rig(DriveMode::profile_position, 1);
    EXPECT_EQ(rig.drive->capabilities().profile_buffer, 1);
    rig.set_point(1, 4000);
    rig.run(100);
    EXPECT_EQ(rig.control(), 0x1F);
    EXPECT_EQ(rig.got(0x607A), 4000);
    EXPECT_EQ(rig.feedback().profile_accepted, 0u);
    rig.status(acknowledging);
    rig.run(5);
    EXPECT_EQ(rig.control(), 0x0F);
    EXPECT_EQ(rig.feedback().profile_accepted, 1u);
    rig.set_point(2, 6000);  // the drive still shows bit 12: its buffer is full
    rig.run(50);
    EXPECT_EQ(rig.control(), 0x0F);
    rig.status(enabled_word);
    rig.run(5);
    EXPECT_EQ(rig.control(), 0x1F);
    EXPECT_EQ(rig.got(0x607A), 6000);
    rig.status(acknowledging);
    rig.run(5);
    EXPECT_EQ(rig.feedback().profile_accepted, 2u);
}

// SV33-E 8.5.4: 95 is a relative set-point; SV-DA200 3.2.7: 3Fh one that takes over at once.
TEST(Cia402Profile, RelativeAndImmediateSetPoints) {
    ProfileRig rig(DriveMode::profile_position, 1);
    rig.command.profile.relative = true;
    rig.set_point(1, -500);
    rig.run(100);
    EXPECT_EQ(rig.control(), 95);
    EXPECT_EQ(rig.got(0x607A), -500);
    rig.status(acknowledging);
    rig.run(5);
    rig.status(enabled_word);
    rig.command.profile.relative = false;
    rig.command.profile.immediately = true;
    rig.set_point(2, 900);
    rig.run(100);
    EXPECT_EQ(rig.control(), 0x3F);
}

// What is not mapped is in the drive before bit 4 rises; what it has already is not written again.
TEST(Cia402Profile, SpeedAndRampsGoBySdoBeforeTheEdge) {
    ProfileRig rig(DriveMode::profile_position, 1);
    rig.set_point(1, 4000);
    std::int64_t velocity = -1, acceleration = -1, deceleration = -1;
    rig.puppet->on_exchange = [&] {
        if ((rig.control() & 0x10) == 0 || velocity >= 0) return;
        velocity = rig.got(0x6081);
        acceleration = rig.got(0x6083);
        deceleration = rig.got(0x6084);
    };
    rig.run(100);
    EXPECT_EQ(velocity, 5000);
    EXPECT_EQ(acceleration, 70000);
    EXPECT_EQ(deceleration, 80000);
    rig.put(0x6083, 1);  // as if somebody had changed it: same set-point values are not written again
    rig.status(acknowledging);
    rig.run(5);
    rig.status(enabled_word);
    rig.set_point(2, 8000, 6000);
    rig.run(100);
    EXPECT_EQ(rig.got(0x6081), 6000);
    EXPECT_EQ(rig.got(0x6083), 1);
}

// A drive that never answers gets its edge back; the set-point is never accepted.
TEST(Cia402Profile, ASetPointThatIsNotAcknowledgedIsWithdrawn) {
    ProfileRig rig(DriveMode::profile_position, 1);
    rig.set_point(1, 4000);
    rig.run(100);
    ASSERT_EQ(rig.control(), 0x1F);
    rig.run(600);
    EXPECT_EQ(rig.control(), 0x0F);
    rig.status(acknowledging);  // too late
    rig.run(10);
    EXPECT_EQ(rig.feedback().profile_accepted, 0u);
}

// In PV the target velocity waits for its ramps.
TEST(Cia402Profile, TheVelocityWaitsForItsRamps) {
    ProfileRig rig(DriveMode::profile_velocity, 3);
    rig.set_point(1, 0, 3000);
    std::int64_t ramp = -1;
    rig.puppet->on_exchange = [&] {
        if (rig.got(0x60FF) != 0 && ramp < 0) ramp = rig.got(0x6083);
    };
    rig.run(100);
    EXPECT_EQ(rig.got(0x60FF), 3000);
    EXPECT_EQ(ramp, 70000);
    EXPECT_EQ(rig.feedback().profile_accepted, 1u);
    rig.command.halt = true;
    rig.run(5);
    EXPECT_EQ(rig.control(), 0x10F);
}

// Out of PV in motion: while the drive is still in it its target velocity stays, and 607Ah is the command's, not the actual position that is old
// by the dead time. A halt shows in any mode.
TEST(Cia402Profile, ADriveThatIsStillInPvKeepsItsVelocityUntilTheModeHasChanged) {
    ProfileRig rig(DriveMode::profile_velocity, 3);
    rig.set_point(1, 0, 3000);
    rig.run(100);
    ASSERT_EQ(rig.got(0x60FF), 3000);
    rig.put(0x6064, 7000);
    rig.command = {.power = PowerRequest::on, .mode = DriveMode::cyclic_position, .position = 7012, .velocity = 2900, .halt = true};
    rig.run(5);
    EXPECT_EQ(rig.got(0x6060), 8);
    EXPECT_EQ(rig.got(0x60FF), 3000);
    EXPECT_EQ(rig.got(0x607A), 7012);
    EXPECT_EQ(rig.control(), 0x10F);
    rig.mode(8);
    rig.run(5);
    EXPECT_EQ(rig.got(0x60FF), 0);
    EXPECT_EQ(rig.got(0x607A), 7012);
}

// SV-DA200 3.2.3: in PP 6083h is both ramps, so it is the gentler of the two asked for.
TEST(Cia402Profile, ASharedRampIsTheGentlerOne) {
    ProfileRig rig(DriveMode::profile_position, 1, {Quirk::pp_shared_ramp});
    rig.set_point(1, 4000);
    rig.command.acceleration = 90000;
    rig.run(100);
    EXPECT_EQ(rig.got(0x6083), 80000);
    rig.status(acknowledging);
    rig.run(5);
    rig.status(enabled_word);
    rig.set_point(2, 8000);
    rig.run(100);
    EXPECT_EQ(rig.got(0x6083), 70000);
}

// CiA 402-2: bit 5 abandons the running set-point; SE-808X 3.2.4: there it goes on behind it.
TEST(Cia402Profile, SaysWhetherASetPointCanTakeOverAtOnce) {
    EXPECT_TRUE(ProfileRig(DriveMode::profile_position, 1).drive->capabilities().profile_replaces);
    EXPECT_FALSE(ProfileRig(DriveMode::profile_position, 1, {Quirk::pp_bit_5_blends}).drive->capabilities().profile_replaces);
}

// Until the drive is in the mode nothing of a set-point shows: neither edge nor target.
TEST(Cia402Profile, NothingGoesOutBeforeTheModeIsThere) {
    ProfileRig rig(DriveMode::profile_position, 8);
    rig.put(0x6064, 1234);
    rig.set_point(1, 4000);
    rig.run(100);
    EXPECT_EQ(rig.control(), 0x0F);
    EXPECT_EQ(rig.got(0x607A), 1234);
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test
