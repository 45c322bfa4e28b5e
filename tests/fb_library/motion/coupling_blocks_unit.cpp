// Gears, cams, phasing, combined axes: what the blocks ask of the slave and make of its view.
#include "tests/fb_library/motion/one_block.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandKind;
using axes::Outcome;

using GearIn = OneBlock<MC_GearIn>;
TEST_F(GearIn, CommandsTheSlaveWhatThePinsSay) {
    block.Master = {1}, block.Slave = {2};
    block.RatioNumerator = -3, block.RatioDenominator = 2;
    block.MasterValueSource = mcActualValue;
    block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.BufferMode = mcBuffered;
    block.Execute = true;
    scan();
    EXPECT_EQ(last().axis.index, 2);
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::gear_in);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
    EXPECT_EQ(details<axes::GearDetails>(), (axes::GearDetails{{1}, {-3, 2}, mcActualValue}));
}

TEST_F(GearIn, IsOneToOneUnlessSaid) {
    block.Slave = {0};
    block.Execute = true;
    scan();
    EXPECT_EQ(details<axes::GearDetails>().ratio, (axes::GearRatio{1, 1}));
    EXPECT_EQ(details<axes::GearDetails>().source, mcSetValue);
}

// The axis knows 31 bits; what does not fit must not become a negative ratio.
TEST_F(GearIn, ADenominatorThatDoesNotFitBecomesZeroWhichTheAxisRefuses) {
    block.Slave = {0};
    block.RatioDenominator = 0x8000'0000u;
    block.Execute = true;
    scan();
    EXPECT_EQ(details<axes::GearDetails>().ratio.denominator, 0);
}

using GearOut = OneBlock<MC_GearOut>;
TEST_F(GearOut, ReleasesTheSlave) {
    block.Slave = {2};
    begin();
    EXPECT_EQ(axes.calls.at(0).axis.index, 2);
    EXPECT_EQ(axes.calls.at(0).command.kind, CommandKind::gear_out);
    axes.finish(Outcome::done, ErrorId::none, 2);
    scan();
    EXPECT_TRUE(block.Done);
}

using CamOut = OneBlock<MC_CamOut>;
TEST_F(CamOut, ReleasesTheSlave) {
    block.Slave = {2};
    block.Execute = true;
    scan();
    EXPECT_EQ(last().axis.index, 2);
    EXPECT_EQ(last().command.kind, CommandKind::cam_out);
}

using GearInPos = OneBlock<MC_GearInPos>;
TEST_F(GearInPos, CommandsTheSlaveWhatThePinsSay) {
    block.Master = {1}, block.Slave = {2};
    block.RatioNumerator = 3, block.RatioDenominator = 2;
    block.MasterValueSource = mcActualValue;
    block.MasterSyncPosition = 10, block.SlaveSyncPosition = 11, block.MasterStartDistance = 12;
    block.SyncMode = mcSlowDown;
    block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Execute = true;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::gear_in_pos);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    const auto& d = details<axes::GearInPosDetails>();
    EXPECT_EQ(d.master.index, 1);
    EXPECT_EQ(d.ratio, (axes::GearRatio{3, 2}));
    EXPECT_EQ(d.source, mcActualValue);
    EXPECT_EQ(d.mode, mcSlowDown);
    EXPECT_EQ(d.master_sync_position, 10);
    EXPECT_EQ(d.slave_sync_position, 11);
    EXPECT_EQ(d.master_start_distance, 12);
}

// Figure 44: StartSync from the start distance to the sync position, InSync from there on.
TEST_F(GearInPos, StartSyncHoldsFromTheStartOfTheWayUntilInSync) {  // P1-285
    block.Slave = {0};
    begin();
    EXPECT_FALSE(block.StartSync);
    axes.axis().sync_started = true;
    scan();
    EXPECT_TRUE(block.StartSync);
    EXPECT_FALSE(block.InSync);
    axes.axis().active_in_target = true;
    scan();
    EXPECT_FALSE(block.StartSync);
    EXPECT_TRUE(block.InSync);
    axes.axis().active_in_target = false;
    axes.take_over();  // another's StartSync is not this block's
    scan();
    EXPECT_FALSE(block.StartSync);
}

