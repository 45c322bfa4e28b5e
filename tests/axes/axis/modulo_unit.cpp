// Modulo axes: positions that repeat, directions, turns without end. PLCopen Part 1 v2.0, section 3.5.

#include "axes/axis/rational.hpp"
#include "axes/axis/units.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// A table of 360 degrees over a gear of 7:3.
AxisConfig table() {
    auto config = plain_axis();
    config.unit = "deg";
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360};
    config.modulo = 360;
    config.limits = {.velocity = 5000, .acceleration = 36000, .deceleration = 36000, .jerk = infinity};
    return config;
}

AxisCommand turn_to(double position, MC_Direction direction, double velocity = 1000) {
    return {.kind = CommandKind::move_absolute, .direction = direction, .position = position, .velocity = velocity};
}

struct Table : Rig {
    explicit Table(const AxisConfig& config = table()) : Rig(config) { power_on(); }
    /// Degrees from where it was, by the drive's counts: 70000 / 3 per turn.
    double turned(const AxisCommand& command) {
        const auto from = drive.last.position;
        accept(command);
        EXPECT_TRUE(run_to(AxisState::Standstill));
        return static_cast<double>(drive.last.position - from) * 360 * 3 / 70000;
    }
};
constexpr double count = 360.0 * 3 / 70000;  // degrees

TEST(Rational, IsTheSimplestFractionOfANumber) {
    const auto expect = [](double value, std::int64_t p, std::int64_t q) {
        const auto found = rational_of(value);
        ASSERT_TRUE(found) << value;
        EXPECT_EQ(found->numerator, p) << value;
        EXPECT_EQ(found->denominator, q) << value;
    };
    expect(1, 1, 1);
    expect(1.0 / 3, 1, 3);
    expect(0.667, 667, 1000);
    expect(22.5, 45, 2);
    expect(360.0 / 7, 360, 7);
    EXPECT_FALSE(rational_of(std::sqrt(2.0)));
    EXPECT_FALSE(rational_of(1e9));
    EXPECT_FALSE(rational_of(0));
    EXPECT_FALSE(rational_of(infinity));
}

TEST(ModuloConfig, IsASimpleRatioOfTheFeedWithoutLimits) {
    EXPECT_TRUE(check(table()).empty());
    const auto subject = [](AxisConfig config) {
        const auto problems = check(config);
        return problems.empty() ? std::string("none") : problems.front().subject;
    };
    auto config = table();
    config.modulo = -360;
    EXPECT_EQ(subject(config), "axes.x.modulo");
    config.modulo = infinity;
    EXPECT_EQ(subject(config), "axes.x.modulo");
    config.modulo = 360 * std::sqrt(0.5);
    EXPECT_EQ(subject(config), "axes.x.modulo");
    config.modulo = 120;
    EXPECT_EQ(subject(config), "none");
    config.limits.position_max = 100;
    EXPECT_EQ(subject(config), "axes.x.modulo");
}

// P1-142: at 100 with target 50: positive +310, negative -50, shortest -50. P1-141: 350 to 10 is +20, 10 to 350 is -20.
TEST(Modulo, DirectionsChooseTheWay) {
    Table rig;
    EXPECT_NEAR(rig.turned(turn_to(100, mcPositiveDirection)), 100, count);
    EXPECT_NEAR(rig.turned(turn_to(50, mcPositiveDirection)), 310, count);
    EXPECT_NEAR(rig.view().set_position, 50, 1e-9);
    EXPECT_EQ(rig.view().turns, 1);
    EXPECT_NEAR(rig.turned(turn_to(100, mcPositiveDirection)), 50, count);
    EXPECT_NEAR(rig.turned(turn_to(50, mcNegativeDirection)), -50, count);
    EXPECT_NEAR(rig.turned(turn_to(100, mcShortestWay)), 50, count);
    EXPECT_NEAR(rig.turned(turn_to(50, mcShortestWay)), -50, count);
    EXPECT_NEAR(rig.turned(turn_to(350, mcShortestWay)), -60, count);
    EXPECT_NEAR(rig.turned(turn_to(10, mcShortestWay)), 20, count);
    EXPECT_NEAR(rig.turned(turn_to(350, mcShortestWay)), -20, count);
}

