// MC_Jog: levels, priorities, lease, modes. Manual velocities of the fake axis: slow 5 u/s, fast 25 u/s.
#include <gtest/gtest.h>

#include "fb_library/motion/jog.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandKind;
using axes::Outcome;

struct Jog : testing::Test {
    Jog() {
        block.Axis = {0};
        block.Mode = mcJogContinuous;
        block.Velocity = 10, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    }
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    std::vector<FakeAxes::Call> submitted() const { return axes.calls_of("submit"); }
    std::vector<FakeAxes::Call> renewed() const { return axes.calls_of("renew_jog"); }

    FakeAxes axes{2};
    MC_Jog block{};
};

TEST_F(Jog, ContinuousTakesTheBlocksDynamics) {
    block.JogForward = true;
    scan();
    const auto c = submitted().at(0).command;
    EXPECT_EQ(c.kind, CommandKind::jog);
    EXPECT_EQ(c.velocity, 10);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
}

TEST_F(Jog, BackwardsIsNegative) {
    block.JogBackwards = true;
    scan();
    EXPECT_EQ(submitted().at(0).command.velocity, -10);
    EXPECT_EQ(renewed().at(0).value, -10);
}

TEST_F(Jog, SlowAndFastTakeTheAxisManualVelocitiesAndDefaults) {
    for (const auto& [mode, velocity] : {std::pair{mcJogStandardSlow, 5.0}, {mcJogStandardFast, 25.0}}) {
        FakeAxes fresh;
        MC_Jog jog = block;
        jog.Mode = mode;
        jog.JogForward = true;
        jog(fresh.context);
        const auto c = fresh.calls_of("submit").at(0).command;
        EXPECT_EQ(c.velocity, velocity);
        EXPECT_EQ(c.acceleration, 0);
        EXPECT_EQ(c.deceleration, 0);
        EXPECT_EQ(c.jerk, 0);
    }
}

TEST_F(Jog, ForwardWinsWhenBothArePressedAtOnce) {
    block.JogForward = block.JogBackwards = true;
    scan();
    EXPECT_EQ(submitted().at(0).command.velocity, 10);
}

TEST_F(Jog, TheOtherInputHasNoEffectWhileMoving) {
    block.JogBackwards = true;
    scan();
    block.JogForward = true;
    scan();
    scan();
    EXPECT_EQ(submitted().size(), 1u);
    EXPECT_EQ(renewed().back().value, -10);
}

TEST_F(Jog, RenewsItsLeaseInEachCallWhilePressed) {
    block.JogForward = true;
    for (int i = 0; i < 5; ++i) scan();
    ASSERT_EQ(renewed().size(), 5u);
    for (const auto& call : renewed()) EXPECT_EQ(call.id, submitted().at(0).id);
}

TEST_F(Jog, ContinuousFollowsAChangedVelocity) {
    block.JogForward = true;
    scan();
    block.Velocity = 7;
    scan();
    EXPECT_EQ(renewed().back().value, 7);
    EXPECT_EQ(submitted().size(), 1u);
}

TEST_F(Jog, ReleaseHaltsThenIsDoneForOneCall) {
    block.JogForward = true;
    scan();
    scan();
    const auto renewals = renewed().size();
    block.JogForward = false;
    scan();
    ASSERT_EQ(submitted().size(), 2u);
    EXPECT_EQ(submitted()[1].command.kind, CommandKind::halt);
    EXPECT_EQ(submitted()[1].command.deceleration, 5);
    EXPECT_EQ(submitted()[1].command.jerk, 6);
    EXPECT_TRUE(block.Busy);
    scan();
    EXPECT_TRUE(block.Busy) << "braking";
    EXPECT_EQ(renewed().size(), renewals);

    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    scan();
    EXPECT_FALSE(block.Done);
    EXPECT_FALSE(block.Busy);
    EXPECT_EQ(submitted().size(), 2u);
}

TEST_F(Jog, PressedAgainWhileBrakingStartsAtStandstill) {
    block.JogForward = true;
    scan();
    block.JogForward = false;
    scan();
    block.JogBackwards = true;
    scan();
    EXPECT_EQ(submitted().size(), 2u) << "jog and halt only";
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    scan();
    ASSERT_EQ(submitted().size(), 3u);
    EXPECT_EQ(submitted()[2].command.velocity, -10);
}

TEST_F(Jog, TheSameInputPressedAgainWhileBrakingStartsAtStandstillToo) {
    block.JogForward = true;
    scan();
    block.JogForward = false;
    scan();
    block.JogForward = true;
    scan();
    scan();
    EXPECT_EQ(submitted().size(), 2u) << "jog and halt only";
    axes.finish(Outcome::done);
    scan();
    scan();
    EXPECT_EQ(submitted().size(), 3u);
}

