// Every word of the TSVM-D6 manual V1.1, 5.3.1 and 5.3.2, as the port reads it.

#include <gtest/gtest.h>

#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {
namespace {

TEST(TsvmWords, TheExamplesOfTheTransitionTable) {
    // 5.3.1, right column.
    EXPECT_EQ(power_state(0x0000, false), PowerState::not_ready);
    EXPECT_EQ(power_state(0x0270, false), PowerState::disabled);
    EXPECT_EQ(power_state(0x0231, false), PowerState::ready);
    EXPECT_EQ(power_state(0x0233, false), PowerState::switched_on);
    EXPECT_EQ(power_state(0x1237, false), PowerState::enabled);
    EXPECT_EQ(power_state(0x0217, false), PowerState::quick_stop);
    // By the table of 5.3.2, with the bits of the example.
    EXPECT_EQ(power_state(0x02BF, false), PowerState::fault_reaction);
    EXPECT_EQ(power_state(0x02B8, false), PowerState::fault);
    // Printed for transition 13, fits no row: never taken for a state in which the motor may go on.
    EXPECT_EQ(power_state(0x02B6, false), PowerState::unknown);
}

TEST(TsvmWords, EveryPatternOfTheStateTableWhateverItsOpenBits) {
    struct Row {
        unsigned mask, value;
        PowerState state;
    };
    // 5.3.2: x is free.
    const Row rows[] = {{0x4F, 0x00, PowerState::not_ready},      {0x4F, 0x40, PowerState::disabled}, {0x6F, 0x21, PowerState::ready},
                        {0x6F, 0x23, PowerState::switched_on},    {0x6F, 0x27, PowerState::enabled},  {0x6F, 0x07, PowerState::quick_stop},
                        {0x4F, 0x0F, PowerState::fault_reaction}, {0x4F, 0x08, PowerState::fault}};
    for (unsigned word = 0; word < 0x10000; ++word) {
        auto wanted = PowerState::unknown;
        for (const auto& row : rows)
            if ((word & row.mask) == row.value) wanted = row.state;
        ASSERT_EQ(power_state(static_cast<std::uint16_t>(word), false), wanted) << std::hex << word;
    }
}

TEST(TsvmWords, TheWayUpAndDownSendsTheWordsOfTheTable) {
    // 5.3.1, middle column: 2, 3, 4 up; 5, 6, 7 down, one state at a time.
    EXPECT_EQ(towards_enabled(PowerState::disabled, true), 0x0006);
    EXPECT_EQ(towards_enabled(PowerState::ready, true), 0x0007);
    EXPECT_EQ(towards_enabled(PowerState::switched_on, true), 0x000F);
    EXPECT_EQ(towards_off(PowerState::enabled), 0x0007);
    EXPECT_EQ(towards_off(PowerState::switched_on), 0x0006);
    EXPECT_EQ(towards_off(PowerState::ready), 0x0000);
    EXPECT_EQ(quick_stop, 0x0002);   // 11
    EXPECT_EQ(fault_reset, 0x0080);  // 15
    // Without its mode it stays in Switched on: enabling with mode 0 is alarm 43 (7.2).
    EXPECT_EQ(towards_enabled(PowerState::switched_on, false), 0x0007);
}

TEST(TsvmWords, NoneOfThemHasBit12WhichClearsTheTurnsOfTheEncoder) {
    for (const auto state : {PowerState::unknown, PowerState::not_ready, PowerState::disabled, PowerState::ready, PowerState::switched_on,
                             PowerState::enabled, PowerState::quick_stop, PowerState::fault_reaction, PowerState::fault}) {
        EXPECT_EQ(towards_off(state) & 0xF000u, 0u);
        EXPECT_EQ(towards_enabled(state, true) & 0xF000u, 0u);
    }
    EXPECT_EQ((homing_start | halt | fault_reset | quick_stop) & 0x1000u, 0u);
}

}  // namespace
}  // namespace taktwerk::axes::cia402