// P1-142: current as the last motion; U-22: forwards when there was none.
TEST(Modulo, CurrentDirectionIsThatOfTheLastMotion) {
    Table rig;
    EXPECT_NEAR(rig.turned(turn_to(300, mcCurrentDirection)), 300, count);
    EXPECT_NEAR(rig.turned(turn_to(200, mcNegativeDirection)), -100, count);
    EXPECT_NEAR(rig.turned(turn_to(250, mcCurrentDirection)), -310, count);
    EXPECT_NEAR(rig.turned(turn_to(200, mcPositiveDirection)), 310, count);
    EXPECT_NEAR(rig.turned(turn_to(100, mcCurrentDirection)), 260, count);
}

// Already there: no turn, in any direction, after any number of moves whose sums round.
TEST(Modulo, AlreadyThereIsNoMotion) {
    Table rig;
    for (int i = 0; i < 20; ++i) {
        const double target = std::fmod(i * 33.3 + 0.1, 360);
        rig.turned(turn_to(target, mcPositiveDirection));
        for (const auto direction : {mcPositiveDirection, mcNegativeDirection, mcShortestWay, mcCurrentDirection})
            ASSERT_EQ(rig.turned(turn_to(target, direction)), 0) << target;
    }
}

// P1-140: numbers outside [0, modulo) could mean a place or a number of turns: refused.
TEST(Modulo, TargetsOutsideTheRangeAreRefused) {
    Table rig;
    for (const double target : {-1.0, 360.0, 725.0}) EXPECT_EQ(rig.refuse(turn_to(target, mcPositiveDirection)), ErrorId::invalid_position);
    EXPECT_NEAR(rig.turned(turn_to(359.999, mcPositiveDirection)), 359.999, count);
    const auto id = rig.accept(turn_to(10, mcPositiveDirection));
    EXPECT_EQ(rig.axis.update(id, turn_to(360, mcPositiveDirection), Owner::program), ErrorId::invalid_position);
}

AxisCommand whole_turns_to(double position, MC_Direction direction) {
    auto command = turn_to(position, direction);
    command.details = WholeTurns{};
    return command;
}

// MC_MoveModulo from 90: the way to the place in the direction, and a turn for each whole modulo.
TEST(ModuloTurns, AreMadeOnTopOfTheWayInItsDirection) {
    struct Case {
        double target;
        MC_Direction direction;
        double way;
    };
    for (const auto& c : {Case{0, mcPositiveDirection, 270}, Case{360, mcPositiveDirection, 630}, Case{720, mcPositiveDirection, 990},
                          Case{90, mcPositiveDirection, 0}, Case{450, mcPositiveDirection, 360}, Case{100, mcPositiveDirection, 10},
                          Case{0, mcNegativeDirection, -90}, Case{360, mcNegativeDirection, -450}, Case{450, mcNegativeDirection, -360},
                          Case{90, mcNegativeDirection, 0}, Case{500, mcShortestWay, 50}, Case{360 + 350, mcShortestWay, -100},
                          Case{460, mcCurrentDirection, 370}}) {
        Table rig;
        rig.turned(turn_to(90, mcPositiveDirection));
        EXPECT_NEAR(rig.turned(whole_turns_to(c.target, c.direction)), c.way, count) << c.target << ' ' << c.direction;
        EXPECT_NEAR(rig.view().set_position, std::fmod(c.target, 360), 1e-9);
    }
}

// 0.3 / 0.1 is a little less than 3: three turns all the same.
TEST(ModuloTurns, AreCountedWholeWhereTheDivisionRounds) {
    auto config = table();
    config.gearing.feed = 1;
    config.modulo = 0.1;
    config.limits = {.velocity = 1, .acceleration = 10, .deceleration = 10, .jerk = infinity};
    Rig rig(config);
    rig.power_on();
    auto command = whole_turns_to(0.3, mcPositiveDirection);
    command.velocity = 1;
    rig.accept(command);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position), 0.3 * 70000 / 3, 1);
}

