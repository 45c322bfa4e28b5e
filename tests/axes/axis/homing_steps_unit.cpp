// PLCopen Part 5 through the axis: states, coordinates, limits and ends of the steps; passive homing. The drive follows exactly; switches and
// positions are of one instant, so an edge is known within half the way of one cycle.

#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

using enum MC_SwitchMode;

AxisCommand step(HomingStepDetails details, double velocity = 20, MC_BufferMode mode = mcAborting) {
    if (details.step == HomingStep::absolute_switch) details.reference.source = TriggerSource::home_switch;
    if (details.step == HomingStep::reference_pulse) details.reference.source = TriggerSource::index_pulse;
    return {.kind = CommandKind::homing_step, .buffer_mode = mode, .velocity = velocity, .details = details};
}
AxisCommand finish(double distance = 0, double velocity = 10, MC_BufferMode mode = mcAborting) {
    auto command = step({.step = HomingStep::finish}, velocity, mode);
    command.position = distance;
    return command;
}
AxisCommand to_switch(MC_SwitchMode mode, MC_HomeDirection direction, double set_position = 0) {
    return step({.step = HomingStep::absolute_switch, .direction = direction, .switch_mode = mode, .set_position = set_position});
}

/// Home switch from -10 to -8 u, limit switches at +-60 u.
void with_switches(FakeDrive& drive) {
    drive.switches = true;
    drive.home_low = -10'000;
    drive.home_high = -8'000;
    drive.negative_end = -60'000;
    drive.positive_end = 60'000;
}

struct StepRig : Rig {
    explicit StepRig(const AxisConfig& config = watched(), const std::function<void(FakeDrive&)>& prepare = with_switches)
        : Rig(config, prepare) {
        power_on();
    }
    static AxisConfig watched() {
        auto config = plain_axis();
        config.following.window = 0.5;
        return config;
    }
    /// Runs until the command is no longer active or queued.
    CommandStatus finished(CommandId id) {
        (void)run_until([&] { return status(id) != CommandStatus::active && status(id) != CommandStatus::queued; });
        return status(id);
    }
    /// Coordinate that the axis gives to the motor's place 0.
    [[nodiscard]] double zero_is() const { return view().actual_position - drive.position / 1000; }
};

// The procedure: Homing from the first step until MC_FinishHoming, not homed in between, the coordinate set where the edge is.
TEST(HomingSteps, StayInHomingUntilFinishedAndAreNotHomedBefore) {
    StepRig rig;
    const auto id = rig.accept(to_switch(mcEdgeSwitchNegative, MC_HomeDirection::mcNegativeDirection, 100));
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    EXPECT_TRUE(rig.view().homing_procedure);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_NEAR(rig.zero_is(), 108, 0.5 * 20 * 0.001 + 0.001);  // the edge at -8 u is 100
    EXPECT_EQ(rig.refuse(absolute(0)), ErrorId::state_forbids);
    EXPECT_EQ(rig.refuse(home(0)), ErrorId::state_forbids);

    const auto end = rig.accept(finish(3));
    const double before = rig.view().set_position;
    ASSERT_EQ(rig.finished(end), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_FALSE(rig.view().homing_procedure);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_NEAR(rig.view().set_position, before + 3, 1e-9);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.drive.largest_step, 100);
}

// Coarse and fine, buffered, as in the example procedure HomeAbsSwitch: each begins when the one before it is done.
TEST(HomingSteps, BufferedStepsFollowOneAnother) {
    StepRig rig;
    const auto coarse = rig.accept(to_switch(mcOn, MC_HomeDirection::mcNegativeDirection));
    auto fine_step = to_switch(mcEdgeSwitchNegative, MC_HomeDirection::mcPositiveDirection, 50);
    fine_step.velocity = 1;
    fine_step.buffer_mode = mcBuffered;
    const auto fine = rig.accept(fine_step);
    const auto end = rig.accept(finish(0, 0, mcBuffered));
    const auto move = rig.accept(absolute(55, 100, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(coarse) == CommandStatus::done; }));
    EXPECT_EQ(rig.status(fine), CommandStatus::active);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(end) == CommandStatus::done; }));
    EXPECT_TRUE(rig.view().homed);
    EXPECT_NEAR(rig.zero_is(), 58, 0.0015);  // half a cycle at 1 u/s, and a count
    ASSERT_EQ(rig.finished(move), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_NEAR(rig.drive.position / 1000, -3, 0.0025);
    EXPECT_LE(rig.drive.largest_step, 100);
}

