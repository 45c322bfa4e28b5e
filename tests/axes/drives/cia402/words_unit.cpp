// Status and control words against the tables of the manuals.

#include "axes/drives/cia402/words.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes::cia402 {
namespace {

// SV33-E manual 3.4.1(3): state table with "typical" words (bits 4 and 9 set).
TEST(StatusWord, Sv33Patterns) {
    EXPECT_EQ(power_state(0x0250, false), PowerState::disabled);
    EXPECT_EQ(power_state(0x0231, false), PowerState::ready);
    EXPECT_EQ(power_state(0x0233, false), PowerState::switched_on);
    EXPECT_EQ(power_state(0x0237, false), PowerState::enabled);
    EXPECT_EQ(power_state(0x0217, false), PowerState::quick_stop);
    EXPECT_EQ(power_state(0x0218, false), PowerState::fault);
    EXPECT_EQ(power_state(0x021F, false), PowerState::fault_reaction);
    EXPECT_EQ(power_state(0x0200, false), PowerState::not_ready);
}

// TSVM-D6 manual 5.3.1, words of its transition table: enabled has the vendor's bit 12 set, 02B6h fits no state at all.
TEST(StatusWord, TsvmPatterns) {
    EXPECT_EQ(power_state(0x0270, false), PowerState::disabled);
    EXPECT_EQ(power_state(0x1237, false), PowerState::enabled);
    EXPECT_EQ(power_state(0x02BF, false), PowerState::fault_reaction);
    EXPECT_EQ(power_state(0x02B8, false), PowerState::fault);
    EXPECT_EQ(power_state(0x02B6, false), PowerState::unknown);
}

// SE-808X manual 3.2.2.2 prints Fault as x0xx1111: with the quirk that is a fault that can be reset.
TEST(StatusWord, FaultWithLowNibbleFIsAFaultWithTheQuirk) {
    EXPECT_EQ(power_state(0x001F, true), PowerState::fault);
    EXPECT_EQ(power_state(0x0018, true), PowerState::fault);
    EXPECT_EQ(power_state(0x001F, false), PowerState::fault_reaction);
}

// SV33-E manual 8.5: "6 -> 7 -> 15".
TEST(ControlWord, EnablesBy6Then7Then15) {
    EXPECT_EQ(towards_enabled(PowerState::disabled, true), 6);
    EXPECT_EQ(towards_enabled(PowerState::ready, true), 7);
    EXPECT_EQ(towards_enabled(PowerState::switched_on, true), 15);
    EXPECT_EQ(towards_enabled(PowerState::enabled, true), 15);
}

TEST(ControlWord, WaitsInSwitchedOnUntilModeAndTargetAgree) { EXPECT_EQ(towards_enabled(PowerState::switched_on, false), 7); }

// SV33-E manual 3.4.1(1) transitions 8 and 9: leaving Operation Enabled by Shutdown or Disable Voltage lets the motor coast.
TEST(ControlWord, GoesDownStepwise) {
    EXPECT_EQ(towards_off(PowerState::enabled), 7);
    EXPECT_EQ(towards_off(PowerState::switched_on), 6);
    EXPECT_EQ(towards_off(PowerState::ready), 0);
    EXPECT_EQ(towards_off(PowerState::fault), 0);
}

TEST(Modes, CodesAreThoseOf6060h) {
    EXPECT_EQ(mode_code(DriveMode::cyclic_position), 8);
    EXPECT_EQ(mode_code(DriveMode::homing), 6);
    for (int code : {1, 3, 4, 6, 8, 9, 10}) EXPECT_EQ(mode_code(mode_of(code)), code);
    EXPECT_EQ(mode_of(0), DriveMode::none);
    EXPECT_EQ(mode_of(5), DriveMode::none);
}

}  // namespace
}  // namespace taktwerk::axes::cia402