using CamTableSelect = OneBlock<MC_CamTableSelect>;
TEST_F(CamTableSelect, PreparesThroughTheSlaveAndGivesTheId) {
    block.Master = {1}, block.Slave = {2};
    block.CamTable = {7};
    block.Periodic = true, block.SlaveAbsolute = true;
    block.Execute = true;
    scan();
    EXPECT_EQ(last().what, "set");
    EXPECT_EQ(last().axis.index, 2);
    EXPECT_EQ(last().setting, axes::AxisSetting(axes::SelectCam{{7}, true, false, true}));
    EXPECT_TRUE(block.Busy);
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(block.CamTableID, axes.axis(2).selected_cam);
    EXPECT_EQ(axes.calls.size(), 1u);
}

TEST_F(CamTableSelect, ThroughTheMasterWhenThereIsNoSlave) {
    block.Master = {1};
    block.Execute = true;
    scan();
    EXPECT_EQ(last().axis.index, 1);
}

// The axis shows its last selection only: whoever was overtaken must not take the other's cam.
TEST_F(CamTableSelect, TwoInOneScanGetEachItsOwnCam) {
    MC_CamTableSelect other;
    block.Slave = other.Slave = {0};
    block.CamTable = {1}, other.CamTable = {2};
    block.Execute = other.Execute = true;
    CamId first, second;
    for (int i = 0; i < 4; ++i) {
        axes.next_scan();
        block(axes.context);
        if (block.Done && first == CamId{}) first = axes.axis().selected_as.source == CamRef{1} ? block.CamTableID : CamId{99};
        other(axes.context);
        if (other.Done && second == CamId{}) second = other.CamTableID;
    }
    EXPECT_TRUE(block.Done);
    EXPECT_TRUE(other.Done);
    EXPECT_NE(block.CamTableID, CamId{});
    EXPECT_NE(other.CamTableID, CamId{});
    EXPECT_NE(block.CamTableID, other.CamTableID);
    EXPECT_EQ(first, block.CamTableID) << "taken while the axis showed this block's cam";
}

TEST_F(CamTableSelect, InputsCountAtTheEdge) {
    block.Slave = {0};
    block.CamTable = {1};
    block.Execute = true;
    scan();
    block.CamTable = {2};
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(axes.axis().selected_as.source, CamRef{1});
}

using CamIn = OneBlock<MC_CamIn>;
TEST_F(CamIn, CommandsTheSlaveWhatThePinsSay) {
    block.Master = {1}, block.Slave = {2};
    block.MasterOffset = 1, block.SlaveOffset = 2, block.MasterScaling = 3, block.SlaveScaling = 4;
    block.MasterStartDistance = 5, block.MasterSyncPosition = 6;
    block.StartMode = mcRampIn;
    block.MasterValueSource = mcActualValue;
    block.CamTableID = {77};
    block.Execute = true;
    scan();
    EXPECT_EQ(last().command.kind, CommandKind::cam_in);
    const auto& d = details<axes::CamDetails>();
    EXPECT_EQ(d.master.index, 1);
    EXPECT_EQ(d.table, (CamId{77}));
    EXPECT_EQ(d.start, mcRampIn);
    EXPECT_EQ(d.source, mcActualValue);
    EXPECT_EQ(d.master_offset, 1);
    EXPECT_EQ(d.slave_offset, 2);
    EXPECT_EQ(d.master_scaling, 3);
    EXPECT_EQ(d.slave_scaling, 4);
    EXPECT_EQ(d.master_start_distance, 5);
    EXPECT_EQ(d.master_sync_position, 6);
}

TEST_F(CamIn, ScalingsAreOneUnlessSaid) {  // P1-265
    block.Slave = {0};
    block.Execute = true;
    scan();
    EXPECT_EQ(details<axes::CamDetails>().master_scaling, 1);
    EXPECT_EQ(details<axes::CamDetails>().slave_scaling, 1);
}

TEST_F(CamIn, EndOfProfileIsAPulseOfOneCallAtEachEnd) {  // P1-268
    axes.axis().cam_ends = 40;                           // of earlier cams
    block.Slave = {0};
    begin();
    EXPECT_FALSE(block.EndOfProfile);
    for (int period = 0; period < 3; ++period) {
        axes.axis().cam_ends += 1;
        scan();
        EXPECT_TRUE(block.EndOfProfile);
        scan();
        EXPECT_FALSE(block.EndOfProfile);
    }
}