struct FromSomewhere {
    MC_SwitchMode mode;
    MC_HomeDirection direction;
    double start, edge;
};
class AbsoluteSwitch : public ::testing::TestWithParam<FromSomewhere> {};
TEST_P(AbsoluteSwitch, FindsItsEdgeFromAnywhereWithRamps) {
    const auto c = GetParam();
    StepRig rig(StepRig::watched(), [&](FakeDrive& drive) {
        with_switches(drive);
        drive.position = c.start * 1000;
    });
    const auto id = rig.accept(to_switch(c.mode, c.direction, 7));
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_NEAR(rig.zero_is(), 7 - c.edge, 0.011);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.largest_velocity, 20 * (1 + 1e-12));
    EXPECT_LE(rig.drive.largest_step, 21);
}
INSTANTIATE_TEST_SUITE_P(AllModes, AbsoluteSwitch,
                         ::testing::Values(FromSomewhere{mcRisingEdge, MC_HomeDirection::mcPositiveDirection, -30, -10},
                                           FromSomewhere{mcRisingEdge, MC_HomeDirection::mcPositiveDirection, -9, -10},
                                           FromSomewhere{mcRisingEdge, MC_HomeDirection::mcPositiveDirection, 30, -10},
                                           FromSomewhere{mcRisingEdge, MC_HomeDirection::mcNegativeDirection, -30, -8},
                                           FromSomewhere{mcFallingEdge, MC_HomeDirection::mcNegativeDirection, 10, -10},
                                           FromSomewhere{mcFallingEdge, MC_HomeDirection::mcNegativeDirection, -30, -10},
                                           FromSomewhere{mcEdgeSwitchPositive, MC_HomeDirection::mcSwitchNegative, -9, -10},
                                           FromSomewhere{mcEdgeSwitchNegative, MC_HomeDirection::mcPositiveDirection, 20, -8},
                                           FromSomewhere{mcOn, MC_HomeDirection::mcSwitchPositive, -30, -10},
                                           FromSomewhere{mcOff, MC_HomeDirection::mcSwitchPositive, -9, -10},
                                           FromSomewhere{mcOff, MC_HomeDirection::mcSwitchNegative, -9, -8},
                                           FromSomewhere{mcOn, MC_HomeDirection::mcPositiveDirection, 20, -8}));

