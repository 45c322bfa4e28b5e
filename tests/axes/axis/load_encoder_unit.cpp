// A second encoder at the load: what it shows, when it stops the axis, and how it begins anew.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig with_load(bool shown = false, double counts_per_unit = 500, std::uint8_t bits = 32) {
    auto config = plain_axis();
    config.limits.jerk = infinity;
    config.homing.kind = HomingKind::set_here;
    config.load_encoder = {
        .on = true, .input = 0, .counts_per_unit = counts_per_unit, .inverted = true, .bits = bits, .tolerance = 0.5, .shown = shown};
    return config;
}

/// Motor: 1000 counts per u. The load's encoder turns the other way round and is read a cycle later.
struct Coupled : Rig {
    explicit Coupled(const AxisConfig& config = with_load()) : Rig(config) {
        axis.bind({.inputs = inputs});
        program = [this, &load = axis.config().load_encoder] {
            const auto raw = std::llround(-(drive.position / 1000 + slipped) * load.counts_per_unit);
            const unsigned unused = 64u - load.bits;
            inputs[0] =
                static_cast<std::int64_t>(static_cast<std::uint64_t>(raw) << unused >> unused);  // as a terminal gives it: without a sign
        };
        power_on();
    }
    std::array<std::int64_t, 1> inputs{};
    double slipped = 0;  // u that the load is ahead
};

TEST(LoadEncoder, IsComparedWithTheMotor) {
    Coupled rig;
    rig.accept(home(0));
    rig.run(5);
    rig.accept(absolute(80));
    double widest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        widest = std::max(widest, std::abs(rig.view().load_difference));
        return rig.view().state == AxisState::Standstill;
    }));
    EXPECT_LE(widest, 0.1 + 0.003) << "it is read a cycle later: 100 u/s for 1 ms";
    rig.run(5);
    EXPECT_NEAR(rig.view().load_difference, 0, 0.002);
    EXPECT_NEAR(rig.view().actual_position, 80, 1e-9) << "the motor's";
    rig.slipped = 0.3;
    rig.run(20);
    EXPECT_NEAR(rig.view().load_difference, 0.3, 0.002);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(LoadEncoder, BeyondItsToleranceTheAxisStopsAndIsNotHomed) {
    Coupled rig;
    rig.accept(home(0));
    rig.run(5);
    ASSERT_TRUE(rig.view().homed);
    rig.accept(at_velocity(20));
    rig.run(100);
    rig.slipped = -0.8;
    rig.run(9);
    EXPECT_TRUE(rig.alarms.empty()) << "for less than 10 ms";
    ASSERT_TRUE(rig.run_until([&] { return rig.raised(AxisAlarm::load_deviation); }, 5));
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_FALSE(rig.view().homed) << "nobody knows which of the two is right";
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, 0);
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    rig.run(50);
    EXPECT_NEAR(rig.view().load_difference, 0, 0.003) << "they begin alike again";
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

TEST(LoadEncoder, MayBeAWarning) {
    auto config = with_load();
    config.reactions.choose(AxisAlarm::load_deviation, ErrorReaction::warn);
    EXPECT_TRUE(check(config).empty());
    Coupled rig(config);
    rig.accept(at_velocity(20));
    rig.run(100);
    rig.slipped = 0.8;
    rig.run(30);
    EXPECT_TRUE(rig.raised(AxisAlarm::load_deviation));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.slipped = 0;
    rig.run(30);
    EXPECT_TRUE(rig.axis.active_alarms().empty());
}

TEST(LoadEncoder, MayBeTheActualPosition) {
    Coupled rig(with_load(true));
    rig.accept(home(0));
    rig.run(5);
    rig.accept(absolute(30));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.slipped = 0.25;
    rig.run(20);
    EXPECT_NEAR(rig.view().actual_position, 30.25, 0.002);
    EXPECT_EQ(rig.view().set_position, 30);
    EXPECT_NEAR(rig.view().following_error, 0, 1e-9) << "the drive's loop is on the motor";
}

// 200 u are 200,000 counts: a counter of 16 bits begins anew three times.
TEST(LoadEncoder, ItsCounterMayBeginAnew) {
    Coupled rig(with_load(false, 1000, 16));
    rig.accept(relative(200));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.run(5);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_NEAR(rig.view().load_difference, 0, 0.002);
}

// What gives the motor's counts another zero is no slip.
TEST(LoadEncoder, BeginsAnewWithTheMotorsZero) {
    Coupled rig;
    rig.enable = false;
    rig.run(20);
    rig.drive.offline = true;
    rig.run(10);
    rig.drive.offline = false;
    rig.drive.zero = 123456;
    ++rig.drive.epoch;
    rig.run(10);
    rig.axis.reset(Owner::program);
    rig.run(10);
    rig.power_on();
    rig.run(50);
    EXPECT_FALSE(rig.raised(AxisAlarm::load_deviation));
    EXPECT_NEAR(rig.view().load_difference, 0, 0.002);
}

TEST(LoadEncoder, BoundsOfItsKeys) {
    const auto problem_of = [](const std::function<void(LoadEncoderConfig&)>& change) {
        auto config = with_load();
        change(config.load_encoder);
        const auto problems = check(config);
        return problems.empty() ? std::string{} : problems[0].subject;
    };
    EXPECT_EQ(problem_of([](LoadEncoderConfig&) {}), "");
    EXPECT_EQ(problem_of([](LoadEncoderConfig& l) { l.counts_per_unit = 0; }), "axes.x.load_encoder.counts_per_unit");
    EXPECT_EQ(problem_of([](LoadEncoderConfig& l) { l.tolerance = 0; }), "axes.x.load_encoder.tolerance");
    EXPECT_EQ(problem_of([](LoadEncoderConfig& l) { l.bits = 7; }), "axes.x.load_encoder.bits");
    EXPECT_EQ(problem_of([](LoadEncoderConfig& l) { l.time = -1ms; }), "axes.x.load_encoder.time");
}

}  // namespace
}  // namespace taktwerk::axes::test
