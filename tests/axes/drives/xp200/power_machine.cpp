// Power on, off and on again at every place of the round of questions: what was ordered before the last order is never taken for its answer, and a loss
// of power is told all the same.

#include "tests/axes/drives/xp200/power_rig.hpp"

namespace taktwerk::axes::xp200 {
namespace {

/// Four questions (docs/drives/xp200.md: 52 to 56 ms at 38400 baud).
constexpr auto round_of_questions = 56ms;
/// Pr166 = 500 ms until the first power is gone, a round until that is seen, RUN of the second one, and the dwell of 600 ms (5.4.2 Pr169).
constexpr auto power_comes_within = 1400ms;

TEST(Xp200Power, OnOffOnIsNoLossOfPower) {
    for (auto phase = 0ms; phase < round_of_questions; phase += 9ms) {
        PowerRig rig;
        for (auto on = 1ms; on < 120ms; on += 11ms)
            for (auto off = 1ms; off < 120ms; off += 13ms) {
                rig.run(phase + 1ms);
                rig.flicker(on, off);
                rig.must_come_and_stay_and_go(power_comes_within);
                const auto problem = rig.problem();
                ASSERT_EQ(problem, "") << "phase " << phase.count() << " on " << on.count() << " off " << off.count();
            }
    }
}

// The positive control: the power stage is opened at any moment from the second enabling on, and the axis says so within the documented time, once its
// drive has shown the power to be there.
TEST(Xp200Power, ALossAfterOnOffOnIsTold) {
    for (auto phase = 0ms; phase < round_of_questions; phase += 9ms)
        for (auto on = 8ms; on < 120ms; on += 37ms)
            for (auto later = 0ms; later < 900ms; later += 53ms) {
                PowerRig rig;
                rig.run(phase + 1ms);
                rig.flicker(on, 25ms);
                ASSERT_TRUE(rig.until([&] { return rig.has_its_power(); }, power_comes_within));
                rig.run(later);
                ASSERT_EQ(rig.problem(), "");
                rig.allow(loss_told_at_rest);
                rig.error_is_allowed();
                rig.open_power_stage(true);
                ASSERT_TRUE(rig.until([&] { return !rig.rig().drive.servo().energised(); }, 10ms)) << "Pr125: 5 ms";
                const auto gone = rig.rig().now;
                ASSERT_TRUE(rig.until([&] { return rig.rig().axis.view().state == AxisState::ErrorStop; }, 500ms));
                const auto took = rig.rig().now - gone;
                EXPECT_LE(took, loss_told_at_rest) << "phase " << phase.count() << " on " << on.count() << " later " << later.count();
                EXPECT_EQ(rig.rig().axis.view().error, id(AxisAlarm::drive_power_lost));
                EXPECT_EQ(rig.problem(), "");
                // The power stage closes: nobody has asked for power since, so it does not come back.
                rig.open_power_stage(false);
                rig.run(300ms);
                EXPECT_FALSE(rig.until([&] { return rig.rig().drive.servo().energised(); }, 1500ms));
            }
}

// In motion two words of a new speed (13 ms each) may stand before each question, so all takes longer: docs/drives/xp200.md.
TEST(Xp200Power, ALossInMotionIsTold) {
    for (auto later = 130ms; later < 800ms; later += 13ms) {
        PowerRig rig;
        rig.power(true);
        ASSERT_TRUE(rig.until([&] { return rig.stands_enabled(); }, power_comes_within));
        ASSERT_EQ(rig.rig().submit(CommandKind::move_velocity, 0, 90).error, ErrorId::none);
        rig.run(later);
        ASSERT_GT(std::abs(rig.rig().rpm()), 0);
        rig.allow(loss_told_in_motion);
        rig.error_is_allowed();
        rig.open_power_stage(true);
        ASSERT_TRUE(rig.until([&] { return !rig.rig().drive.servo().energised(); }, 10ms));
        ASSERT_TRUE(rig.until([&] { return rig.rig().axis.view().state == AxisState::ErrorStop; }, loss_told_in_motion)) << later.count();
        EXPECT_EQ(rig.rig().axis.view().error, id(AxisAlarm::drive_power_lost)) << later.count();
        EXPECT_EQ(rig.problem(), "");
    }
}

}  // namespace
}  // namespace taktwerk::axes::xp200