// An inverted axis: counts fall where u rises, the drive's switches are exchanged.
TEST(HomingSteps, InvertedAxisFindsTheSameEdge) {
    auto config = StepRig::watched();
    config.gearing.inverted = true;
    StepRig rig(config);
    const auto id =
        rig.accept(to_switch(mcRisingEdge, MC_HomeDirection::mcPositiveDirection, 7));  // in counts: downwards to the edge at -8000
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_NEAR(rig.view().actual_position + rig.drive.position / 1000, 7 - 8, 0.011);
    const auto limit =
        rig.accept(step({.step = HomingStep::limit_switch, .direction = MC_HomeDirection::mcPositiveDirection, .switch_mode = mcOn}));
    ASSERT_EQ(rig.finished(limit), CommandStatus::done);
    EXPECT_LT(rig.drive.position, -59'000);  // u's positive end is the drive's negative one
}

// A switch that is an input of the machine, normally closed.
TEST(HomingSteps, SwitchMayBeAnInputOfTheMachine) {
    StepRig rig;
    std::array<std::int64_t, 2> inputs{0, 0b100};
    rig.axis.bind({.inputs = inputs});
    rig.program = [&] { inputs[1] = rig.drive.position > 5000 ? 0 : 0b100; };
    auto command = step(
        {.step = HomingStep::absolute_switch, .direction = MC_HomeDirection::mcPositiveDirection, .switch_mode = mcOn, .set_position = 20});
    std::get<HomingStepDetails>(command.details).reference = {.source = TriggerSource::input, .falling = true, .point = 1, .bit = 2};
    const auto id = rig.accept(command);
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_NEAR(rig.zero_is(), 15, 0.05);  // the input is seen a cycle or two late at 20 u/s
    std::get<HomingStepDetails>(command.details).reference.point = 2;
    EXPECT_EQ(rig.refuse(command), ErrorId::invalid_parameter);
}

TEST(HomingSteps, LimitSwitchIsReferenceAndFinishMovesOffIt) {
    StepRig rig;
    const auto id = rig.accept(step({.step = HomingStep::limit_switch,
                                     .direction = MC_HomeDirection::mcNegativeDirection,
                                     .switch_mode = mcRisingEdge,
                                     .set_position = -200}));
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_NEAR(rig.zero_is(), -140, 0.011);
    EXPECT_TRUE(rig.view().negative_limit_switch);
    const auto end = rig.accept(finish(5));
    ASSERT_EQ(rig.finished(end), CommandStatus::done);
    EXPECT_FALSE(rig.view().negative_limit_switch);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(HomingSteps, FinishDoesNotMoveFurtherIntoALimitSwitch) {
    StepRig rig;
    const auto id =
        rig.accept(step({.step = HomingStep::limit_switch, .direction = MC_HomeDirection::mcNegativeDirection, .switch_mode = mcOn}));
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    const double there = rig.drive.position;
    const auto end = rig.accept(finish(-5));
    ASSERT_EQ(rig.finished(end), CommandStatus::error);
    EXPECT_EQ(rig.error_of(end), ErrorId::interlocked);
    rig.run(200);
    EXPECT_NEAR(rig.drive.position, there, 10);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
}

// The stop at 20 u holds the motor, the set-point runs on until torque and standstill have lasted; then it comes back to the stop.
TEST(HomingSteps, BlockIsFoundByTorqueAndStandstill) {
    StepRig rig(StepRig::watched(), [](FakeDrive& drive) {
        drive.positive_stop = 20'000;
        drive.stiffness = 0.0001;  // 30 % of rated torque at 3 u: far beyond the following error window
        drive.caps.torque_limits = true;
    });
    const auto id = rig.accept(step({.step = HomingStep::block,
                                     .direction = MC_HomeDirection::mcPositiveDirection,
                                     .set_position = 300,
                                     .torque_limit = 0.3,
                                     .detection_velocity_limit = 1,
                                     .detection_velocity_time = 20ms}));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().actual_torque > 0.2; }));
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.3);
    EXPECT_EQ(rig.drive.last.torque_limit_negative, 0.3);
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_TRUE(std::isinf(rig.drive.last.torque_limit_positive));
    EXPECT_NEAR(rig.zero_is(), 280, 0.001);
    EXPECT_NEAR(rig.view().set_position, 300, 0.002);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.drive.largest_step, 21);
    const auto end = rig.accept(finish(-2));
    ASSERT_EQ(rig.finished(end), CommandStatus::done);
    rig.run(5);
    EXPECT_NEAR(rig.drive.position, 18'000, 2);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.drive.largest_step, 21);
}

