// SV-DA200 guide 4.7 to 4.9: outputs set by the bus (CT-15, CT-16), and the tunnel to any parameter (CT-14).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_output {
namespace {

TEST_F(SvDa200, TheTunnelReadsAndWritesParameters) {
    ASSERT_EQ(sdo(0x2005, 0, 123), 0u);
    ASSERT_EQ(sdo(0x4300, 1, 0x200500), 0u);  // P0.05, as the guide has it
    EXPECT_EQ(read(0x4300, 2), 123);
    EXPECT_EQ(read(0x4300, 3), 0) << "0: the value is valid";
    ASSERT_EQ(sdo(0x4300, 2, 77), 0u);
    EXPECT_EQ(read(0x4300, 3), 4) << "4: written";
    EXPECT_EQ(read(0x2005), 77);
}

TEST_F(SvDa200, TheTunnelReachesNeitherWhatIsNotThereNorWhatIsReadOnly) {
    ASSERT_EQ(sdo(0x4300, 1, 0x607D01), 0u);
    EXPECT_NE(read(0x4300, 3), 0);
    ASSERT_EQ(sdo(0x4300, 1, 0x300000), 0u);  // R0.00
    EXPECT_EQ(read(0x4300, 3), 0);
    ASSERT_EQ(sdo(0x4300, 2, 5), 0u);
    EXPECT_NE(read(0x4300, 3), 4);
}

TEST_F(SvDa200, TheBusSetsTheOutputsOnlyWithP428FromARestartOn) {
    pdo(0x60FE, 1 << 16, 1);
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 0u);
    ASSERT_EQ(sdo(0x241C, 0, 1), 0u);
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 0u) << "P4.28 counts from the restart on (2.1 note 1)";
    restart();
    pdo(0x60FE, 1 << 16, 1);  // a command: gone with the power
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 1u) << "bit 16 is DO1";
}

TEST_F(SvDa200, AnAnalogueOutputIsTheValueDividedByItsGain) {
    ASSERT_EQ(sdo(0x231F, 0, 10), 0u);
    ASSERT_EQ(sdo(0x4100, 0, 1), 0u);
    run(1);
    EXPECT_EQ(read(0x3108), 100) << "1 with a gain of 10 is 0.1 V";
    ASSERT_EQ(sdo(0x231E, 0, 3), 0u);
    run(1);
    EXPECT_EQ(read(0x3108), 0) << "P3.30 gives the output to the drive";
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_output
