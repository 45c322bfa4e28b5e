// MC_TouchProbe and MC_AbortTrigger on an axis whose drive latches. One u is 1000 counts, a scan 1 ms.
#include <gtest/gtest.h>

#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/probes.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

struct ProbePlc : Plc {
    ProbePlc() {
        drive.caps.probes = 2;
        drive.probe_signal[0] = {5123, 6000};
        probe.Axis = abort.Axis = other.Axis = move.Axis = x;
        move.Velocity = 100;
        move.Acceleration = 10000;
        program = [this](const MotionContext& ctx) {
            move(ctx);
            probe(ctx);
            other(ctx);
            abort(ctx);
        };
        scan();
    }
    void go_to(double position) {
        move.Execute = false;
        scan();
        move.Position = position;
        move.Execute = true;
        ASSERT_LE(run_until([&] { return move.Done; }, 10s), 10s);
        run_for(5ms);
    }
    MC_TouchProbe probe{}, other{};
    MC_AbortTrigger abort{};
    MC_MoveAbsolute move{};
};

// Figure 40. P1-245, P1-248, P1-249
TEST(TouchProbe, RecordsThePlaceOfTheEdge) {
    ProbePlc plc;
    plc.probe.Execute = true;
    plc.run_for(10ms);
    EXPECT_TRUE(plc.probe.Busy);
    plc.go_to(10);
    EXPECT_TRUE(plc.probe.Done);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123);
    EXPECT_FALSE(plc.move.CommandAborted);
    plc.go_to(0);  // and through the signal again
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123) << "single shot";
    plc.probe.Execute = false;
    plc.scan();
    EXPECT_FALSE(plc.probe.Done);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123) << "kept until the next start";
}

TEST(TouchProbe, IgnoresWhatIsOutsideTheWindow) {  // P1-246
    ProbePlc plc;
    plc.probe.WindowOnly = true;
    plc.probe.FirstPosition = 5.5;
    plc.probe.LastPosition = 7;
    plc.probe.Execute = true;
    plc.run_for(10ms);
    plc.go_to(10);  // at 5.123
    EXPECT_TRUE(plc.probe.Busy);
    EXPECT_EQ(plc.probe.RecordedPosition, 0);
    plc.go_to(0);  // backwards at 6
    EXPECT_TRUE(plc.probe.Done);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 6);
}

TEST(TouchProbe, EndedByAbortTrigger) {  // P1-248, P1-251
    ProbePlc plc;
    plc.probe.Execute = true;
    plc.run_for(10ms);
    plc.abort.Execute = true;
    plc.run_for(2ms);
    EXPECT_TRUE(plc.probe.CommandAborted);
    EXPECT_TRUE(plc.abort.Done);
    plc.go_to(10);
    EXPECT_FALSE(plc.probe.Done);
    EXPECT_EQ(plc.probe.RecordedPosition, 0);
    plc.abort.Execute = false;
    plc.scan();
    plc.abort.Execute = true;
    plc.scan();
    EXPECT_EQ(plc.abort.ErrorID, ErrorId::probe_idle);
}

TEST(TouchProbe, ASecondInstanceOnTheSameTriggerIsRefusedOnAnotherItRuns) {  // P1-247
    ProbePlc plc;
    plc.drive.probe_signal[1] = {7000, 8000};
    plc.probe.Execute = true;
    plc.scan();
    plc.other.Execute = true;
    plc.scan();
    EXPECT_EQ(plc.other.ErrorID, ErrorId::probe_busy);
    EXPECT_TRUE(plc.probe.Busy);
    plc.other.Execute = false;
    plc.scan();
    plc.other.TriggerInput.source = axes::TriggerSource::probe2;
    plc.other.Execute = true;
    plc.run_for(10ms);
    plc.go_to(10);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123);
    EXPECT_DOUBLE_EQ(plc.other.RecordedPosition, 7);
}

// The same instance, triggered anew while it waits: the event after the second edge counts. P1-064, P1-245
TEST(TouchProbe, ANewEdgeBeginsAnew) {
    ProbePlc plc;
    plc.probe.WindowOnly = true;
    plc.probe.FirstPosition = plc.probe.LastPosition = 100;
    plc.probe.Execute = true;
    plc.run_for(10ms);
    plc.probe.Execute = false;
    plc.scan();
    plc.probe.WindowOnly = false;
    plc.probe.Execute = true;
    plc.run_for(10ms);
    EXPECT_TRUE(plc.probe.Busy);
    EXPECT_FALSE(plc.probe.CommandAborted);
    plc.go_to(10);
    EXPECT_TRUE(plc.probe.Done);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123);
}

TEST(TouchProbe, WorksWhileTheAxisIsDisabled) {
    ProbePlc plc;
    plc.power.Enable = false;
    plc.run_for(50ms);
    ASSERT_EQ(plc.state(), axes::AxisState::Disabled);
    plc.probe.Execute = true;
    plc.run_for(10ms);
    EXPECT_TRUE(plc.probe.Busy);
    plc.drive.coasting = 100;  // somebody turns the shaft
    plc.run_for(60ms);
    EXPECT_TRUE(plc.probe.Done);
    EXPECT_DOUBLE_EQ(plc.probe.RecordedPosition, 5.123);
    EXPECT_EQ(plc.state(), axes::AxisState::Disabled);
}

}  // namespace
}  // namespace taktwerk::fb