// Without a stop in reach the way is limited; pressing that never gets the torque, by the time. No alarm of the lag; the set-point comes back.
TEST(HomingSteps, BlockStepsObeyTheirLimits) {
    StepRig rig(StepRig::watched(), [](FakeDrive& drive) {
        drive.positive_stop = 20'000;
        drive.stiffness = 0;
    });
    const HomingStepDetails block{.step = HomingStep::block,
                                  .torque_limit = 0.3,
                                  .time_limit = 3s,
                                  .distance_limit = 15,
                                  .detection_velocity_limit = 1,
                                  .detection_velocity_time = 20ms};
    const auto way = rig.accept(step(block));
    ASSERT_EQ(rig.finished(way), CommandStatus::error);
    EXPECT_EQ(rig.error_of(way), ErrorId::homing_limit_distance);
    EXPECT_NEAR(rig.drive.position, 15'632, 45);  // stopping takes 20 u/s * sqrt(20 u/s / 20000 u/s3) = 0.632 u; seen two cycles late

    const auto time = rig.accept(step(block));
    ASSERT_EQ(rig.finished(time), CommandStatus::error);
    EXPECT_EQ(rig.error_of(time), ErrorId::homing_limit_time);
    EXPECT_EQ(rig.drive.position, 20'000);
    EXPECT_NEAR(rig.view().set_position, 20, 0.002);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(HomingSteps, ReferencePulseIsExact) {
    StepRig rig(StepRig::watched(), [](FakeDrive& drive) {
        drive.caps.probes = 1;
        drive.index_distance = 10'000;
        drive.index_at = 1234;
    });
    const auto id =
        rig.accept(step({.step = HomingStep::reference_pulse, .direction = MC_HomeDirection::mcNegativeDirection, .set_position = 0}));
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    EXPECT_NEAR(rig.zero_is(), 8.766, 1e-9);  // the pulse at -8766 counts
    EXPECT_FALSE(rig.drive.last.probes[0].armed);
}

TEST(HomingSteps, WithoutALatchThereIsNoReferencePulse) {
    StepRig rig;
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::reference_pulse})), ErrorId::no_such_probe);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// Marks 4 u apart (4000 counts), gaps differing by 4 counts: the drive here has pulses every 2008 counts, the gap after fixed mark 1.
TEST(HomingSteps, DistanceCodedMarksGiveTheAbsolutePosition) {
    auto config = StepRig::watched();
    config.homing.marks = {.spacing = 4000, .step = 4};
    config.homing.offset = 0.5;
    StepRig rig(config, [](FakeDrive& drive) {
        drive.caps.probes = 1;
        drive.index_distance = 2008;
        drive.index_at = 700;
    });
    const auto id = rig.accept(step({.step = HomingStep::distance_coded}));
    ASSERT_EQ(rig.finished(id), CommandStatus::done);
    // Pulses at 700 and 2708 counts: fixed mark 1 at 4 u, its neighbour at 6.008 u of the scale.
    EXPECT_NEAR(rig.zero_is(), 6.008 - 2.708 + 0.5, 1e-9);
    StepRig without;
    EXPECT_EQ(without.refuse(step({.step = HomingStep::distance_coded})), ErrorId::not_supported);
}

TEST(HomingSteps, HomeDirectAndAbsoluteNeedNoMotionAndEndTheProcedure) {
    auto config = StepRig::watched();
    config.memory.absolute = true;
    config.homing.offset = 40;
    StepRig rig(config, [](FakeDrive& drive) { drive.position = 2500; });
    const auto direct = rig.accept(step({.step = HomingStep::direct, .set_position = -3}, 0));
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    ASSERT_EQ(rig.finished(direct), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, -3);
    const auto absolute_step = rig.accept(step({.step = HomingStep::absolute}, 0));
    ASSERT_EQ(rig.finished(absolute_step), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 42.5);
    EXPECT_EQ(rig.drive.largest_step, 0);

    StepRig incremental;
    EXPECT_EQ(incremental.refuse(step({.step = HomingStep::absolute}, 0)), ErrorId::not_supported);
}

