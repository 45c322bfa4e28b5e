// The oracles of the campaign and of the soak see what they are there for: each is shown what it has to find, and beside it the same thing in order.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "tests/whole_machine/rig.hpp"

namespace taktwerk::whole {
namespace {

using runtime::OperatorAction;

/// A machine in operation, led by hand, with power.
struct Watched : ::testing::Test {
    void SetUp() override {
        rig.m.machine->start_bus();
        ASSERT_TRUE(rig.until([&] { return rig.m.machine->bus().phase() == ecat::Master::Phase::operational; }, 60s));
        ASSERT_TRUE(rig.m.machine->arm());
        rig.mode(runtime::Mode::manual);
        rig.run(20ms);
        (void)rig.submit(OperatorAction::power, 0, true);
        ASSERT_TRUE(rig.until([&] { return rig.m.axis(0).powered; }, 3s));
        rig.run(50ms);
        ASSERT_TRUE(said().empty()) << said();
    }
    /// All that is wrong so far.
    std::string said() {
        rig.gather();
        std::string all;
        for (const auto& problem : rig.problems) all += problem + "\n";
        return all;
    }
    [[nodiscard]] bool says(std::string_view what) { return said().find(what) != std::string::npos; }
    void drive_falls() {
        rig.m.world.drive("x")->raise(0x3130);
        ASSERT_TRUE(rig.until([&] { return rig.seen.contains("drive_fault"); }, 1s));
    }

