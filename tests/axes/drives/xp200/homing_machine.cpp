// Homing by the host over the line of an XP200, which has none of its own (manual 5.4 of the sheet: no mode, no input, no parameters): the switch is
// looked at now and then, the index pulse is found by the single-turn value.
//
// Home switch at DI6, on below -30 mm. Homing goes down at 20 mm/s, stops, and comes up again at 2 mm/s: the edge on that way is the reference.

#include "axes/drives/xp200/index_pulse.hpp"
#include "axes/homing/index_doubt.hpp"
#include "tests/axes/drives/xp200/axis_rig.hpp"

namespace taktwerk::axes::xp200 {
namespace {

constexpr double edge = -30;  // mm

struct HomingRig : AxisRig {
    HomingRig(HomingKind kind, double start, double index_pulse)
        : AxisRig({{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 200}, {105, 0}}, plant(start, index_pulse), kind) {}
    static sim::PlantConfig plant(double start, double index_pulse) {
        sim::PlantConfig config;
        config.start = 1000 * start;
        config.index_pulse = 1000 * index_pulse;
        return config;
    }
    /// Until it has homed, or failed.
    void home() {
        go();
        ASSERT_EQ(submit(CommandKind::home, 0, 0).error, ErrorId::none);
        (void)until(
            [&] {
                drive.servo().inputs().contact(5, millimetres() < edge);
                return axis.view().state != AxisState::Homing;
            },
            60s);
        run(500ms);
    }
    /// Where on the machine coordinate 0 is, in mm.
    [[nodiscard]] double zero() const { return millimetres() - axis.view().actual_position; }
};

// A look at the inputs each four questions of 13 ms (8 + 9 bytes at 38400 baud, two gaps, 5 ms turnaround: 12 to 14 ms), and the position one question
// later: the edge is taken 13 to 69 ms late, at 2 mm/s 0.03 to 0.14 mm beyond it, on the way up. So it is never off by more than 0.14 mm, and two
// homings differ by 0.11 mm at most.
TEST(Xp200Homing, ASwitchIsAsGoodAsTheWayBetweenTwoLooks) {
    double lowest = 1e9, highest = -1e9;
    for (int i = 0; i < 12; ++i) {
        HomingRig rig{HomingKind::home_switch, -25 + 0.37 * i, 0};
        rig.home();
        ASSERT_TRUE(rig.axis.view().homed) << i;
        lowest = std::min(lowest, rig.zero());
        highest = std::max(highest, rig.zero());
    }
    EXPECT_GE(lowest, edge + 0.02);
    EXPECT_LE(highest, edge + 0.15);
    EXPECT_LE(highest - lowest, 0.12);
    EXPECT_GT(highest - lowest, 0.01) << "else the starts did not differ";
}

// Pulses at 4.321 mm and every 10 mm: the first one above the edge is at -25.679 mm. Exact to the count (1 um), wherever it began and whatever the
// drive counted from.
TEST(Xp200Homing, TheIndexPulseIsExact) {
    for (int i = 0; i < 12; ++i) {
        HomingRig rig{HomingKind::reference_pulse, -10 + 1.234 * i, 4.321};
        rig.home();
        ASSERT_TRUE(rig.axis.view().homed) << i << ": " << rig.axis.view().error;
        EXPECT_NEAR(rig.zero(), -25.679, 0.0015) << i;
    }
}

// Within an eighth of a turn (1.25 mm) of the edge the next look at the switch might choose another pulse: refused, on both sides.
TEST(Xp200Homing, APulseTooNearTheSwitchIsRefused) {
    for (const double pulse : {-29.5, -30.5}) {
        HomingRig rig{HomingKind::reference_pulse, 0, pulse};
        rig.home();
        EXPECT_FALSE(rig.axis.view().homed) << pulse;
        EXPECT_EQ(rig.axis.view().error, id(AxisAlarm::homing_failed)) << pulse;
        ASSERT_FALSE(rig.axis.active_alarms().empty());
        EXPECT_EQ(rig.axis.active_alarms().front().a, index_near_edge.number) << pulse;
    }
    HomingRig rig{HomingKind::reference_pulse, 0, -28};
    rig.home();
    EXPECT_TRUE(rig.axis.view().homed) << "two millimetres are enough";
}

// 3.3 note 6 gives the single-turn value 0 at the pulse; before the first pulse it means nothing. Three millimetres are no turn.
TEST(Xp200Homing, WithoutAFullTurnNobodyKnowsTheIndex) {
    HomingRig rig{HomingKind::reference_pulse, -29, 4.321};
    rig.home();
    EXPECT_FALSE(rig.axis.view().homed);
    ASSERT_FALSE(rig.axis.active_alarms().empty());
    EXPECT_EQ(rig.axis.active_alarms().front().a, index_unknown.number);
    // After a turn it does.
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 5s));
    ASSERT_EQ(rig.submit(CommandKind::move_relative, 15, 20).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 5s));
    rig.home();
    EXPECT_TRUE(rig.axis.view().homed);
    EXPECT_NEAR(rig.zero(), -25.679, 0.0015);
}

// --- the arithmetic ---------------------------------------------------------------------------------------------------------------

// A turn of 100, a pulse at 30, -70, 130: single-turn value 12 at position 42.
TEST(IndexPulse, IsPassedWhenThePositionPassesItsPlace) {
    IndexPulse index(100);
    (void)index.at(0);
    (void)index.at(142);
    EXPECT_TRUE(index.turned());
    (void)index.at(42);
    index.measured(42, 12);
    index.arm(true);
    ASSERT_TRUE(index.waits());
    (void)index.at(129);
    EXPECT_FALSE(index.latched());
    (void)index.at(131);
    EXPECT_TRUE(index.latched());
    EXPECT_EQ(index.place(), 130);

    index.arm(true);
    (void)index.at(30);  // down over none: 130 is above, 30 is reached
    EXPECT_TRUE(index.latched());
    EXPECT_EQ(index.place(), 130) << "from 131 the first one down";

    index.arm(true);
    (void)index.at(-71);
    EXPECT_EQ(index.place(), -70) << "30, on which it began, does not count";
}

TEST(IndexPulse, CountsOnlyAfterAFullTurn) {
    IndexPulse index(100);
    EXPECT_FALSE(index.at(0));
    EXPECT_TRUE(index.at(0)) << "it rests";
    (void)index.at(60);
    (void)index.at(-39);
    EXPECT_FALSE(index.turned());
    (void)index.at(-40);
    EXPECT_TRUE(index.turned());
    index.forget();
    (void)index.at(0);
    EXPECT_FALSE(index.turned()) << "another zero";
}

}  // namespace
}  // namespace taktwerk::axes::xp200
