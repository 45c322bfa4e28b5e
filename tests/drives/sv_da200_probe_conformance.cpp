// SV-DA200 guide 3.8: touch probes (CT-13), and 4.6: the inputs in 60FDh.

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_probe {
namespace {

class SvDa200Probe : public SvDa200 {
protected:
    static axes::sim::PlantConfig marks() {
        auto p = da200_table();
        p.probe[0] = {-15000, -14000, 0};
        p.probe[1] = {-12000, -11000, 0};
        return p;
    }
    SvDa200Probe() : SvDa200(marks()) {}
};

TEST_F(SvDa200Probe, LatchesTheRisingEdgeOfItsInput) {  // 3.8.3: 0011h
    enable_in(csp);
    pdo(0x60B8, 0x0011);
    run(2);
    EXPECT_EQ(read(0x60B9) & 1, 1);
    follow_to(-13000);
    EXPECT_EQ(read(0x60B9) & 7, 3);
    EXPECT_NEAR(static_cast<double>(read(0x60BA)), 5000, 1) << "5000 counts from -20000, where it counted 0";
}

TEST_F(SvDa200Probe, AnInputWithAFunctionIsNoProbe) {  // 3.8.1: P3.00 = 0, from a restart on
    ASSERT_EQ(sdo(0x2300, 0, 1), 0u);
    enable_in(csp);
    pdo(0x60B8, 0x0011);
    run(2);
    EXPECT_EQ(read(0x60B9) & 1, 1) << "until the restart";
    pdo(0x60B8, 0);
    restart();
    enable_in(csp);
    pdo(0x60B8, 0x0011);
    run(2);
    follow_to(-13000);
    EXPECT_EQ(read(0x60B9) & 7, 0);
}

TEST_F(SvDa200Probe, TheIndexPulseIsLatchedUnlessP425Is3) {  // 3.8.3: 0015h; 2.1 note 3
    enable_in(csp);
    pdo(0x60B8, 0x0015);
    run(2);
    follow_to(-5000);
    EXPECT_EQ(read(0x60B9) & 3, 3);
    pdo(0x60B8, 0);
    ASSERT_EQ(sdo(0x2419, 0, 3), 0u);
    run(2);
    pdo(0x60B8, 0x0015);
    run(2);
    follow_to(8000);
    EXPECT_EQ(read(0x60B9) & 3, 0);
}

TEST_F(SvDa200Probe, InContinuousModeBit6TogglesWithEachLatch) {  // 3.8.3
    enable_in(csp);
    pdo(0x60B8, 0x0013);
    run(2);
    follow_to(-14500);
    const auto first = read(0x60B9) >> 6 & 1;
    follow_to(-16000);
    follow_to(-14500);
    EXPECT_NE(read(0x60B9) >> 6 & 1, first);
}

TEST_F(SvDa200Probe, TheInputsStandInAnotherPlaceWithP425At2) {  // 4.6
    enable_in(csp);
    follow_to(-14500);
    EXPECT_EQ(read(0x60FD) >> 16 & 0xFF, 0x01) << "DI1 is bit 16";
    ASSERT_EQ(sdo(0x2419, 0, 2), 0u);
    run(1);
    EXPECT_EQ(read(0x60FD) >> 17 & 0x7F, 0x01) << "DI1 is bit 17, bit 16 the index pulse";
}

TEST_F(SvDa200, LimitsAndHomeAreBits0To2) {  // 4.6
    EXPECT_EQ(read(0x60FD) & 7, 0);
    enable_in(csv);
    pdo(0x60FF, 50000);
    for (int i = 0; i < 2000 && axis().plant().position() < 2000; ++i) run(1);
    EXPECT_EQ(read(0x60FD) & 7, 4);
}

// 3.8.3, bits 8 to 15: the same for probe 2, whose input is DI2; 1100h: rising edge, 60BCh. 2100h: falling edge, 60BDh.
TEST_F(SvDa200Probe, TheSecondProbeLatchesBothEdges) {
    enable_in(csp);
    pdo(0x60B8, 0x3100);
    run(2);
    EXPECT_EQ(read(0x60B9), 0x0100);
    follow_to(-11500);
    EXPECT_EQ(read(0x60B9), 0x0300);
    EXPECT_NEAR(static_cast<double>(read(0x60BC)), 8000, 1) << "-12000 is 8000 from where it counted 0";
    follow_to(-10000);
    EXPECT_EQ(read(0x60B9), 0x0700);
    EXPECT_NEAR(static_cast<double>(read(0x60BD)), 9000, 1) << "-11000";
}

// 3.8.3: the Z signal by its rising edge only, into 60BCh: 1500h. Pulses stand each turn of 10000, at 0 of the table.
TEST_F(SvDa200Probe, TheSecondProbeLatchesTheIndexPulse) {
    enable_in(csp);
    pdo(0x60B8, 0x1500);
    run(2);
    follow_to(-9000);
    EXPECT_EQ(read(0x60B9), 0x0300);
    EXPECT_NEAR(static_cast<double>(read(0x60BC)), 10000, 1);
    EXPECT_EQ(read(0x60BD), 0);
}

// 3.8.3, bit 0 falls: the probe is off, and its results are gone with it; a new enable latches anew.
TEST_F(SvDa200Probe, ASingleShotIsArmedAgainByBit0) {
    enable_in(csp);
    pdo(0x60B8, 0x0011);
    run(2);
    follow_to(-14500);
    const auto first = read(0x60BA);
    follow_to(-16000);
    follow_to(-14500);
    EXPECT_EQ(read(0x60BA), first) << "single: the first one stays";
    pdo(0x60B8, 0);
    run(2);
    EXPECT_EQ(read(0x60B9), 0);
    pdo(0x60B8, 0x0011);
    run(2);
    EXPECT_EQ(read(0x60B9), 1);
}

// 3.8.1: each probe has an input of its own, P3.00 and P3.01; note 3 of 2.1: no Z signal for either with P4.25 = 3.
TEST_F(SvDa200Probe, TheSecondProbeGoesByP301AndItsOwnBits) {
    ASSERT_EQ(sdo(0x2301, 0, 1), 0u);
    restart();
    enable_in(csp);
    pdo(0x60B8, 0x1111);
    run(2);
    follow_to(-10000);
    EXPECT_EQ(read(0x60B9), 0x0003) << "the first latches, the second has no input";
    ASSERT_EQ(sdo(0x2419, 0, 3), 0u);
    pdo(0x60B8, 0x1500);
    run(2);
    EXPECT_EQ(read(0x60B9), 0);
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_probe
