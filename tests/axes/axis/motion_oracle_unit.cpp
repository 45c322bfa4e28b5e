// The oracle that every rig and walk relies on sees what it is there for: a clean motion passes, and each kind of break is told.

#include "tests/axes/axis/motion_oracle.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr Duration cycle = 1ms;

/// A motion with jerk 10000 u/s3 up to 200 u/s2 and on, in exact formulas: a = j t, v = j t2 / 2, s = j t3 / 6; then v + a t.
struct Story {
    AxisView view;
    DriveCommand command;
};
Story at(int k) {
    const double j = 10'000, ramp = 0.02, t = k * 1e-3;
    const double s = std::min(t, ramp), rest = t - s;
    const double a = j * s, v = j * s * s / 2, p = j * s * s * s / 6;
    Story out;
    out.view.state = AxisState::DiscreteMotion;
    out.view.active = 1;
    out.view.active_kind = CommandKind::move_absolute;
    out.view.powered = out.view.online = true;
    out.view.drive_state = PowerState::enabled;
    out.view.drive_mode = DriveMode::cyclic_position;
    out.view.set_acceleration = a;
    out.view.set_velocity = v + a * rest;
    out.view.set_position = p + v * rest + a * rest * rest / 2;
    out.view.actual_position = out.view.set_position;
    out.command.power = PowerRequest::on;
    out.command.mode = DriveMode::cyclic_position;
    out.command.position = std::llround(out.view.set_position * 1000);
    out.command.velocity = out.view.set_velocity * 1000;
    return out;
}

/// What the oracle says of the motion with `alter` from cycle 60 on.
std::string told_of(const std::function<void(Story&, int)>& alter) {
    const auto config = plain_axis();
    MotionOracle oracle(config, cycle);
    for (int k = 0; k < 100; ++k) {
        auto story = at(k);
        if (k >= 60) alter(story, k);
        oracle.observe(story.view, story.command, config.limits);
    }
    EXPECT_GT(oracle.compared(), 50);
    return oracle.report();
}

using Break = std::pair<const char*, std::function<void(Story&, int)>>;

TEST(MotionOracle, PassesACleanMotion) {
    EXPECT_EQ(told_of([](Story&, int) {}), "");
}

TEST(MotionOracle, SeesEachKindOfBreak) {
    const std::vector<Break> breaks{
        {"stands", [](Story& s, int) { s.view.state = AxisState::Standstill; }},
        {"off by", [](Story& s, int) { s.view.set_position = at(59).view.set_position; }},       // frozen, the view says it moves
        {"off by", [](Story& s, int) { s.view.set_position += 2e-5; }},                          // a fiftieth of a count
        {"is told a way", [](Story& s, int) { s.command.position = at(59).command.position; }},  // frozen at the drive alone
        {"differ by", [](Story& s, int k) { s.command.position += k - 60; }},                    // creeps away at the drive
        {"beside its position", [](Story& s, int) { s.command.velocity *= 1.001; }},             // feed-forward
        {"velocity 0 after", [](Story& s, int) { s.view.set_velocity = 0; }},                    // a stop in one cycle
        {"does not agree with accelerations", [](Story& s, int k) { s.view.set_velocity += 0.01 * (k - 59); }},
        {"acceleration 0 after", [](Story& s, int) { s.view.set_acceleration = 0; }},  // a kink, jerk is limited
        {"accelerates with", [](Story& s, int) { s.view.set_acceleration = 1001; }},
        {"is in ErrorStop with error 0", [](Story& s, int) { s.view.state = AxisState::ErrorStop; }},
        {"without power", [](Story& s, int) { s.view.powered = false; }},
        {"wait behind nobody", [](Story& s, int) { s.view.active = 0, s.view.queued_count = 1; }},
        {"has a set value nan", [](Story& s, int) { s.view.set_velocity = std::nan(""); }},
    };
    for (const auto& [words, alter] : breaks) EXPECT_NE(told_of(alter).find(words), std::string::npos) << words << "\n" << told_of(alter);
}