    Rig rig{"minimal"};
};

TEST_F(Watched, AnAlarmThatNothingExplainsIsSaid) {
    drive_falls();
    EXPECT_TRUE(says("nobody knows why: drive_fault of axis x")) << said();
}

TEST_F(Watched, OneThatSomethingExplainsIsNot) {
    rig.happens(Trouble::drive_fault, "x");
    drive_falls();
    EXPECT_EQ(said(), "");
}

TEST_F(Watched, WhatHappenedElsewhereExplainsNothing) {
    rig.happens(Trouble::drive_fault, "y");
    drive_falls();
    EXPECT_TRUE(says("nobody knows why")) << said();
}

TEST_F(Watched, WhatHappenedLongAgoExplainsNothing) {
    rig.happens(Trouble::drive_fault, "x");
    rig.run(Rig::aftermath + 100ms);
    drive_falls();
    EXPECT_TRUE(says("nobody knows why")) << said();
}

TEST_F(Watched, WhatLastsExplains) {
    (void)rig.begins(Trouble::mains_lost, "x");
    rig.run(Rig::aftermath + 100ms);
    drive_falls();
    EXPECT_EQ(said(), "");
}

// A jog may lead an axis against something; one that was refused has led nothing anywhere.
TEST_F(Watched, ACommandExplainsOnceItIsAccepted) {
    (void)rig.submit(OperatorAction::jog, 0, true, 1);
    rig.run(5ms);
    drive_falls();
    EXPECT_EQ(said(), "");
}

TEST_F(Watched, ACommandThatWasRefusedExplainsNothing) {
    rig.mode(runtime::Mode::automatic);
    rig.run(50ms);
    (void)rig.submit(OperatorAction::jog, 0, true, 1);
    rig.run(5ms);
    ASSERT_NE(rig.answer().answer, runtime::Answer::accepted);
    drive_falls();
    EXPECT_TRUE(says("nobody knows why")) << said();
}

TEST_F(Watched, ACommandWithoutAnAnswerIsSaid) {
    auto looks = rig.m.on_cycle;
    rig.m.on_cycle = [&] {
        while (rig.m.machine->next_answer()) {}  // somebody takes them away
        looks();
    };
    (void)rig.submit(OperatorAction::acknowledge_alarms);
    rig.run(45ms);
    EXPECT_EQ(said(), "");
    rig.run(10ms);
    EXPECT_TRUE(says("has no answer")) << said();
}

TEST_F(Watched, AnAnswerToNobodyIsSaid) {
    runtime::OperatorCommand command;
    command.action = OperatorAction::acknowledge_alarms;
    command.client = 1;
    command.sequence = 4711;
    command.after = rig.m.machine->levels_raised();
    ASSERT_TRUE(rig.m.machine->submit(command));
    rig.run(10ms);
    EXPECT_TRUE(says("command 4711 is answered twice, or was never given")) << said();
}

/// What the rig says when one more of its oracles is told this.
struct Lied : Watched {
    std::string told_of(const axes::AxisView& view, const runtime::testing::ToldDrive& told) {
        auto& oracles = rig.m.oracles;
        oracles.push_back(oracles.front());
        oracles.back().observe(view, told, true);
        auto all = said();
        oracles.pop_back();
        return all;
    }
};

// Each kind of lie by itself: tests/runtime/drive_oracle_machine.cpp. Here: that what the oracles of the machine find is among the problems.
TEST_F(Lied, ASetPointThatJumpsIsSaid) {
    auto view = rig.m.axis(0);
    view.set_position += 1;
    EXPECT_NE(told_of(view, rig.m.told(0)), "");
}

TEST_F(Lied, ADriveThatIsToldSomethingElseIsSaid) {
    auto told = rig.m.told(0);
    told.position = told.position.value_or(0) + 13107;  // a millimetre
    EXPECT_NE(told_of(rig.m.axis(0), told), "");
}

TEST_F(Lied, ATrueLookIsNot) { EXPECT_EQ(told_of(rig.m.axis(0), rig.m.told(0)), ""); }

constexpr std::uint16_t z = 2;

/// demo with another z, led by hand; what its places say.
struct LedByHand {
    explicit LedByHand(const std::function<void(runtime::AxisBinding&)>& config,
                       const std::function<void(runtime::AxisBinding&)>& there = {}) {
        auto told = load("demo", disk.path().string());
        EXPECT_EQ(told.axes[z].axis.name, "z");
        if (config) config(told.axes[z]);
        auto real = told;
        if (there) there(real.axes[z]);
        m = std::make_unique<runtime::testing::TestMachine>(std::move(told), real);
        m->on_cycle = [this] { said += places.look(*m); };
        EXPECT_TRUE(m->up());
        (void)m->mode(runtime::Mode::manual);
        m->enable(z);
    }
    PrivateDisk disk;
    std::unique_ptr<runtime::testing::TestMachine> m;
    Places places;
    std::string said;
};

// Homed by the runtime on a switch that stands a millimetre from where the file says.
TEST(WatchedPlaces, AReferenceThatIsNotAtItsEdgeIsSaid) {
    for (const double off : {0.0, -1.0}) {
        LedByHand hand({}, [&](runtime::AxisBinding& there) {
            *there.simulation.home_from += off;
            *there.simulation.home_to += off;
        });
        hand.m->home(z);
        hand.m->run(100ms);
        EXPECT_GT(hand.places.references(), 0);
        EXPECT_EQ(hand.said.find("axis z stands") != std::string::npos, off != 0) << hand.said;
    }
}

// Set where it stands, a second time and elsewhere: who was not told of it sees an axis that shows another place at the same counts.
TEST(WatchedPlaces, AnAxisThatShowsAnotherPlaceAtTheSameCountsIsSaid) {
    for (const bool told : {true, false}) {
        LedByHand hand([](runtime::AxisBinding& axis) { axis.axis.homing.kind = axes::HomingKind::set_here; });
        auto& m = *hand.m;
        m.home(z);
        (void)m.command(OperatorAction::move_absolute, z, false, 10, 50);
        ASSERT_TRUE(m.until([&] { return m.axis(z).state == axes::AxisState::Standstill && m.axis(z).set_position == 10; }, 5s));
        m.run(1s);
        EXPECT_EQ(hand.said, "");
        EXPECT_GT(hand.places.compared(), 100);
        if (told) hand.places.asked_for_reference(z);
        m.home(z);
        m.run(1s);
        EXPECT_EQ(hand.said.find("off by") != std::string::npos, !told) << hand.said;
    }
}

// A motor without an encoder that was held: it has lost steps, and what its drive says is no lie of the axis'. Held before its homing ends it is compared.
TEST(WatchedPlaces, AMotorWithoutAnEncoderIsComparedUntilItMayHaveLostSteps) {
    for (const bool told : {true, false}) {
        LedByHand hand({});
        auto& m = *hand.m;
        m.home(z);
        EXPECT_GT(hand.places.references(), 0) << "at the end of its homing";
        if (told) hand.places.shaken();
        m.world.drive("z")->jam(true);
        (void)m.command(OperatorAction::move_absolute, z, false, 10, 50);
        m.run(100ms);
        m.world.drive("z")->jam(false);
        m.run(2s);
        EXPECT_EQ(hand.said.find("axis z stands") != std::string::npos, !told) << hand.said;
    }
}

// And so it ends up at its limit switch, long after: that is explained by what has cost it steps, and by nothing else.
TEST(WatchedPlaces, ALimitSwitchIsExplainedByLostStepsOnly) {
    for (const bool told : {true, false}) {
        Rig rig{"demo"};
        rig.m.machine->start_bus();
        ASSERT_TRUE(rig.until([&] { return rig.m.machine->bus().phase() == ecat::Master::Phase::operational; }, 60s));
        ASSERT_TRUE(rig.m.machine->arm());
        rig.mode(runtime::Mode::manual);
        rig.run(20ms);
        (void)rig.submit(OperatorAction::power, z, true);
        ASSERT_TRUE(rig.until([&] { return rig.m.axis(z).powered; }, 3s));
        (void)rig.submit(OperatorAction::home, z);
        ASSERT_TRUE(rig.until([&] { return rig.m.axis(z).homed && rig.m.axis(z).state == axes::AxisState::Standstill; }, 30s));

        const auto jammed = told ? std::optional{rig.begins(Trouble::jammed, "z")} : std::nullopt;
        rig.m.world.drive("z")->jam(true);
        (void)rig.submit(OperatorAction::move_absolute, z, false, 60, 50);
        rig.run(3s);
        rig.m.world.drive("z")->jam(false);
        if (jammed) rig.ended(*jammed);
        ASSERT_EQ(rig.m.axis(z).set_position, 60) << "it does not know";

        (void)rig.submit(OperatorAction::move_absolute, z, false, 5, 2);
        ASSERT_TRUE(rig.until([&] { return rig.seen.contains("negative_limit_switch"); }, 40s)) << rig.standing();
        ASSERT_LT(rig.m.axis(z).set_position, 60 - 2 * to_seconds(Rig::aftermath)) << "the command still explains it";
        rig.gather();
        const bool said = std::any_of(rig.problems.begin(), rig.problems.end(),
                                      [](const auto& one) { return one.find("nobody knows why: negative_limit") != std::string::npos; });
        EXPECT_EQ(said, !told) << rig.story();
    }
}

}  // namespace
}  // namespace taktwerk::whole