// A step that fails leaves the axis in Homing, standing; what waited behind it is aborted, and there is nothing to finish. MC_Stop gives up.
TEST(HomingSteps, FailedStepCannotBeFinished) {
    StepRig rig(StepRig::watched(), [](FakeDrive& drive) {
        with_switches(drive);
        drive.home_low = 1;
        drive.home_high = 0;
    });
    const auto id = rig.accept(to_switch(mcRisingEdge, MC_HomeDirection::mcNegativeDirection));
    const auto end = rig.accept(finish(0, 0, mcBuffered));
    ASSERT_EQ(rig.finished(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), ErrorId::homing_failed);
    EXPECT_EQ(rig.status(end), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_EQ(rig.refuse(finish()), ErrorId::homing_failed);
    const auto stopping = rig.accept(stop());
    ASSERT_EQ(rig.finished(stopping), CommandStatus::done);
    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_FALSE(rig.view().homing_procedure);
    EXPECT_EQ(rig.refuse(finish()), ErrorId::state_forbids);
}

TEST(HomingSteps, TimeAndDistanceLimitsStopTheSearch) {
    StepRig rig;
    auto command = to_switch(mcOn, MC_HomeDirection::mcPositiveDirection);
    std::get<HomingStepDetails>(command.details).time_limit = 500ms;
    const auto time = rig.accept(command);
    ASSERT_EQ(rig.finished(time), CommandStatus::error);
    EXPECT_EQ(rig.error_of(time), ErrorId::homing_limit_time);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_LT(rig.drive.position, 11'000);
    std::get<HomingStepDetails>(command.details).time_limit = {};
    std::get<HomingStepDetails>(command.details).distance_limit = 5;
    const double from = rig.drive.position;
    const auto way = rig.accept(command);
    ASSERT_EQ(rig.finished(way), CommandStatus::error);
    EXPECT_EQ(rig.error_of(way), ErrorId::homing_limit_distance);
    EXPECT_NEAR(rig.drive.position - from, 5000, 700);
}

TEST(HomingSteps, TorqueWhereThereShouldBeNoneStopsTheSearch) {
    StepRig rig(plain_axis(), [](FakeDrive& drive) {
        with_switches(drive);
        drive.positive_stop = 10'000;
    });
    auto command = to_switch(mcOn, MC_HomeDirection::mcPositiveDirection);
    std::get<HomingStepDetails>(command.details).torque_limit = 0.1;  // at 0.1 u of lag
    const auto id = rig.accept(command);
    ASSERT_EQ(rig.finished(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), ErrorId::homing_limit_torque);
}

TEST(HomingSteps, NotWhileMovingNorInTheMiddleOfHome) {
    auto config = StepRig::watched();
    config.homing.kind = HomingKind::home_switch;
    StepRig rig(config);
    rig.accept(absolute(30));
    rig.run(50);
    EXPECT_EQ(rig.refuse(to_switch(mcOn, MC_HomeDirection::mcNegativeDirection)), ErrorId::state_forbids);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(home(0));
    rig.run(50);
    EXPECT_EQ(rig.refuse(to_switch(mcOn, MC_HomeDirection::mcNegativeDirection)), ErrorId::state_forbids);
}

TEST(HomingSteps, BadInputsAreRefusedAndTheAxisStaysInStandstill) {
    StepRig rig;
    const auto nan = std::nan("");
    EXPECT_EQ(rig.refuse({.kind = CommandKind::homing_step, .velocity = 1}), ErrorId::invalid_parameter);
    auto command = to_switch(mcOn, MC_HomeDirection::mcNegativeDirection);
    command.velocity = 0;
    EXPECT_EQ(rig.refuse(command), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse(to_switch(mcOn, MC_HomeDirection::mcNegativeDirection, INFINITY)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::direct, .set_position = nan})), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::limit_switch, .switch_mode = mcEdgeSwitchPositive})), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::block, .torque_limit = 0.1})), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::block, .detection_velocity_limit = 1})), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::block,
                               .direction = MC_HomeDirection::mcSwitchPositive,
                               .torque_limit = 0.1,
                               .detection_velocity_limit = 1})),
              ErrorId::invalid_direction);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::absolute_switch, .time_limit = -1ms})), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(step({.step = HomingStep::absolute_switch, .distance_limit = nan})), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(finish(nan)), ErrorId::invalid_position);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_FALSE(rig.view().homing_procedure);
}

// A step in the middle of another: the former is aborted, the axis goes on without a jump.
TEST(HomingSteps, AbortingStepTakesOverInMotion) {
    StepRig rig;
    const auto first = rig.accept(to_switch(mcOn, MC_HomeDirection::mcPositiveDirection));
    rig.run(300);
    ASSERT_EQ(rig.view().set_velocity, 20);
    const auto second = rig.accept(to_switch(mcRisingEdge, MC_HomeDirection::mcNegativeDirection, 0));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    ASSERT_EQ(rig.finished(second), CommandStatus::done);
    EXPECT_NEAR(rig.zero_is(), 8, 0.011);
    EXPECT_LE(rig.drive.largest_step, 21);
}

TEST(HomingSteps, PowerOffEndsTheProcedure) {
    StepRig rig;
    const auto id = rig.accept(to_switch(mcOn, MC_HomeDirection::mcPositiveDirection));
    rig.run(100);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    EXPECT_FALSE(rig.view().homing_procedure);
    rig.power_on();
    EXPECT_FALSE(rig.view().homed);
    rig.run(50);
    EXPECT_EQ(rig.view().set_velocity, 0);
}

// --- passive ----------------------------------------------------------------------------------------------------------------

AxisCommand flying(HomingStepDetails details) {
    details.step = HomingStep::flying_switch;
    details.reference.source = TriggerSource::home_switch;
    return {.kind = CommandKind::homing_step, .details = details};
}

