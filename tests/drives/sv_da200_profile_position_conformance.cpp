// SV-DA200 guide 3.2.7, object by object: single and several set-points, absolute and relative, and the two ways to stop between them (CT-2
// to CT-7 of its sheet). 6083h is the ramp both up and down [3.2.2 step 3]; lengths are hand calculations.

#include "tests/drives/sv_da200.hpp"
#include "tests/patience.hpp"

namespace taktwerk::test::sv_da200_profile_position {
namespace {

constexpr double in_place = 10;  // counts: the window of bit 10 while 6067h, whose factory value is not printed, is 0

class SvDa200Pp : public SvDa200 {
protected:
    explicit SvDa200Pp(const axes::sim::PlantConfig& plant = long_table()) : SvDa200(plant) {}

    /// "Set 6060h to 1" and the profile: 20000 pulses/s, 100000 pulses/s2: 0.2 s and 2000 pulses for each ramp.
    void SetUp() override {
        ASSERT_EQ(sdo(0x6067, 0, static_cast<std::int64_t>(in_place)), 0u);
        pdo(0x6081, 20000);
        pdo(0x6083, 100000);
        pdo(0x6084, 1);  // not used: were it the ramp down, no motion would end
        enable_in(pp);
        ASSERT_TRUE(enabled());
    }
    /// Steps 1 to 4 of 3.2.7: the control word without bit 4, the target, the word with it, and back when bit 12 answers.
    void trigger(std::uint16_t ready_word, std::int64_t target) {
        control(ready_word, 1);
        pdo(0x607A, target);
        control(static_cast<std::uint16_t>(ready_word | 0x10), 1);
        ASSERT_TRUE(run_until([&] { return status_bit(12); }, 10ms)) << "3.2.7 step 4: bit 12 answers bit 4";
        control(ready_word, 1);
    }
    [[nodiscard]] bool gets_there(Duration patience) {
        return run_until([&] { return status_bit(10); }, patience);
    }
    [[nodiscard]] double at() { return static_cast<double>(position()); }
};

// CT-2: 4Fh, 607Ah, 5Fh, bit 12, 4Fh, bit 10.
TEST_F(SvDa200Pp, SingleRelative) {
    trigger(0x4F, 10000);
    EXPECT_FALSE(status_bit(10));
    ASSERT_TRUE(gets_there(2s));
    EXPECT_NEAR(at(), 10000, in_place);
    trigger(0x4F, -4000);
    ASSERT_TRUE(gets_there(2s));
    EXPECT_NEAR(at(), 6000, in_place) << "from where the last one led";
}

// CT-3: 0Fh, 607Ah, 1Fh, bit 12, 0Fh. 10000 = 2000 up, 6000 at 20000/s, 2000 down: 0.2 + 0.3 + 0.2 s.
TEST_F(SvDa200Pp, SingleAbsolute) {
    trigger(0x0F, 10000);
    run(100);
    EXPECT_NEAR(speed(), 10000, 600) << "half of the ramp";
    run(200);
    EXPECT_NEAR(speed(), 20000, 300) << "6081h";
    ASSERT_TRUE(gets_there(1s));
    EXPECT_NEAR(at(), 10000, in_place);
    trigger(0x0F, 2500);
    ASSERT_TRUE(gets_there(2s));
    EXPECT_NEAR(at(), 2500, in_place);
}

// 3.2.2 step 3: 6083h and 6084h are one parameter in this mode. SetUp() gives 6084h = 1.
TEST_F(SvDa200Pp, TheRampDownIs6083hToo) {
    trigger(0x0F, 10000);
    ASSERT_TRUE(run_until([&] { return at() > 8100; }, 1s));
    run(80);
    EXPECT_NEAR(speed(), 11000, 2000);
    EXPECT_TRUE(gets_there(200ms));
}

// 3.2.7, "single point" (bit 5 = 0): the next one waits for the first, and the motor stands between them.
TEST_F(SvDa200Pp, ASecondSinglePointWaits) {
    trigger(0x0F, 5000);
    run(50);
    trigger(0x0F, 8000);
    bool stood = false;
    for (Patience patience; patience.lasts(at() < 7000);) {
        run(1);
        stood = stood || (std::abs(at() - 5000) < 50 && std::abs(speed()) < 500);
    }
    EXPECT_TRUE(stood);
    ASSERT_TRUE(gets_there(2s));
    EXPECT_NEAR(at(), 8000, in_place);
}

// CT-4: 6Fh, 607Ah, 7Fh, bit 12, 6Fh: at once, although the first is on its way. It counts from where the first leads (not stated; CiA
// 402-2: relative to the preceding target).
TEST_F(SvDa200Pp, ImmediateRelative) {
    trigger(0x6F, 20000);
    run(400);
    ASSERT_GT(speed(), 19000);
    trigger(0x6F, -16000);
    ASSERT_TRUE(run_until([&] { return speed() < 0; }, 1s)) << "it turns round: 4000 lies behind it";
    ASSERT_TRUE(gets_there(2s));
    EXPECT_NEAR(at(), 4000, in_place);
}

// CT-5: 2Fh, 607Ah, 3Fh, bit 12, 2Fh, and again for each further target.
TEST_F(SvDa200Pp, ImmediateAbsolute) {
    trigger(0x2F, 50000);
    run(300);
    trigger(0x2F, 30000);
    run(100);
    EXPECT_NEAR(speed(), 20000, 300) << "the same way: nothing slows it down";
    trigger(0x2F, 0);
    ASSERT_TRUE(gets_there(5s));
    EXPECT_NEAR(at(), 0, in_place) << "only the last target was gone to";
}

// 3.2.7, note: "eight levels of target positions". Behind the running one; the ninth is acknowledged when there is room (not stated).
TEST_F(SvDa200Pp, EightTargetsWait) {
    trigger(0x0F, 20000);
    for (int i = 1; i <= 7; ++i) trigger(0x0F, 20000 + 1000 * i);
    pdo(0x607A, 28000);
    control(0x1F, 3);
    control(0x0F, 3);
    EXPECT_TRUE(status_bit(12)) << "full: bit 12 stays";
    pdo(0x607A, -99000);
    control(0x1F, 3);  // a ninth: lost
    control(0x0F, 3);
    ASSERT_TRUE(run_until([&] { return !status_bit(12); }, 3s)) << "the first is reached: there is room";
    ASSERT_TRUE(run_until([&] { return status_bit(10) && at() > 27000; }, 20s));
    EXPECT_NEAR(at(), 28000, in_place);
}

// CT-6: 0Bh: "emergency stop, speed mode, zero-speed clamp". 3.1.2: x00x 0111, Quick Stop Active. It goes on by a new trigger only.
TEST_F(SvDa200Pp, QuickStopClampsAndForgets) {
    trigger(0x0F, 50000);
    run(400);
    const double from = at();
    control(0x0B, 200);
    EXPECT_EQ(power_state(), 0x07u);
    EXPECT_NEAR(speed(), 0, 100);
    EXPECT_LT(at() - from, 500) << "6083h would take 2000 pulses";
    const double stopped = at();
    control(0x0F, 1000);
    EXPECT_TRUE(enabled());
    EXPECT_NEAR(at(), stopped, 20) << "the point has to be triggered again";
    trigger(0x0F, 50000);
    ASSERT_TRUE(gets_there(5s));
    EXPECT_NEAR(at(), 50000, in_place);
}

// CT-7: 10Fh with 605Dh = -1: "stops at the present position and stays enabled"; 3.1.2: bit 10 with halt is zero speed.
TEST_F(SvDa200Pp, HaltWithMinusOneStopsAndHolds) {
    ASSERT_EQ(sdo(0x605D, 0, -1), 0u);
    trigger(0x0F, 50000);
    run(400);
    EXPECT_FALSE(status_bit(10));
    control(0x10F, 200);
    EXPECT_TRUE(enabled());
    EXPECT_TRUE(status_bit(10));
    const double stopped = at();
    run(1000);
    EXPECT_NEAR(at(), stopped, 5) << "it holds";
    control(0x0F, 1000);
    EXPECT_NEAR(at(), stopped, 20) << "clearing the bit does not go on";
    trigger(0x0F, 50000);
    ASSERT_TRUE(gets_there(5s));
    EXPECT_NEAR(at(), 50000, in_place);
}

// CT-7: 605Dh = 0: "stops freely". No torque, so friction alone slows it: w' = -250 - 5 w (0.05 N m and 0.001 N m s on 2e-4 kg m2), from
// 12.57 rad/s to rest in ln(62.57 / 50) / 5 = 45 ms and 0.272 rad, 432 pulses; 20 more until the word is there.
TEST_F(SvDa200Pp, HaltWithZeroLetsTheMotorRunOut) {
    ASSERT_EQ(sdo(0x605D, 0, 0), 0u);
    trigger(0x0F, 50000);
    run(400);
    const double from = at();
    control(0x10F, 1);
    for (int i = 0; i < 20; ++i) {
        run(1);
        EXPECT_EQ(read(0x6077), 0) << i;
    }
    EXPECT_GT(speed(), 5000) << "it still turns";
    run(200);
    EXPECT_NEAR(at() - from, 452, 30);
    EXPECT_EQ(read(0x6077), 0) << "and nothing holds it";
    control(0x0F, 1000);
    EXPECT_NEAR(speed(), 0, 100) << "clearing the bit does not go on";
}

// A vertical axis, 0.3 N m against 0.05 N m of friction, tells the two values of 605Dh apart: one holds it, the other lets it fall.
class SvDa200PpVertical : public SvDa200Pp {
protected:
    static axes::sim::PlantConfig load() {
        auto plant = long_table();
        plant.load_torque = 0.3;
        return plant;
    }
    SvDa200PpVertical() : SvDa200Pp(load()) {}
    /// How far it is from where it stood 200 ms after the halt, a second later.
    double sinks(std::int64_t option) {
        EXPECT_EQ(sdo(0x605D, 0, option), 0u);
        trigger(0x0F, 50000);
        run(400);
        control(0x10F, 200);
        const double from = at();
        run(1000);
        return from - at();
    }
};

TEST_F(SvDa200PpVertical, HaltWithMinusOneHoldsTheLoad) { EXPECT_NEAR(sinks(-1), 0, 5); }
TEST_F(SvDa200PpVertical, HaltWithZeroLetsItFall) { EXPECT_GT(sinks(0), 10000); }

}  // namespace
}  // namespace taktwerk::test::sv_da200_profile_position
