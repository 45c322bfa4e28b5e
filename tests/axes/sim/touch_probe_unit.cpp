// The latch of a simulated drive: which edge, which count, once or again. Bits: SV33-E 3.4.4(1).
#include <gtest/gtest.h>

#include "axes/sim/touch_probe.hpp"
#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

constexpr ProbeSignal signal{100.5, 200};
constexpr IndexPulses pulses{0, 1000};

TouchProbe probe(std::uint8_t function) {
    TouchProbe made;
    made.command(function);
    return made;
}

TEST(TouchProbe, KeepsTheCountAtTheEdge) {
    auto p = probe(0x11);  // enable, rising
    p.motion(90, 110, signal, pulses);
    EXPECT_EQ(p.status(), 0b011);
    EXPECT_EQ(p.rising(), 100);
    p.motion(210, 150, signal, pulses);
    EXPECT_EQ(p.rising(), 100) << "the first only";
}

// Marks of 100.5 to 200, every 1000: also 1100.5 to 1200 and -899.5 to -800.
TEST(TouchProbe, SignalsThatRepeatAreSeenAtEachRepetition) {
    EXPECT_EQ(nearest(signal, 1000, 1090).from, 1100.5);
    EXPECT_EQ(nearest(signal, 1000, -790).to, -800);
    EXPECT_EQ(nearest(signal, 0, 1090).from, 100.5) << "does not repeat";
}

TEST(TouchProbe, FromAboveTheRisingEdgeIsTheUpperEnd) {
    auto p = probe(0x11);
    p.motion(210, 150, signal, pulses);
    EXPECT_EQ(p.rising(), 200);
}

TEST(TouchProbe, FallingEdgeAndBothInOneStep) {
    auto p = probe(0x31);
    p.motion(90, 250, signal, pulses);
    EXPECT_EQ(p.status(), 0b111);
    EXPECT_EQ(p.rising(), 100);
    EXPECT_EQ(p.falling(), 200);
}

TEST(TouchProbe, ContinuousKeepsTheNewest) {
    auto p = probe(0x13);
    p.motion(90, 110, signal, pulses);
    p.motion(110, 210, signal, pulses);
    p.motion(210, 150, signal, pulses);
    EXPECT_EQ(p.rising(), 200);
}

TEST(TouchProbe, IndexPulseOncePerRevolution) {
    auto p = probe(0x15);
    p.motion(-20, -10, signal, pulses);
    EXPECT_EQ(p.status(), 1);
    p.motion(-10, 10, signal, pulses);
    EXPECT_EQ(p.status(), 3);
    EXPECT_EQ(p.rising(), 0);
}

TEST(TouchProbe, WithoutItsEnableBitItForgets) {
    auto p = probe(0x11);
    p.motion(90, 110, signal, pulses);
    p.command(0x10);
    EXPECT_EQ(p.status(), 0);
    p.motion(210, 150, signal, pulses);
    EXPECT_EQ(p.status(), 0);
}

TEST(TouchProbe, IndexPulsesStandWhereTheEncoderHasThem) {
    auto p = probe(0x17);  // enable, continuous, index, rising
    p.motion(100, 400, signal, {250, 1000});
    EXPECT_EQ(p.rising(), 250);
    p.motion(400, -800, signal, {250, 1000});
    EXPECT_EQ(p.rising(), -750) << "of two pulses the later one";
}

// SV-DA200 3.8.3: bits 6 and 7 toggle with each latch, in continuous mode only.
TEST(TouchProbe, ToggleBitsChangeWithEachLatchInContinuousMode) {
    TouchProbe p(ProbeToggle::bits_6_and_7);
    p.command(0x33);  // enable, continuous, both edges
    p.motion(90, 110, signal, pulses);
    EXPECT_EQ(p.status(), 0b0100'0011);
    p.motion(110, 210, signal, pulses);
    EXPECT_EQ(p.status(), 0b1100'0111);
    p.motion(210, 150, signal, pulses);
    EXPECT_EQ(p.status(), 0b1000'0111);
    p.command(0);
    p.command(0x31);
    p.motion(90, 110, signal, pulses);
    EXPECT_EQ(p.status(), 0b0000'0011) << "single: no toggling";
}

TEST(TouchProbe, OfARunningAxisLatchesBetweenTwoExchanges) {
    auto plant = table();
    plant.probe[1] = {12345.6, 20000};
    Bench b{plant};
    b.enable();
    b.in.probe_function = 0x1100;  // probe 2: enable, rising
    b.run(2);
    EXPECT_EQ(b.out.probe_status, 0x0100);
    for (int i = 0; i < 400 && b.out.probe_status == 0x0100; ++i) {
        b.in.target_position += 50;
        b.cycle();
    }
    EXPECT_EQ(b.out.probe_status, 0x0300);
    EXPECT_EQ(b.out.probe_rising[1], 12345);
    EXPECT_GT(b.out.position, 12345) << "the axis has gone on";
}

}  // namespace
}  // namespace taktwerk::axes::sim
