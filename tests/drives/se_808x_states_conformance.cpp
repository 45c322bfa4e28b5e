// The state machine of the SE-808X manual, 3.2.1 and 3.2.2: which control word leads where, what the status word shows, when the motor has power.
// Where its two tables differ (transitions 7 and 10) that of the commands, 3.2.2.1, is taken, as CiA 402 has it.

#include <gtest/gtest.h>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::axes::sim::se_808x_states {
namespace {

using taktwerk::test::RunningDesk;

using namespace std::chrono_literals;

// 3.2.2.2: bits 6, 5, 3, 2, 1, 0; X is free.
struct Pattern {
    unsigned mask, value;
};
constexpr Pattern switch_on_disabled{0x4F, 0x40}, ready{0x6F, 0x21}, switched_on{0x6F, 0x23}, operation_enabled{0x6F, 0x27},
    quick_stop_active{0x6F, 0x07}, fault{0x4F, 0x0F};

// 3.2.2.1, the table of commands.
constexpr std::uint16_t shut_down = 0x06, switch_on = 0x07, disable_voltage = 0x00, quick_stop = 0x02, disable_operation = 0x07,
                        enable_operation = 0x0F, fault_reset = 0x80;

class Se808xStates : public ::testing::Test {
protected:
    RunningDesk drive{"se-808x"};

    void SetUp() override { drive.pdo(0x6060, 8); }
    void expect(std::uint16_t command, const Pattern& state, const char* transition) {
        drive.control(command, 2);
        EXPECT_EQ(drive.status() & state.mask, state.value) << transition;
        EXPECT_EQ(drive.status() & 0x0A00u, 0u) << "bits 9 and 11 are not supported [3.2.2.2]";
    }
    void up() {
        expect(shut_down, ready, "2");
        expect(switch_on, switched_on, "3");
        drive.pdo(0x607A, drive.position());
        expect(enable_operation, operation_enabled, "4");
    }
};

TEST_F(Se808xStates, StartsInSwitchOnDisabled) {
    EXPECT_EQ(drive.status() & switch_on_disabled.mask, switch_on_disabled.value);  // 0, 1
    expect(switch_on, switch_on_disabled, "no way but Shut Down");
    expect(enable_operation, switch_on_disabled, "no way but Shut Down");
}

// 3.2.1.1. The windings get their current with transition 4 ("shaft locked"); that the motor has it in Switched On already, as the table of states
// says, is not played.
TEST_F(Se808xStates, UpAndDownStepByStep) {
    EXPECT_FALSE(drive.axis().powered());
    up();
    EXPECT_TRUE(drive.axis().powered());
    expect(disable_operation, switched_on, "5");
    EXPECT_FALSE(drive.axis().powered());
    expect(shut_down, ready, "6");
    expect(quick_stop, switch_on_disabled, "7");
    expect(shut_down, ready, "2");
    expect(disable_voltage, switch_on_disabled, "7");
}

TEST_F(Se808xStates, DownInOneStep) {
    up();
    expect(shut_down, ready, "8");
    EXPECT_FALSE(drive.axis().powered());
    up();
    expect(disable_voltage, switch_on_disabled, "9");
    EXPECT_FALSE(drive.axis().powered());
    for (const auto command : {disable_voltage, quick_stop}) {
        expect(shut_down, ready, "2");
        expect(switch_on, switched_on, "3");
        expect(command, switch_on_disabled, "10");
    }
}

// 11, 12, 16; 3.2.1: "motor energised".
TEST_F(Se808xStates, QuickStopActiveIsLeftByCommand) {
    up();
    expect(quick_stop, quick_stop_active, "11");
    drive.run(1000);
    EXPECT_EQ(drive.status() & quick_stop_active.mask, quick_stop_active.value);
    EXPECT_TRUE(drive.axis().powered());
    expect(enable_operation, operation_enabled, "16");
    expect(quick_stop, quick_stop_active, "11");
    expect(disable_voltage, switch_on_disabled, "12");
    EXPECT_FALSE(drive.axis().powered());
}

// 13, 14, 15. The table prints Fault as x0xx1111, like its reaction. The reset is 0 -> 1 of bit 7.
TEST_F(Se808xStates, AFaultIsResetByAnEdge) {
    up();
    drive.axis().raise(0x3221);
    drive.run(2);
    EXPECT_EQ(drive.status() & fault.mask, fault.value);
    EXPECT_FALSE(drive.axis().powered());
    expect(enable_operation, fault, "no command but the reset");
    expect(shut_down, fault, "no command but the reset");
    expect(fault_reset, switch_on_disabled, "15");
    drive.axis().raise(0x3221);
    drive.run(2);
    expect(fault_reset, fault, "no edge");
    expect(disable_voltage, fault, "bit 7 is released");
    expect(fault_reset, switch_on_disabled, "15");
}

// 3.2.2.3: 1, 3, 6 and 8 are played; TQ, CSV and CST have no description. What else 6060h takes is not stated: it leaves the mode as it is.
TEST_F(Se808xStates, ModesShowOn6061) {
    for (const int mode : {1, 3, 6, 8}) {
        drive.pdo(0x6060, mode);
        drive.run(2);
        EXPECT_EQ(drive.read(0x6061), mode);
    }
    for (const int mode : {0, 2, 5, 7, 11, -1}) {
        drive.pdo(0x6060, mode);
        drive.run(2);
        EXPECT_EQ(drive.read(0x6061), 8) << mode;
    }
}

// 3.2.6 and 3.2.2.2: in CSP the position is absolute, in pulses; bits 12 and 13 are reserved.
TEST_F(Se808xStates, CyclicPositionFollowsTheTarget) {
    up();
    for (int i = 1; i <= 100; ++i) {
        drive.pdo(0x607A, 20 * i);
        drive.cycle();
        EXPECT_EQ(drive.status() & 0x3000u, 0u);
    }
    EXPECT_EQ(drive.read(0x606C), 20000);
    drive.run(2);
    EXPECT_EQ(drive.position(), 2000);
    EXPECT_EQ(drive.read(0x606C), 0);
}

}  // namespace
}  // namespace taktwerk::axes::sim::se_808x_states
