// A portal on two drives is one axis.

#include "tests/axes/drives/gantry/portal_rig.hpp"

namespace taktwerk::axes::test {
namespace {

TEST(Gantry, BothSidesMoveAlikeFromWhereTheyAre) {
    for (const bool mirrored : {false, true}) {
        Portal rig(mirrored);
        rig.power_on();
        EXPECT_EQ(rig.left->largest_step, 0);
        EXPECT_EQ(rig.right->largest_step, 0) << "it starts where it is";
        EXPECT_EQ(rig.axis.submit(absolute(20), Owner::program).error, ErrorId::none);
        ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill; }));
        rig.run(10);
        EXPECT_EQ(std::llround(rig.left->position), 20000);
        EXPECT_EQ(std::llround(rig.right->position), 5000 + (mirrored ? -20000 : 20000));
        EXPECT_EQ(rig.view().skew, 0);
        EXPECT_EQ(rig.left->last.velocity, (mirrored ? -1 : 1) * rig.right->last.velocity);
        EXPECT_TRUE(rig.alarms.empty());
    }
}

TEST(Gantry, IsPoweredWhenBothSidesAre) {
    Portal rig;
    rig.right->power_delay = 30;
    rig.enable = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.left->power == PowerState::enabled; }, 100));
    rig.run(20);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill; }, 200));
    EXPECT_EQ(rig.right->power, PowerState::enabled);
    EXPECT_TRUE(rig.alarms.empty()) << "one that comes later is not lost";
    rig.enable = false;
    rig.run(10);
    EXPECT_EQ(rig.left->power, PowerState::disabled);
    EXPECT_EQ(rig.right->power, PowerState::disabled);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(Gantry, SkewIsShownThenWarnedOfThenStops) {
    Portal rig;
    rig.power_on();
    rig.move_at(20);
    rig.run(200);
    rig.right->lag = 150;
    rig.run(5);
    EXPECT_NEAR(rig.view().skew, -0.15, 1e-9);
    EXPECT_TRUE(rig.alarms.empty());
    rig.right->lag = 300;
    rig.run(5);
    EXPECT_TRUE(rig.raised(AxisAlarm::gantry_skew_warning));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.right->lag = 100;
    rig.run(5);
    EXPECT_TRUE(rig.axis.active_alarms().empty());
    rig.left->lag = 700;
    rig.run(3);
    EXPECT_TRUE(rig.raised(AxisAlarm::gantry_skew));
    EXPECT_NEAR(rig.view().skew, 0.6, 1e-9);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.left->last.position, rig.right->last.position - 5000) << "along the same ramp";
    EXPECT_EQ(rig.right->power, PowerState::enabled);
    // What lies between them when power comes again counts as square.
    rig.enable = false;
    rig.run(20);
    rig.left->lag = rig.right->lag = 0;
    rig.axis.reset(Owner::program);
    rig.run(20);
    rig.power_on();
    rig.run(20);
    EXPECT_EQ(rig.view().skew, 0);
}

TEST(Gantry, AFaultOfEitherSideStopsBothAlongTheRampAndTakesBothTheirPower) {
    for (const bool leads : {false, true}) {
        Portal rig;
        rig.power_on();
        rig.move_at(50);
        rig.run(200);
        auto& faulty = leads ? *rig.left : *rig.right;
        auto& sound = leads ? *rig.right : *rig.left;
        faulty.fault_code = 0x7500;
        rig.run(3);
        EXPECT_TRUE(rig.raised(AxisAlarm::drive_fault));
        EXPECT_FALSE(rig.raised(AxisAlarm::gantry_side_lost)) << "one cause is one alarm";
        EXPECT_EQ(sound.power, PowerState::enabled);
        EXPECT_EQ(sound.last.power, PowerRequest::on);
        const double before = sound.position;
        rig.run(10);
        EXPECT_GT(sound.position, before + 300) << "it ramps down, it is not let go";
        rig.expect_ramp_then_off();
        EXPECT_LE(sound.largest_step, 51);
        faulty.fault_code = 0;
        rig.axis.reset(Owner::program);
        ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill; }, 500));
        EXPECT_EQ(rig.left->power, PowerState::enabled);
        EXPECT_EQ(rig.right->power, PowerState::enabled);
        EXPECT_EQ(rig.view().skew, 0);
    }
}

TEST(Gantry, ASideThatLosesItsPowerTakesTheOtherWithIt) {
    for (const bool leads : {false, true}) {
        Portal rig;
        rig.power_on();
        rig.move_at(50);
        rig.run(200);
        (leads ? rig.left : rig.right)->refuses_power = true;
        rig.run(3);
        EXPECT_TRUE(rig.raised(AxisAlarm::gantry_side_lost));
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        rig.expect_ramp_then_off();
    }
}