/// From 2 u/s on with -200 u/s2: released with the axis' own jerk of 20000 u/s3 it would come to 2 - 200^2 / 40000 = 1 u/s; with 5000 u/s3 to -2.
std::string told_of_a_stop(double jerk, const std::function<void(AxisView&)>& how, double begin = 2) {
    const auto config = plain_axis();
    MotionOracle oracle(config, cycle);
    for (int k = -20; k < 60; ++k) {
        const double t = k * 1e-3;
        const double release = 200 / jerk, s = std::clamp(t, 0.0, release), before = std::min(t, 0.0), after = std::max(t - release, 0.0);
        auto story = at(0);
        story.view.set_acceleration = -200 + jerk * s;
        const double end = begin - 200 * release / 2;
        story.view.set_velocity = begin - 200 * before - 200 * s + jerk * s * s / 2;
        story.view.set_position = (begin - 100 * before) * before + (begin - 100 * s) * s + jerk * s * s * s / 6 + end * after;
        story.view.actual_position = story.view.set_position;
        story.command.position = std::llround(story.view.set_position * 1000);
        if (k > 0) how(story.view);
        story.command.velocity = story.view.set_velocity * 1000;
        oracle.observe(story.view, story.command, config.limits);
    }
    EXPECT_GT(oracle.compared(), 50);
    return oracle.report();
}