// On its way from 0 to -30 the axis passes the switch's edge at -8, which is declared to be -12: the target keeps its number, so the way
// becomes 4 u shorter. The state stays what it was.
TEST(PassiveHoming, ReReferencesInMotionAndTheTargetKeepsItsNumber) {
    StepRig rig;
    const auto move = rig.accept(absolute(-30, 20));
    const auto passing = rig.accept(flying({.switch_mode = mcRisingEdge, .set_position = -12}));
    EXPECT_EQ(rig.status(move), CommandStatus::active);
    EXPECT_EQ(rig.status(passing), CommandStatus::active);
    EXPECT_EQ(rig.view().side[static_cast<std::size_t>(SideSlot::passive_homing)], passing);
    for (Patience patience; patience.lasts(rig.status(passing) == CommandStatus::active);) {
        EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
        rig.step();
    }
    EXPECT_EQ(rig.status(passing), CommandStatus::done);
    EXPECT_TRUE(rig.view().homed);
    ASSERT_EQ(rig.finished(move), CommandStatus::done);
    EXPECT_NEAR(rig.view().set_position, -30, 1e-9);
    rig.run(5);
    EXPECT_NEAR(rig.drive.position / 1000, -26, 0.012);
    EXPECT_LE(rig.drive.largest_step, 21);
}

TEST(PassiveHoming, ReferencePulseByTheDrivesLatch) {
    StepRig rig(StepRig::watched(), [](FakeDrive& drive) {
        drive.caps.probes = 2;
        drive.index_distance = 10'000;
        drive.index_at = 3000;
    });
    auto command = flying({.set_position = 100});
    std::get<HomingStepDetails>(command.details).step = HomingStep::flying_reference_pulse;
    std::get<HomingStepDetails>(command.details).reference.source = TriggerSource::index_pulse;
    rig.accept(at_velocity(20));
    const auto id = rig.accept(command);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_NEAR(rig.zero_is(), 97, 1e-9);
    rig.step();
    EXPECT_FALSE(rig.drive.last.probes[0].armed);
}

TEST(PassiveHoming, IsCancelledAloneAndHasLimits) {
    StepRig rig;
    const auto move = rig.accept(absolute(50, 20));
    const auto passing = rig.accept(flying({.switch_mode = mcRisingEdge, .set_position = 0}));
    rig.run(20);
    const auto cancelled = rig.accept({.kind = CommandKind::abort_passive_homing});
    EXPECT_EQ(rig.status(passing), CommandStatus::aborted);
    EXPECT_EQ(rig.status(cancelled), CommandStatus::done);
    EXPECT_EQ(rig.status(move), CommandStatus::active);

    const auto way = rig.accept(flying({.switch_mode = mcRisingEdge, .set_position = 0, .distance_limit = 2}));
    const double from = rig.drive.position;
    ASSERT_TRUE(rig.run_until([&] { return rig.status(way) == CommandStatus::error; }));
    EXPECT_EQ(rig.error_of(way), ErrorId::homing_limit_distance);
    EXPECT_NEAR(rig.drive.position - from, 2000, 50);
    const auto time = rig.accept(flying({.switch_mode = mcRisingEdge, .set_position = 0, .time_limit = 10ms}));
    rig.run(12);
    EXPECT_EQ(rig.error_of(time), ErrorId::homing_limit_time);
    EXPECT_EQ(rig.status(move), CommandStatus::active);
    EXPECT_FALSE(rig.view().homed);
}

TEST(PassiveHoming, EndsWithPowerWithErrorsAndWithActiveHoming) {
    StepRig rig;
    const auto by_homing = rig.accept(flying({.set_position = 0}));
    rig.accept(to_switch(mcOn, MC_HomeDirection::mcPositiveDirection));
    rig.step();
    EXPECT_EQ(rig.status(by_homing), CommandStatus::aborted);
    EXPECT_EQ(rig.refuse(flying({.set_position = 0})), ErrorId::state_forbids);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    EXPECT_EQ(rig.refuse(flying({.set_position = 0})), ErrorId::not_powered);
    rig.power_on();
    const auto by_error = rig.accept(flying({.set_position = 0}));
    rig.drive.fault_code = 0x8400;
    rig.run(3);
    EXPECT_EQ(rig.status(by_error), CommandStatus::error);
}

}  // namespace
}  // namespace taktwerk::axes::test
