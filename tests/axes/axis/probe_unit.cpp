// Touch probes on one axis: latches of the drive, probes in software, windows, and what ends them. 1 u is 1000 counts, a cycle 1 ms.
#include <gtest/gtest.h>

#include "axes/axis/probe_window.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand probe(const TriggerRef& trigger) { return {.kind = CommandKind::touch_probe, .details = ProbeDetails{.trigger = trigger}}; }
AxisCommand probe_within(const TriggerRef& trigger, double first, double last) {
    return {.kind = CommandKind::touch_probe,
            .details = ProbeDetails{.trigger = trigger, .window_only = true, .first = first, .last = last}};
}
AxisCommand abort_of(const TriggerRef& trigger) {
    return {.kind = CommandKind::abort_trigger, .details = ProbeDetails{.trigger = trigger}};
}

ProbeDetails window(double first, double last) { return {.trigger = {}, .window_only = true, .first = first, .last = last}; }

constexpr TriggerRef probe1{.source = TriggerSource::probe1};
constexpr TriggerRef probe2{.source = TriggerSource::probe2};
constexpr TriggerRef index_pulse{.source = TriggerSource::index_pulse};
constexpr TriggerRef home_switch{.source = TriggerSource::home_switch};
constexpr TriggerRef input(std::uint16_t point, std::uint8_t bit = 0) {
    return {.source = TriggerSource::input, .point = point, .bit = bit};
}

/// An axis with two latches whose first signal is on from 12.345 u to 14 u.
struct ProbeRig : Rig {
    explicit ProbeRig(const std::function<void(FakeDrive&)>& more = {})
        : Rig(plain_axis(), [&more](FakeDrive& made) {
              made.caps.probes = 2;
              made.probe_signal[0] = {12345, 14000};
              if (more) more(made);
          }) {
        axis.bind({.inputs = inputs});
        power_on();
    }
    std::array<std::int64_t, 2> inputs{};

    [[nodiscard]] double latched(CommandId id) const {
        for (std::size_t i = 0; i < view().probe_latched.size(); ++i)
            if (view().probe_latched[i] == id) return view().probe_position[i];
        return std::numeric_limits<double>::quiet_NaN();
    }
    [[nodiscard]] CommandId side(SideSlot slot) const { return view().side[static_cast<std::size_t>(slot)]; }
};

// The drive's latch is exact although the axis moves 0.1 u per cycle, and the command is done in the cycle that brings it. P1-249.
TEST(Probe, ALatchGivesThePositionAtTheEdgeNotAtTheSample) {
    ProbeRig rig;
    const auto id = rig.accept(probe(probe1));
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    EXPECT_EQ(rig.side(SideSlot::probe1), id);
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_DOUBLE_EQ(rig.latched(id), 12.345);
    EXPECT_GE(rig.view().actual_position, 12.345);
    EXPECT_LE(rig.view().actual_position, 12.345 + 0.1 + 1e-9) << "shown in the same cycle";
    EXPECT_EQ(rig.side(SideSlot::probe1), 0u);
}

TEST(Probe, TheLatchFollowsTheCoordinatesOfPrograms) {
    ProbeRig rig;
    const auto id = rig.accept(probe(probe1));
    ASSERT_EQ(rig.axis.set(SetPosition{100, false}, Owner::program), ErrorId::none);  // 0 is 100 from now on
    rig.accept(relative(20));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_DOUBLE_EQ(rig.latched(id), 112.345);
}

TEST(Probe, AnInvertedAxisLatchesInItsOwnSense) {
    auto config = plain_axis();
    config.gearing.inverted = true;
    Rig rig(config, [](FakeDrive& drive) {
        drive.caps.probes = 1;
        drive.probe_signal[0] = {-14000, -12345};  // counts: the motor turns backwards
    });
    rig.power_on();
    const auto id = rig.accept(probe(probe1));
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_DOUBLE_EQ(rig.view().probe_position[0], 12.345);
}

TEST(Probe, TheFallingEdgeIsTheOtherEnd) {
    ProbeRig rig;
    const auto id = rig.accept(probe({.source = TriggerSource::probe1, .falling = true}));
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_DOUBLE_EQ(rig.latched(id), 14);
}

// The first event after the command counts, later ones do not. P1-245.
TEST(Probe, OnlyTheFirstEventIsRecorded) {
    ProbeRig rig;
    const auto id = rig.accept(probe(probe1));
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(absolute(0));  // through the signal again, from its other end: 14 u
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.latched(id), 12.345);
}

// An event before the command does not count, even when the drive still shows it. P1-245.
TEST(Probe, ArmingAnewDoesNotTakeTheFormerLatch) {
    ProbeRig rig;
    const auto first = rig.accept(probe(probe1));
    rig.accept(absolute(20));
    CommandId second = 0;
    rig.program = [&] {  // in the cycle that brings the latch: the drive has not been told yet that it is over
        if (second == 0 && rig.status(first) == CommandStatus::done) second = rig.accept(probe(probe1));
    };
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    rig.accept(absolute(0));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(second), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.latched(second), 14);
}