// The release comes in the very scan in which another command has already taken the axis: that one must not be halted.
TEST_F(Jog, DoesNotHaltWhatIsNoLongerItsOwn) {
    block.JogForward = true;
    scan();
    axes.take_over();
    block.JogForward = false;
    scan();
    EXPECT_TRUE(block.CommandAborted);
    EXPECT_EQ(submitted().size(), 1u);
}

TEST_F(Jog, AfterAnAbortBothInputsMustBeReleasedFirst) {
    block.JogForward = true;
    scan();
    axes.take_over();
    scan();
    EXPECT_TRUE(block.CommandAborted);
    block.JogBackwards = true;
    block.JogForward = false;
    scan();
    scan();
    EXPECT_EQ(submitted().size(), 1u);
    EXPECT_TRUE(block.CommandAborted);

    block.JogBackwards = false;
    scan();
    EXPECT_FALSE(block.CommandAborted);
    block.JogBackwards = true;
    scan();
    EXPECT_EQ(submitted().size(), 2u);
}

TEST_F(Jog, ARefusedRenewalIsAnError) {
    block.JogForward = true;
    scan();
    axes.refuse_renewal_with = ErrorId::interlocked;
    scan();
    EXPECT_EQ(block.ErrorID, ErrorId::interlocked);
    EXPECT_FALSE(block.Busy);
    const auto renewals = renewed().size();
    scan();
    EXPECT_EQ(renewed().size(), renewals);
}

TEST_F(Jog, NeedsAVelocity) {
    for (const double velocity : {0.0, -1.0}) {
        MC_Jog jog = block;
        jog.Velocity = velocity;
        jog.JogForward = true;
        jog(axes.context);
        EXPECT_EQ(jog.ErrorID, ErrorId::invalid_velocity);
    }
    EXPECT_TRUE(axes.calls.empty());
}

TEST_F(Jog, InchingMovesTheDistanceOncePerPressAndFinishesWhenReleased) {
    block.Mode = mcJogInching;
    block.Position = 0.5;
    block.JogBackwards = true;
    scan();
    EXPECT_EQ(submitted().at(0).command.kind, CommandKind::move_relative);
    EXPECT_EQ(submitted().at(0).command.position, -0.5);
    EXPECT_EQ(submitted().at(0).command.velocity, 10);
    block.JogBackwards = false;
    scan();
    EXPECT_TRUE(block.Busy);
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);

    scan();
    block.JogForward = true;
    scan();
    axes.finish(Outcome::done);
    scan();
    scan();
    EXPECT_TRUE(block.Done) << "while pressed";
    EXPECT_EQ(submitted().size(), 2u);
    EXPECT_TRUE(renewed().empty());
}

// To multiples of 2.5: by hand calculation.
TEST_F(Jog, ModuloInchingGoesToTheNextMultipleOfPosition) {
    struct Case {
        double from;
        bool forward;
        double distance, modulo;
    };
    for (const auto& c : {Case{1, true, 1.5, 0}, Case{1, false, -1, 0}, Case{2.5, true, 2.5, 0}, Case{2.5, false, -2.5, 0},
                          Case{0, false, -2.5, 0}, Case{-1, true, 1, 0}, Case{-1, false, -1.5, 0},
                          // a hair beside a multiple, as after a move there: on to the next
                          Case{2.5 - 1e-9, true, 2.5 + 1e-9, 0}, Case{2.5 + 1e-9, false, -2.5 - 1e-9, 0},
                          // modulo 9: multiples 0, 2.5, 5, 7.5, then 0 of the next turn
                          Case{8, true, 1, 9}, Case{7.5, true, 1.5, 9}, Case{8, false, -0.5, 9}, Case{0, false, -1.5, 9},
                          // modulo 10: the last multiple is 7.5, not 10
                          Case{7.5, true, 2.5, 10}, Case{0, false, -2.5, 10}}) {
        FakeAxes fresh;
        fresh.axis().set_position = c.from;
        fresh.axis().modulo = c.modulo;
        fresh.next_scan();
        MC_Jog jog = block;
        jog.Mode = mcJogInchingModulo;
        jog.Position = 2.5;
        (c.forward ? jog.JogForward : jog.JogBackwards) = true;
        jog(fresh.context);
        const auto command = fresh.calls_of("submit").at(0).command;
        EXPECT_EQ(command.kind, CommandKind::move_relative);
        EXPECT_EQ(command.velocity, 10);
        EXPECT_NEAR(command.position, c.distance, 1e-12) << c.from << (c.forward ? " forward" : " backwards") << " modulo " << c.modulo;
    }
}

TEST_F(Jog, ModuloInchingFinishesAlsoWhenReleased) {
    block.Mode = mcJogInchingModulo;
    block.Position = 2.5;
    block.JogForward = true;
    scan();
    block.JogForward = false;
    scan();
    EXPECT_TRUE(block.Busy);
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(submitted().size(), 1u);
}

}  // namespace
}  // namespace taktwerk::fb