// Chained cams: the end of the first is what starts the second, which must not take it for its own.
TEST_F(CamIn, TheEndThatStartsABufferedCamIsNotItsOwn) {
    axes.take_over();  // the cam before
    block.Slave = {0};
    block.BufferMode = mcBuffered;
    begin();
    axes.axis().cam_ends += 1;
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Active);
    EXPECT_FALSE(block.EndOfProfile);
    axes.axis().cam_ends += 1;
    scan();
    EXPECT_TRUE(block.EndOfProfile);
}

TEST_F(CamIn, AnAbortedCamHasNoEnd) {  // P1-078
    block.Slave = {0};
    begin();
    axes.axis().cam_ends += 1;
    axes.take_over();
    scan();
    EXPECT_TRUE(block.CommandAborted);
    EXPECT_FALSE(block.EndOfProfile);
}

using PhasingAbsolute = OneBlock<MC_PhasingAbsolute>;
TEST_F(PhasingAbsolute, CommandsTheSlaveAndShowsTheShiftWhileActive) {  // P1-295
    block.Master = {1}, block.Slave = {2};
    block.PhaseShift = 10, block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    begin();
    const auto& c = axes.calls.at(0).command;
    EXPECT_EQ(axes.calls.at(0).axis.index, 2);
    EXPECT_EQ(c.kind, CommandKind::phasing_absolute);
    EXPECT_EQ(c.position, 10);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);

    axes.axis(2).phase_shift = 4.5;
    scan();
    EXPECT_TRUE(block.Active);
    EXPECT_EQ(block.AbsolutePhaseShift, 4.5);
    axes.axis(2).phase_shift = 10;
    axes.finish(Outcome::done, ErrorId::none, 2);
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(block.AbsolutePhaseShift, 10);
}

using PhasingRelative = OneBlock<MC_PhasingRelative>;
TEST_F(PhasingRelative, ShowsWhatItHasCoveredNotWhatAnotherOneDoes) {  // P1-295
    block.Slave = {0};
    block.PhaseShift = 10;
    begin();
    EXPECT_EQ(axes.calls.at(0).command.kind, CommandKind::phasing_relative);
    axes.axis().phase_covered = 6;
    scan();
    EXPECT_EQ(block.CoveredPhaseShift, 6);
    axes.take_over();  // another phasing
    axes.axis().phase_covered = 0.25;
    scan();
    EXPECT_TRUE(block.CommandAborted);
    EXPECT_EQ(block.CoveredPhaseShift, 6);
}

using HaltPhasing = OneBlock<MC_HaltPhasing>;
TEST_F(HaltPhasing, EndsThePhasingOfTheSlave) {
    MC_PhasingRelative running;
    running.Slave = block.Slave = {2};
    running.Execute = true;
    running(axes.context);
    block.Deceleration = 5, block.Jerk = 6;
    begin();
    running(axes.context);
    EXPECT_TRUE(running.CommandAborted);
    EXPECT_EQ(last().axis.index, 2);
    EXPECT_EQ(last().command.kind, CommandKind::halt_phasing);
    EXPECT_EQ(last().command.deceleration, 5);
    EXPECT_EQ(last().command.jerk, 6);
    axes.finish(Outcome::done, ErrorId::none, 2);
    scan();
    EXPECT_TRUE(block.Done);
}

using CombineAxes = OneBlock<MC_CombineAxes>;
TEST_F(CombineAxes, CommandsTheSlaveWhatThePinsSay) {
    block.Master1 = {0}, block.Master2 = {1}, block.Slave = {2};
    block.CombineMode = mcSubAxes;
    block.GearRatioNumeratorM1 = 1, block.GearRatioDenominatorM1 = 2, block.GearRatioNumeratorM2 = -3, block.GearRatioDenominatorM2 = 4;
    block.MasterValueSourceM1 = mcActualValue;
    block.Execute = true;
    scan();
    EXPECT_EQ(last().axis.index, 2);
    EXPECT_EQ(last().command.kind, CommandKind::combine);
    EXPECT_EQ(details<axes::CombineDetails>(), (axes::CombineDetails{{0}, {1}, {1, 2}, {-3, 4}, mcActualValue, mcSetValue, mcSubAxes}));
}

}  // namespace
}  // namespace taktwerk::fb