TEST(Probe, AnIndexPulseUsesWhicheverLatchIsFree) {
    ProbeRig rig([](FakeDrive& drive) { drive.index_distance = 10000; });
    const auto busy = rig.accept(probe(probe1));
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    const auto id = rig.accept(probe(index_pulse));
    rig.accept(absolute(11));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.latched(id), 10);
    EXPECT_EQ(rig.status(busy), CommandStatus::active);
}

// --- windows ----------------------------------------------------------------------------------------------------------------

TEST(Probe, AWindowIncludesItsBordersAndOthersWaitOn) {  // P1-246
    struct Case {
        double first, last;
        bool counts;
    };
    for (const auto& c :
         {Case{12.346, 20, false}, Case{12.345, 20, true}, Case{5, 12.345, true}, Case{5, 12.344, false}, Case{12, 13, true}}) {
        ProbeRig rig;
        const auto id = rig.accept(probe_within(probe1, c.first, c.last));
        rig.accept(absolute(13.5));
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        EXPECT_EQ(rig.status(id), c.counts ? CommandStatus::done : CommandStatus::active) << c.first << ".." << c.last;
    }
}

// Figure 40: the first event is outside and is ignored, the probe stays armed, the second is inside.
TEST(Probe, AnEventOutsideTheWindowDoesNotUseUpTheProbe) {  // P1-246, P1-249
    ProbeRig rig;
    const auto id = rig.accept(probe_within(probe1, 13, 15));
    rig.accept(absolute(20));  // rising at 12.345: outside
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    ASSERT_EQ(rig.status(id), CommandStatus::active);
    rig.accept(absolute(10));  // rising again on the way back, at 14
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.latched(id), 14);
}

// Figure 41 on a circle of 360: the accepted arc is from First in positive sense to Last.
TEST(ProbeWindow, OnACircleFirstBeyondLastGoesOverTheZero) {  // P1-250
    struct Case {
        double first, last;
        double arc;
    };
    for (const auto& c : {Case{225, 315, 90}, Case{45, 315, 270}, Case{315, 225, 270}, Case{315, 45, 90}}) {
        int accepted = 0;
        for (int degree = 0; degree < 360; ++degree) accepted += in_window(window(c.first, c.last), degree, 360) ? 1 : 0;
        EXPECT_EQ(accepted, static_cast<int>(c.arc) + 1) << c.first << ".." << c.last << ": both borders count";
        EXPECT_TRUE(in_window(window(c.first, c.last), c.first, 360));
        EXPECT_TRUE(in_window(window(c.first, c.last), c.last, 360));
        EXPECT_FALSE(in_window(window(c.first, c.last), c.first - 0.001, 360));
        EXPECT_FALSE(in_window(window(c.first, c.last), c.last + 0.001, 360));
    }
    EXPECT_TRUE(in_window(window(0, 360), 123, 360)) << "a whole turn is everywhere";
    EXPECT_TRUE(in_window(window(-45, 45), 350, 360)) << "numbers outside the circle mean the place on it";
}

TEST(Probe, AWindowThatHoldsNothingIsRefused) {
    ProbeRig rig;
    EXPECT_EQ(rig.refuse(probe_within(probe1, 5, 4)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(probe_within(probe1, std::numeric_limits<double>::quiet_NaN(), 4)), ErrorId::invalid_position);
}

// --- software probes ----------------------------------------------------------------------------------------------------------

// An input of the machine goes on between two cycles at constant velocity: the position half way between the two samples is given,
// so the error is never more than half the way of a cycle (0.05 u of 0.1 u).
TEST(Probe, AnInputIsRecordedHalfACycleBeforeItIsSeen) {
    ProbeRig rig;
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().active_in_target; }));
    rig.run(5);
    const auto id = rig.accept(probe(input(1, 3)));
    rig.run(5);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    const double before = rig.view().actual_position;
    rig.inputs[1] = 1 << 3;
    rig.step();
    const double after = rig.view().actual_position;
    ASSERT_NEAR(after - before, 0.1, 1e-9);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_NEAR(rig.latched(id), (before + after) / 2, 1e-9);
}

TEST(Probe, AnInputThatIsOnAlreadyMustFallFirst) {  // P1-245
    ProbeRig rig;
    rig.inputs[0] = 1;
    rig.step();
    const auto id = rig.accept(probe(input(0)));
    rig.run(5);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.inputs[0] = 0;
    rig.run(2);
    EXPECT_EQ(rig.status(id), CommandStatus::active) << "the falling edge is not the one that is waited for";
    rig.inputs[0] = 1;
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::done);
}

