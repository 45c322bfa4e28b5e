// Bits of 6041h that a drive has to show before it is enabled.

#include <gtest/gtest.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

// SV-DA200 3.1.2: bit 8 tells that the clock is locked to SYNC0, bit 4 that main power is there.
TEST(Cia402StatusBits, DoesNotEnableBeforeTheStatusBitsThatTheProfileNames) {
    DriveRig rig;
    rig.profile.enable_status_bits = 0x0110;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.command.power = PowerRequest::on;
    rig.mode(8);
    rig.status(0x0233);
    rig.run(50);
    EXPECT_EQ(rig.control(), 0x0007);
    rig.status(0x0333);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x000F);
}

// SV-DA200 2.1 note 3: with P4.25 = 2 or 3 "6041h is changed", and the guide does not say where: nobody waits for a bit that may not come.
TEST(Cia402StatusBits, DoesNotWaitForStatusBitsThatTheUnitsOfTheDriveHide) {
    for (const bool hides : {false, true}) {
        DriveRig rig;
        rig.profile.enable_status_bits = 0x0110;
        rig.profile.units.object = {0x2005, 0x0B};  // reads 0
        rig.profile.units.variants = {UnitVariant{}};
        if (hides) rig.profile.units.variants[0].status_hidden = 0x4100;
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        rig.command.power = PowerRequest::on;
        rig.mode(8);
        rig.status(0x0233);  // main power, and bit 8 never
        rig.run(100);
        EXPECT_EQ(rig.control(), hides ? 0x000F : 0x0007);
        rig.status(0x0223);  // main power is not among them
        rig.run(10);
        EXPECT_EQ(rig.control(), 0x0007);
    }
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test
