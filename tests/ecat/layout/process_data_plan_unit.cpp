// Expected values are calculated by hand from the layout rule at the top of process_data_plan.hpp and from ETG.1000.4
// (LRW: +2 for outputs, +1 for inputs; datagram overhead 12, frame 1498).
#include "ecat/layout/process_data_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ecat/layout/plan_slaves.hpp"

namespace taktwerk::ecat {
namespace {

using test::servo;
using test::terminal;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(ProcessDataPlan, OneServoGetsItsManagersFmmusAndWorkingCounterThree) {
    const std::vector slaves{servo("x")};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan) << plan.error().text();

    const auto& x = plan->slaves[0];
    ASSERT_THAT(x.sync_managers, SizeIs(2));
    EXPECT_EQ(x.sync_managers[0].number, 2);
    EXPECT_EQ(x.sync_managers[0].registers,
              (SyncManager{.start = 0x1800, .length = 19, .control = 0x64, .status = 0, .activate = 1, .pdi_control = 0}));
    EXPECT_EQ(x.sync_managers[1].registers,
              (SyncManager{.start = 0x1C00, .length = 25, .control = 0x20, .status = 0, .activate = 1, .pdi_control = 0}));
    ASSERT_THAT(x.fmmus, SizeIs(2));
    EXPECT_EQ(x.fmmus[0], (Fmmu{0, 19, 0, 7, 0x1800, 0, false, true, true}));
    EXPECT_EQ(x.fmmus[1], (Fmmu{19, 25, 0, 7, 0x1C00, 0, true, false, true}));

    ASSERT_THAT(plan->datagrams, SizeIs(1));
    EXPECT_EQ(plan->datagrams[0].size(), 44u);
    EXPECT_EQ(plan->datagrams[0].expected_wkc, 3);
    EXPECT_EQ(plan->frames, 1u);
    EXPECT_EQ(plan->output_bytes, 19u);
    EXPECT_EQ(plan->input_bytes, 25u);
}

// 6060h stands after 16+32+32+16 bits; 60B8h at bit 104 = byte 13, 607Fh at byte 15: unaligned.
TEST(ProcessDataPlan, ObjectsBehindByteObjectsHaveUnalignedOffsets) {
    const std::vector slaves{servo("x")};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->slaves[0].mapped_outputs[5], (MappedEntry{0x60B8, 0, 16, 104}));
    EXPECT_EQ(plan->slaves[0].mapped_outputs[6], (MappedEntry{0x607F, 0, 32, 120}));
}

// x and y in one unit, then the terminal alone:
//   datagram 0, logical 0:   out x 0..18, out y 19..37, in x 38..62, in y 63..87    WKC 2 * (2 + 1) = 6
//   datagram 1, logical 88:  out io 88, in io 89..90                               WKC 3
TEST(ProcessDataPlan, ASyncUnitSharesOneDatagramOutputsFirst) {
    std::vector slaves{servo("x"), terminal(), servo("y")};
    slaves[0].sync_unit = slaves[2].sync_unit = "axes";
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan) << plan.error().text();

    ASSERT_THAT(plan->datagrams, SizeIs(2));
    EXPECT_THAT(plan->datagrams[0].slaves, ElementsAre(0, 2));
    EXPECT_EQ(plan->datagrams[0].expected_wkc, 6);
    EXPECT_EQ(plan->datagrams[0].outputs, (ImageRange{0, 38}));
    EXPECT_EQ(plan->datagrams[0].inputs, (ImageRange{0, 50}));
    EXPECT_EQ(plan->slaves[2].fmmus[0].logical_start, 19u);
    EXPECT_EQ(plan->slaves[2].fmmus[1].logical_start, 63u);
    EXPECT_EQ(plan->datagrams[1].logical, 88u);
    EXPECT_EQ(plan->datagrams[1].expected_wkc, 3);
    EXPECT_EQ(plan->slaves[1].outputs, (ImageRange{38, 1}));
    EXPECT_EQ(plan->slaves[1].inputs, (ImageRange{50, 2}));
    EXPECT_EQ(plan->slaves[1].fmmus[1], (Fmmu{89, 2, 0, 7, 0x1000, 0, true, false, true}));
}

TEST(ProcessDataPlan, TerminalBitsFollowEachOther) {
    const std::vector slaves{servo("x"), terminal()};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->slaves[1].mapped_inputs[11], (MappedEntry{0x6000, 12, 1, 25 * 8 + 11}));
    EXPECT_EQ(plan->slaves[1].mapped_outputs[3], (MappedEntry{0x7000, 4, 1, 19 * 8 + 3}));
}