TEST(Probe, TheHomeSwitchLiesBetweenTheTwoValuesThatSawItChange) {
    ProbeRig rig([](FakeDrive& drive) {
        drive.switches = true;
        drive.home_low = 30000;
        drive.home_high = 40000;
    });
    rig.accept(at_velocity(100));
    const auto id = rig.accept(probe(home_switch));
    double before = 0;
    ASSERT_TRUE(rig.run_until([&] {
        if (rig.status(id) == CommandStatus::done) return true;
        before = rig.view().actual_position;
        return false;
    }));
    EXPECT_LT(before, 30);
    EXPECT_GE(rig.view().actual_position, 30);
    EXPECT_NEAR(rig.latched(id), (before + rig.view().actual_position) / 2, 1e-9);
    EXPECT_NEAR(rig.latched(id), 30, 0.05 + 1e-9);
}

TEST(Probe, TwoProbesRunAtOnce) {  // P1-247
    ProbeRig rig([](FakeDrive& drive) { drive.probe_signal[1] = {15000, 16000}; });
    const auto first = rig.accept(probe(probe1));
    const auto second = rig.accept(probe(probe2));
    EXPECT_EQ(rig.refuse(probe(input(0))), ErrorId::probe_busy) << "two places";
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.latched(first), 12.345);
    EXPECT_DOUBLE_EQ(rig.latched(second), 15);
}

TEST(Probe, ATriggerSomebodyWaitsForIsBusyUnlessTheNewCommandReplacesIt) {  // P1-247
    ProbeRig rig;
    const auto first = rig.accept(probe(probe1));
    EXPECT_EQ(rig.refuse(probe(probe1)), ErrorId::probe_busy);
    EXPECT_EQ(rig.status(first), CommandStatus::active);
    const auto second = rig.accept({.kind = CommandKind::touch_probe, .details = ProbeDetails{.trigger = probe1, .replaces = first}});
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
}

TEST(Probe, WhatThereIsNotIsRefused) {
    ProbeRig rig([](FakeDrive& drive) {
        drive.caps.probes = 1;
        drive.caps.probe_edges = 0b01;  // only the rising edge's position is exchanged
    });
    EXPECT_EQ(rig.refuse(probe(probe2)), ErrorId::no_such_probe);
    EXPECT_EQ(rig.refuse(probe({.source = TriggerSource::probe1, .falling = true})), ErrorId::no_such_probe);
    EXPECT_EQ(rig.refuse(probe(home_switch)), ErrorId::no_such_probe) << "the drive does not report its inputs";
    EXPECT_EQ(rig.refuse(probe(input(2))), ErrorId::invalid_output);
    EXPECT_EQ(rig.refuse(probe(input(0, 64))), ErrorId::invalid_output);
    EXPECT_EQ(rig.refuse(abort_of(probe1)), ErrorId::probe_idle);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::touch_probe}), ErrorId::invalid_parameter);
}

// --- what ends a probe and what does not --------------------------------------------------------------------------------------

TEST(Probe, AbortTriggerEndsIt) {  // P1-248, P1-251
    ProbeRig rig;
    const auto id = rig.accept(probe(probe1));
    rig.run(5);
    const auto abort = rig.accept(abort_of(probe1));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    EXPECT_EQ(rig.status(abort), CommandStatus::done);
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().probe_latched[0], 0u) << "later events are not recorded";
    EXPECT_FALSE(rig.drive.last.probes[0].armed);
}

TEST(Probe, NoMotionAbortsItAndItChangesNoMotion) {  // P1-248
    ProbeRig rig;
    const auto id = rig.accept(probe(input(0)));
    for (const auto& command : {absolute(5), relative(3), at_velocity(20), halt(), stop()}) {
        const auto moving = rig.accept(command);
        rig.run(3);
        EXPECT_EQ(rig.status(id), CommandStatus::active);
        EXPECT_NE(rig.status(moving), CommandStatus::aborted);
    }
    const auto state = rig.view().state;
    rig.inputs[0] = 1;
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, state);
}

TEST(Probe, ItWorksInEveryStateAndLivesThroughAnAxisError) {
    ProbeRig rig;
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    const auto id = rig.accept(probe(input(0)));
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    rig.enable = true;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.drive.fault_code = 0x7305;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop));
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.inputs[0] = 1;
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::done);
}

TEST(Probe, WithoutFeedbackItEndsInError) {
    ProbeRig rig;
    const auto id = rig.accept(probe(probe1));
    rig.drive.offline = true;
    rig.run(10);
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), ErrorId::drive_not_ready);
    EXPECT_EQ(rig.refuse(probe(probe1)), ErrorId::drive_not_ready);
}

}  // namespace
}  // namespace taktwerk::axes::test