TEST(ModuloTurns, NeedAModuloAxisAndAPositionThatIsNotNegative) {
    Table rig;
    EXPECT_EQ(rig.refuse(whole_turns_to(-1, mcPositiveDirection)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(whole_turns_to(infinity, mcPositiveDirection)), ErrorId::invalid_position);
    Rig linear;
    linear.power_on();
    auto command = whole_turns_to(10, mcPositiveDirection);
    command.velocity = 10;
    EXPECT_EQ(linear.refuse(command), ErrorId::not_supported);
}

// Behind another move they count from its end; blended too.
TEST(ModuloTurns, CountFromTheEndOfTheMoveBefore) {
    for (const auto mode : {mcBuffered, mcBlendingHigh}) {
        Table rig;
        const auto from = rig.drive.last.position;
        rig.accept(turn_to(300, mcPositiveDirection));
        auto next = whole_turns_to(370, mcPositiveDirection);
        next.buffer_mode = mode;
        rig.accept(next);
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count, 300 + 70 + 360, count);
    }
}

// MC_MoveRelative turns as often as it is told, and back.
TEST(Modulo, RelativeMovesTurnAnyNumberOfTimes) {
    Table rig;
    auto ten_turns = relative(3605, 4000);
    EXPECT_NEAR(rig.turned(ten_turns), 3605, count);
    EXPECT_NEAR(rig.view().set_position, 5, 1e-9);
    EXPECT_EQ(rig.view().turns, 10);
    EXPECT_NEAR(rig.turned(relative(-3605 - 90, 4000)), -3695, count);
    EXPECT_NEAR(rig.view().set_position, 270, 1e-9);
    EXPECT_EQ(rig.view().turns, -1);
}

// P1-095: at 1000 deg/s braking takes 1000^2 / 72000 = 13.9 degrees. A target 5 degrees ahead with a fixed direction is met a turn later without a
// reversal; one 20 degrees ahead in this turn. The shortest way turns back for it.
TEST(Modulo, ATargetTooNearToStopIsMetATurnLater) {
    struct Case {
        double ahead;
        MC_Direction direction;
        double sense, expected;
        bool reverses;
    };
    for (const auto& c :
         {Case{5, mcPositiveDirection, 1, 365, false}, Case{20, mcPositiveDirection, 1, 20, false},
          Case{5, mcNegativeDirection, -1, 365, false}, Case{5, mcCurrentDirection, -1, 365, false}, Case{5, mcShortestWay, 1, 5, true}}) {
        Table rig;
        rig.accept(at_velocity(1000 * c.sense));
        rig.run(777);
        ASSERT_EQ(rig.view().set_velocity, 1000 * c.sense);
        const auto from = rig.axis.drive_command().position;
        double target = std::fmod(rig.view().set_position + c.sense * c.ahead + 360, 360);
        rig.accept(turn_to(target, c.direction));
        bool reversed = false;
        ASSERT_TRUE(rig.run_until([&] {
            reversed = reversed || rig.view().set_velocity * c.sense < 0;
            return rig.view().state == AxisState::Standstill;
        }));
        EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count * c.sense, c.expected, 2 * count) << c.ahead;
        EXPECT_EQ(reversed, c.reverses) << c.ahead;
    }
}

// P1-095: whether it can stop in time is a matter of the new command's own deceleration. From 1000 deg/s with 1000 deg/s2 it takes 500 deg,
// so a target 20 deg ahead is met two turns later; with the axis' own deceleration it would be met at once.
TEST(Modulo, AGentleDecelerationNeedsMoreTurns) {
    Table rig;
    rig.accept(at_velocity(1000));
    rig.run(777);
    ASSERT_EQ(rig.view().set_velocity, 1000);
    const auto from = rig.axis.drive_command().position;
    auto command = turn_to(std::fmod(rig.view().set_position + 20, 360), mcPositiveDirection);
    command.deceleration = 1000;
    rig.accept(command);
    bool reversed = false;
    ASSERT_TRUE(rig.run_until([&] {
        reversed = reversed || rig.view().set_velocity < 0;
        return rig.view().state == AxisState::Standstill;
    }));
    EXPECT_FALSE(reversed);
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count, 740, 2 * count);
}