TEST(ProcessDataPlan, InputOnlyAndOutputOnlyTerminalsCountOneAndTwo) {
    auto inputs = terminal(), outputs = terminal();
    inputs.rx.clear();
    inputs.sync_managers.erase(inputs.sync_managers.begin());
    outputs.tx.clear();
    outputs.sync_managers.pop_back();
    const std::vector slaves{inputs, outputs};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->datagrams[0].expected_wkc, 1);
    EXPECT_EQ(plan->datagrams[1].expected_wkc, 2);
}

TEST(ProcessDataPlan, GapsTakeRoomAndHaveNoName) {
    auto slave = servo("x");
    slave.rx = {{0x1600, false, {{0x6040, 0, 16}, {0, 0, 8}, {0x607A, 0, 32}}}};
    const std::vector slaves{slave};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    ASSERT_THAT(plan->slaves[0].mapped_outputs, SizeIs(2));
    EXPECT_EQ(plan->slaves[0].mapped_outputs[1].bit_offset, 24u);
    EXPECT_EQ(plan->output_bytes, 7u);
}

// 12 + 44 = 56 bytes a servo. First frame: 1498 - 20 (clock) - 14 (AL status) = 1464 = 26 * 56 + 8. Others: 1498 = 26 * 56 + 42.
TEST(ProcessDataPlan, FramesAreSplitAtTheEthernetLimit) {
    const auto frames = [](std::size_t servos) {
        const std::vector slaves(servos, servo("s"));
        return plan_process_data(slaves).value().frames;
    };
    EXPECT_EQ(frames(26), 1u);
    EXPECT_EQ(frames(27), 2u);
    EXPECT_EQ(frames(52), 2u);
    EXPECT_EQ(frames(53), 3u);
}

// A datagram has room for 1464 - 12 = 1452 bytes = 33 servos of 44.
TEST(ProcessDataPlan, ASyncUnitTooLargeForAFrameGetsSeveralDatagrams) {
    std::vector<PlanSlave> slaves;
    for (int i = 0; i < 40; ++i) {
        slaves.push_back(servo("s"));
        slaves.back().sync_unit = "all";
    }
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    ASSERT_THAT(plan->datagrams, SizeIs(2));
    EXPECT_THAT(plan->datagrams[0].slaves, SizeIs(33));
    EXPECT_EQ(plan->datagrams[0].expected_wkc, 99);
    EXPECT_EQ(plan->datagrams[1].expected_wkc, 21);
    EXPECT_EQ(plan->frames, 2u);
}

TEST(ProcessDataPlan, ASlaveWithoutProcessDataHasNoDatagram) {
    auto coupler = terminal();
    coupler.rx.clear();
    coupler.tx.clear();
    coupler.sync_managers.clear();
    const std::vector slaves{coupler};
    const auto plan = plan_process_data(slaves);
    ASSERT_TRUE(plan);
    EXPECT_FALSE(plan->slaves[0].unit);
    EXPECT_EQ(plan->frames, 1u);
}

// Three buffers of 19 bytes from 1BE0h reach to 1C18h, into SM3 at 1C00h.
TEST(ProcessDataPlan, OverlappingBuffersAreRefused) {
    auto slave = servo("slave 0 'x'");
    slave.sync_managers[2].start = 0x1BE0;
    const std::vector slaves{slave};
    const auto plan = plan_process_data(slaves);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, "bus.plan.overlap");
    EXPECT_THAT(plan.error().text(), HasSubstr("slave 0 'x'"));
    EXPECT_THAT(plan.error().text(), HasSubstr("SM2 (1BE0h..1C18h"));
}

TEST(ProcessDataPlan, TooFewFmmusAreRefused) {
    auto slave = servo("x");
    slave.fmmus = 1;
    EXPECT_EQ(plan_process_data(std::vector{slave}).error().code, "bus.plan.too_many_fmmus");
}

TEST(ProcessDataPlan, TerminalPdosThatDoNotFitTheirManagerAreRefused) {
    auto slave = terminal();
    slave.sync_managers[1].size = 1;  // 12 inputs need two
    EXPECT_EQ(plan_process_data(std::vector{slave}).error().code, "bus.plan.no_sync_manager");
}

}  // namespace
}  // namespace taktwerk::ecat