// Whoever stops it: from then on it does not turn round. A motion may.
TEST(MotionOracle, AStopNeverReverses) {
    const std::vector<std::function<void(AxisView&)>> stops{
        [](AxisView& view) { view.limiter = VelocityLimiter::stopping; },
        [](AxisView& view) { view.state = AxisState::Stopping; },
        [](AxisView& view) { view.state = AxisState::ErrorStop, view.error = 1; },
        [](AxisView& view) { view.limiter = VelocityLimiter::override_factor, view.override_factors.velocity = 0; },
    };
    const auto moves = [](AxisView&) {};
    for (const auto& stop : stops) {
        EXPECT_NE(told_of_a_stop(5000, stop).find("while it stops"), std::string::npos) << told_of_a_stop(5000, stop);
        EXPECT_EQ(told_of_a_stop(10'000, stop), "") << "just ends at 0";
        EXPECT_EQ(told_of_a_stop(20'000, stop), "");
    }
    EXPECT_EQ(told_of_a_stop(5000, moves), "");
    // Standing, it begins nothing.
    const auto creeps = [n = 0](AxisView& view) mutable {
        view.state = AxisState::Stopping;
        if (++n > 40) view.set_velocity = 0.1;
    };
    EXPECT_NE(told_of_a_stop(10'000, creeps).find("runs at"), std::string::npos);
}

// A jerk above the axis' own is for stops, and only as high as it has to be.
TEST(MotionOracle, AStopsJerkIsWhatItNeeds) {
    const auto stop = [](AxisView& view) { view.state = AxisState::Stopping; };
    EXPECT_EQ(told_of_a_stop(40'000, stop, 0.5), "");
    EXPECT_NE(told_of_a_stop(50'000, stop, 0.5).find("the jerk"), std::string::npos);
    EXPECT_NE(told_of_a_stop(
                  40'000, [](AxisView&) {}, 0.5)
                  .find("the jerk"),
              std::string::npos);
}

// A new number for the same place is no jump; a jump of the drive with a new number is one.
TEST(MotionOracle, KnowsCoordinatesFromMotion) {
    const auto renumber = [](Story& s, int) { s.view.set_position += 7, s.view.actual_position += 7; };
    EXPECT_EQ(told_of(renumber), "");
    EXPECT_NE(told_of([&](Story& s, int k) { renumber(s, k), s.command.position += 7000; }), "");
}

// Also where the new number is nearly the old one, less than a motion might make in a cycle: three counts that a drive lagged when it was homed. Where the
// actual position says nothing of it, the view has left the drive.
TEST(MotionOracle, KnowsCoordinatesThatAreNearlyTheSameFromADriveThatIsLeft) {
    const auto told_at_rest = [](double set, double actual) {
        auto config = trapezoids(100);  // 1000 u/s2 without a jerk limit: 2.5e-4 u in a cycle from rest to rest
        config.gearing.counts_per_revolution = 200'000;
        MotionOracle oracle(config, cycle);
        for (int k = 0; k < 40; ++k) {
            auto story = at(0);
            story.view.set_velocity = story.view.set_acceleration = 0;
            story.view.set_position = k < 20 ? 0 : set;
            story.view.actual_position = -0.003 + (k < 20 ? 0 : actual);
            story.command.position = 0;
            story.command.velocity = 0;
            oracle.observe(story.view, story.command, config.limits);
        }
        return oracle.report();
    };
    for (const double shift : {0.00006, 0.00015, 0.0002, 0.003, 0.02}) {
        EXPECT_EQ(told_at_rest(shift, shift), "") << shift;
        EXPECT_NE(told_at_rest(shift, 0), "") << shift;
    }
    EXPECT_NE(told_at_rest(0.00015, 0.00005), "") << "the motor may have made that by itself";
}

// A stepper comes to rest in the very cycle in which its reference is found, a count beside the one before: the actual position changes by both.
TEST(MotionOracle, KnowsAReferenceBesideAMotorThatComesToRest) {
    const auto told_at_rest = [](double set, double actual, bool finds_it) {
        const auto config = plain_axis();
        const double count = 1 / config.gearing.counts_per_unit();
        MotionOracle oracle(config, cycle);
        for (int k = 0; k < 40; ++k) {
            auto story = at(0);
            story.view.set_velocity = story.view.set_acceleration = 0;
            story.view.homed = !finds_it || k >= 20;
            story.view.set_position = k < 20 ? 0 : set * count;
            story.view.actual_position = k < 20 ? 0 : actual * count;
            story.command.position = 0;
            story.command.velocity = 0;
            oracle.observe(story.view, story.command, config.limits);
        }
        return oracle.report();
    };
    for (const double motor : {-1, 0, 1}) EXPECT_EQ(told_at_rest(1, 1 + motor, true), "") << motor;
    EXPECT_NE(told_at_rest(1, 2, false), "") << "no reference was found";
    EXPECT_NE(told_at_rest(3, 0, true), "") << "the actual position says nothing of it";
}

// A stop has left 3.5e-10 u of a move, which the next move goes in one cycle: of that no actual value says anything.
TEST(MotionOracle, LetsAnAxisGoWhatIsNearlyNothing) {
    const auto told_at_rest = [](double way) {
        const auto config = plain_axis();
        MotionOracle oracle(config, cycle);
        for (int k = 0; k < 40; ++k) {
            auto story = at(0);
            story.view.set_velocity = story.view.set_acceleration = 0;
            story.view.set_position = 90 - (k < 20 ? way : 0);
            story.view.actual_position = 90;
            story.command.position = 90'000;
            story.command.velocity = 0;
            oracle.observe(story.view, story.command, config.limits);
        }
        return oracle.report();
    };
    EXPECT_EQ(told_at_rest(3.4586378205858637e-10), "");
    EXPECT_NE(told_at_rest(1e-6), "") << "the jerk limit allows a third of that";
}

// Feedback that was lost comes back with the new number: the actual position has 30 cycles to make up, 0.39 u, and no more.
TEST(MotionOracle, KnowsCoordinatesFromMotionWhereFeedbackComesBack) {
    const auto returns = [](double more) {
        return [more](Story& s, int k) {
            if (k < 90) s.view.actual_position = at(59).view.actual_position;
            else s.view.set_position += 7, s.view.actual_position += 7 + more;
        };
    };
    EXPECT_EQ(told_of(returns(0)), "");
    EXPECT_NE(told_of(returns(1)).find("off by"), std::string::npos);
    EXPECT_NE(told_of([&](Story& s, int k) {
                  returns(0)(s, k);
                  if (k >= 90) s.command.position += 7000;
              }).find("is told a way"),
              std::string::npos);
}

TEST(MotionOracle, WatchesVelocityAndSoftwareLimits) {
    auto config = plain_axis();
    config.limits.velocity = 5;
    MotionOracle velocity(config, cycle);
    for (int k = 0; k < 60; ++k) velocity.observe(at(k).view, at(k).command, config.limits);
    EXPECT_NE(velocity.report().find("runs at"), std::string::npos);

    config = plain_axis();
    config.limits.position_max = 0.1;
    MotionOracle place(config, cycle);
    for (int k = 0; k < 60; ++k) {
        auto story = at(std::max(0, k - 10));
        story.view.homed = true;
        if (k < 10) story.view.state = AxisState::Standstill, story.view.active = 0;
        place.observe(story.view, story.command, config.limits);
    }
    EXPECT_NE(place.report().find("beyond its software limits"), std::string::npos) << place.report();
}

// Without power, in another mode, and until the drive has taken its mode, nothing is compared.
TEST(MotionOracle, LooksAwayWhereTheDriveTakesNothing) {
    const auto jumps = [](Story& s) { s.view.set_position += 100; };
    const std::vector<std::function<void(Story&, int)>> cases{
        [&](Story& s, int) { jumps(s), s.view.drive_state = PowerState::switched_on; },
        [&](Story& s, int) { jumps(s), s.command.mode = s.view.drive_mode = DriveMode::cyclic_torque; },
        [&](Story& s, int) { jumps(s), s.command.mode = DriveMode::homing; },
    };
    for (const auto& alter : cases) EXPECT_EQ(told_of(alter), "");
}

}  // namespace
}  // namespace taktwerk::axes::test