// A side that fell and could come back in the midst of the ramp: its set-point is where it would be, not where it is. It waits without power.
TEST(Gantry, ASideThatFellIsNotPoweredAgainUntilBothAre) {
    for (const bool leads : {false, true}) {
        for (const bool fault : {false, true}) {
            Portal rig;
            rig.power_on();
            rig.move_at(100);
            rig.run(300);
            auto& fallen = leads ? *rig.left : *rig.right;
            if (fault) fallen.fault_code = 0x7500;
            else fallen.refuses_power = true;
            rig.run(5);
            ASSERT_EQ(rig.view().state, AxisState::ErrorStop);
            fallen.fault_code = 0;
            fallen.refuses_power = false;
            rig.axis.reset(Owner::program);  // somebody's finger is quick
            fallen.power_delay = 1;
            rig.run_until(
                [&] {
                    EXPECT_FALSE(fallen.power == PowerState::enabled && rig.view().set_velocity != 0)
                        << "leads " << leads << " fault " << fault;
                    return rig.left->power != PowerState::enabled && rig.right->power != PowerState::enabled;
                },
                400);
            EXPECT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill; }, 1000));
            EXPECT_LE(rig.left->largest_step, 101);
            EXPECT_LE(rig.right->largest_step, 101);
            EXPECT_EQ(rig.view().skew, 0);
        }
    }
}

// One side has power and its brake is open, the other has none and holds: the first one holds its place too, whatever pulls.
TEST(Gantry, TheSideThatIsPoweredFirstHoldsItsPlace) {
    for (const bool leads : {false, true}) {
        Portal rig;
        auto& early = leads ? *rig.left : *rig.right;
        auto& late = leads ? *rig.right : *rig.left;
        late.power_delay = 100;
        early.lag = 3;  // a load pulls: it gives way by so much
        rig.enable = true;
        ASSERT_TRUE(rig.run_until([&] { return early.power == PowerState::enabled; }, 100));
        const double before = early.position;
        rig.run(200);
        ASSERT_NE(late.power, PowerState::enabled);
        EXPECT_NEAR(early.position, before, 10) << "leads " << leads;
    }
}

TEST(Gantry, ASilentSideIsAnAxisWithoutFeedback) {
    Portal rig;
    rig.power_on();
    rig.move_at(50);
    rig.run(200);
    rig.right->silent = true;
    rig.run(5);
    EXPECT_TRUE(rig.raised(AxisAlarm::axis_feedback_lost));
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    // Its watchdog takes its power, and nobody hears of it: the other one does not hold the portal alone.
    rig.right->refuses_power = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0; }, 200));
    rig.run(5);
    EXPECT_EQ(rig.left->power, PowerState::disabled);
}

TEST(Gantry, CanOnlyWhatBothCanDoAlike) {
    Portal rig;
    const auto& caps = rig.port.capabilities();
    EXPECT_TRUE(caps.has(DriveMode::cyclic_position));
    EXPECT_FALSE(caps.has(DriveMode::profile_position));
    EXPECT_FALSE(caps.drive_homing);
}

TEST(Gantry, BoundsOfItsKeys) {
    const auto problem_of = [](const std::function<void(AxisConfig&)>& change) {
        auto config = portal();
        change(config);
        const auto problems = check(config);
        return problems.empty() ? std::string{} : problems[0].subject;
    };
    EXPECT_EQ(problem_of([](AxisConfig&) {}), "");
    EXPECT_EQ(problem_of([](AxisConfig& c) { c.gantry.error = 0; }), "axes.x.gantry.max_skew.error");
    EXPECT_EQ(problem_of([](AxisConfig& c) { c.gantry.warning = 0.5; }), "axes.x.gantry.max_skew.warning");
    EXPECT_EQ(problem_of([](AxisConfig& c) { c.homing.kind = HomingKind::drive; }), "axes.x.homing.kind");
    EXPECT_EQ(problem_of([](AxisConfig& c) { c.reactions.choose(AxisAlarm::drive_fault, ErrorReaction::ramp_stop); }),
              "axes.x.reactions.drive_fault");
    EXPECT_EQ(problem_of([](AxisConfig& c) { c.reactions.choose(AxisAlarm::gantry_skew, ErrorReaction::power_off); }), "");
}

}  // namespace
}  // namespace taktwerk::axes::test