// A fixed direction against the motion: the axis has to turn, then goes to the first repetition seen from where the command came.
TEST(Modulo, FixedDirectionAgainstTheMotionTurns) {
    Table rig;
    rig.accept(at_velocity(-1000));
    rig.run(500);
    const auto from = rig.axis.drive_command().position;
    rig.accept(turn_to(std::fmod(rig.view().set_position + 30 + 360, 360), mcPositiveDirection));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count, 30, 2 * count);
}

// Rule 5 of blending: the second's turn is the one it would take from a stop, and the joint is passed.
TEST(Modulo, BlendedMoveTakesTheTurnOfABufferedOne) {
    for (const auto mode : {mcBuffered, mcBlendingHigh}) {
        Table rig;
        const auto from = rig.drive.last.position;
        const auto first = rig.accept(turn_to(300, mcPositiveDirection));
        auto next = turn_to(100, mcShortestWay, 2000);
        next.buffer_mode = mode;
        rig.accept(next);
        double slowest = infinity;
        ASSERT_TRUE(rig.run_until([&] {
            if (rig.status(first) == CommandStatus::done && rig.view().set_position > 330)
                slowest = std::min(slowest, rig.view().set_velocity);
            return rig.view().state == AxisState::Standstill;
        }));
        EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count, 460, count);
        EXPECT_GT(slowest, mode == mcBuffered ? 100 : 1990);
    }
}

// P1-171 on a modulo axis: it goes on for ever, positions stay inside.
TEST(Modulo, PositionsStayInTheRange) {
    Table rig;
    rig.accept(at_velocity(-3333));
    for (int i = 0; i < 20'000; ++i) {
        rig.step();
        ASSERT_GE(rig.view().set_position, 0) << i;
        ASSERT_LT(rig.view().set_position, 360) << i;
        ASSERT_GE(rig.view().actual_position, 0) << i;
        ASSERT_LT(rig.view().actual_position, 360) << i;
    }
}

// No drift over 10^9 turns. The anchor is a whole number n of feeds; the place in the modulo is (n * q mod p) / p of it, in integers, so it cannot
// drift: checked where the turns are 10^9 and the modulo is 3/7 of the feed. n feeds are 7n/3 moduli: for n = 10^9 + 1 that is
// 2 333 333 335 + 2/3 (7 * (10^9 + 1) = 3 * 2333333335 + 2), so the place is 2/3 of the modulo.
TEST(Modulo, NothingDriftsInAThousandMillionTurns) {
    const Gearing gearing{.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 70};
    AxisUnits units(gearing, 30);
    double local = units.reanchor(70.0 * 1e9);  // whole feeds: exact
    local = units.reanchor(local + 70);
    ASSERT_EQ(local, 0);
    EXPECT_DOUBLE_EQ(units.to_program(0), 20);
    EXPECT_EQ(units.turns(0), 2'333'333'335);
    EXPECT_DOUBLE_EQ(units.to_program(12.5), 2.5);
    EXPECT_EQ(units.turns(12.5), 2'333'333'336);
    EXPECT_NEAR(std::remainder(units.to_local(20) - 0, 30), 0, 1e-12);
    // Backwards the same.
    AxisUnits back(gearing, 30);
    (void)back.reanchor(-70.0 * 1e9);
    (void)back.reanchor(-70.0);
    EXPECT_DOUBLE_EQ(back.to_program(0), 10);
    EXPECT_EQ(back.turns(0), -2'333'333'336);
}

// MC_SetPosition gives the place another number, the nearest way round; the target's number stays (P1-200).
TEST(Modulo, SetPositionShiftsTheNumbers) {
    Table rig;
    rig.turned(turn_to(350, mcShortestWay));
    EXPECT_EQ(rig.axis.set(SetPosition{5, false}, Owner::program), ErrorId::none);
    EXPECT_NEAR(rig.view().actual_position, 5, 1e-9);
    const auto from = rig.drive.last.position;
    rig.accept(turn_to(100, mcPositiveDirection));
    rig.run(20);
    EXPECT_EQ(rig.axis.set(SetPosition{10, true}, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.view().set_position, 100, 1e-9);
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position - from) * count, 85,
                2 * count);  // the actual position that got the number is a whole count
}

}  // namespace
}  // namespace taktwerk::axes::test
