// Layouts drawn by hand from the rules at the top of process_data_plan.hpp; working counters from ETG.1000.4 (LRW: +2 written,
// +1 read; LWR, LRD: +1); a datagram carries 1486 bytes, the first frame 1498 - 20 (clock) - 14 (AL status) = 1464.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/layout/frame_schedule.hpp"
#include "ecat/layout/process_data_plan.hpp"
#include "tests/ecat/layout/plan_slaves.hpp"

namespace taktwerk::ecat {
namespace {

using test::servo;
using test::terminal;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

ProcessDataPlan planned(const std::vector<PlanSlave>& slaves, const std::vector<SyncUnitConfig>& units = {}) {
    auto plan = plan_process_data(slaves, units);
    EXPECT_TRUE(plan) << plan.error().text();
    return plan ? *plan : ProcessDataPlan{};
}

/// A slave with as many bytes of outputs and inputs, in PDOs of 64-bit objects and one of the rest.
PlanSlave block(std::uint16_t outputs, std::uint16_t inputs) {
    PlanSlave slave;
    slave.subject = "block";
    slave.coe = false;
    slave.sync_managers = {{SmUse::outputs, 0x1000, outputs, 0x64}, {SmUse::inputs, 0x5000, inputs, 0x20}};
    return slave;
}

/// PDO of `bytes` U8 objects for one sync manager.
PdoDescription pdo(std::uint16_t index, std::uint8_t bytes, std::optional<std::uint8_t> sync_manager) {
    PdoDescription result{index, true, {}, sync_manager};
    for (std::uint8_t i = 1; i <= bytes; ++i) result.entries.push_back({static_cast<std::uint16_t>(index + 0x1000), i, 8});
    return result;
}

//   logical   0..18 out x   19..37 out y   38..62 in x   63..87 in y
//   datagrams LWR 0, 38 bytes, WKC 2       LRD 38, 50 bytes, WKC 2
TEST(PlanLayout, AUnitWithASlaveThatCannotLrwGetsLwrAndLrd) {
    std::vector slaves{servo("x"), servo("y")};
    slaves[0].sync_unit = slaves[1].sync_unit = "axes";
    slaves[1].lrw = false;
    const auto plan = planned(slaves);

    ASSERT_THAT(plan.datagrams, SizeIs(2));
    EXPECT_EQ(plan.datagrams[0].command, Command::LWR);
    EXPECT_EQ(plan.datagrams[0].logical, 0u);
    EXPECT_EQ(plan.datagrams[0].size(), 38u);
    EXPECT_EQ(plan.datagrams[0].expected_wkc, 2);
    EXPECT_EQ(plan.datagrams[1].command, Command::LRD);
    EXPECT_EQ(plan.datagrams[1].logical, 38u);
    EXPECT_EQ(plan.datagrams[1].size(), 50u);
    EXPECT_EQ(plan.datagrams[1].outputs.size, 0u);
    EXPECT_EQ(plan.datagrams[1].inputs, (ImageRange{0, 50}));
    EXPECT_EQ(plan.datagrams[1].expected_wkc, 2);
    EXPECT_THAT(plan.units, SizeIs(1));
}

// A unit of its own: the neighbour keeps its LRW.
TEST(PlanLayout, ASlaveWithoutLrwTakesLrwFromNobodyElse) {
    std::vector slaves{servo("x"), servo("y")};
    slaves[0].lrw = false;
    const auto plan = planned(slaves);
    ASSERT_THAT(plan.datagrams, SizeIs(3));
    EXPECT_EQ(plan.datagrams[0].command, Command::LWR);
    EXPECT_EQ(plan.datagrams[1].command, Command::LRD);
    EXPECT_EQ(plan.datagrams[2].command, Command::LRW);
    EXPECT_EQ(plan.datagrams[2].expected_wkc, 3);
}

//   outputs   SM2 1800h: 1600h 4 bytes     SM4 2000h: 1610h 6 bytes
//   inputs    SM3 1C00h: 1A00h 2 bytes, 1A01h 1 byte      SM5 2400h: 1A10h 5 bytes
//   logical   0..3 SM2   4..9 SM4   10..12 SM3   13..17 SM5;  WKC counts slaves, not sync managers: 2 + 1
TEST(PlanLayout, SeveralSyncManagersPerDirectionHaveAnFmmuEach) {
    auto slave = servo("x");
    slave.sync_managers.push_back({SmUse::outputs, 0x2000, 0, 0x64});
    slave.sync_managers.push_back({SmUse::inputs, 0x2400, 0, 0x20});
    slave.rx = {pdo(0x1610, 6, std::uint8_t{4}), pdo(0x1600, 4, std::nullopt)};
    slave.tx = {pdo(0x1A00, 2, std::nullopt), pdo(0x1A10, 5, std::uint8_t{5}), pdo(0x1A01, 1, std::uint8_t{3})};
    const auto plan = planned({slave});

    const auto& x = plan.slaves[0];
    ASSERT_THAT(x.sync_managers, SizeIs(4));
    EXPECT_EQ(x.sync_managers[0].number, 2);
    EXPECT_EQ(x.sync_managers[0].registers.length, 4);
    EXPECT_EQ(x.sync_managers[1].number, 4);
    EXPECT_EQ(x.sync_managers[1].registers.length, 6);
    EXPECT_EQ(x.sync_managers[2].number, 3);
    EXPECT_EQ(x.sync_managers[2].registers.length, 3);
    EXPECT_EQ(x.sync_managers[3].number, 5);
    EXPECT_EQ(x.sync_managers[3].registers.length, 5);
    EXPECT_THAT(x.fmmus, ElementsAre(Fmmu{0, 4, 0, 7, 0x1800, 0, false, true, true}, Fmmu{4, 6, 0, 7, 0x2000, 0, false, true, true},
                                     Fmmu{10, 3, 0, 7, 0x1C00, 0, true, false, true}, Fmmu{13, 5, 0, 7, 0x2400, 0, true, false, true}));
    ASSERT_THAT(plan.datagrams, SizeIs(1));
    EXPECT_EQ(plan.datagrams[0].expected_wkc, 3);
    // 1A01h:01 stands behind the two bytes of 1A00h, in SM3, although it is assigned after 1A10h.
    EXPECT_EQ(x.mapped_inputs[2], (MappedEntry{0x2A01, 1, 8, 16}));
    EXPECT_EQ(x.mapped_inputs[3], (MappedEntry{0x2A10, 1, 8, 24}));
}

TEST(PlanLayout, APdoForASyncManagerOfTheOtherDirectionIsRefused) {
    auto slave = servo("slave 0 'x'");
    slave.rx = {pdo(0x1600, 4, std::uint8_t{3})};
    const auto plan = plan_process_data(std::vector{slave});
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, "bus.plan.no_sync_manager");
    EXPECT_THAT(plan.error().text(), HasSubstr("1600h"));
}

// Digital outputs at 0F00h and 0F01h, a byte each, as terminals with two output managers have them: one FMMU of two bytes.
TEST(PlanLayout, AdjacentSyncManagersShareAnFmmu) {
    auto slave = terminal();
    slave.sync_managers = {{SmUse::outputs, 0x0F00, 1, 0x44}, {SmUse::outputs, 0x0F01, 1, 0x44}};
    slave.tx.clear();
    slave.fmmus = 1;
    const auto plan = planned({slave});
    EXPECT_THAT(plan.slaves[0].sync_managers, SizeIs(2));
    EXPECT_THAT(plan.slaves[0].fmmus, ElementsAre(Fmmu{0, 2, 0, 7, 0x0F00, 0, false, true, true}));
}

//   outputs 2000, inputs 1500:   | out 0..1999 | in 2000..3499 |
//   LRW 0..1485 (out, WKC 2)   LRW 1486..2971 (514 out, 972 in, WKC 3)   LRW 2972..3499 (528 in, WKC 1)
TEST(PlanLayout, ASlaveLargerThanAFrameIsCutIntoWindowsThatStayInOrder) {
    const auto plan = planned({block(2000, 1500)});
    ASSERT_THAT(plan.datagrams, SizeIs(3));
    EXPECT_EQ(plan.datagrams[0].outputs, (ImageRange{0, 1486}));
    EXPECT_EQ(plan.datagrams[0].inputs.size, 0u);
    EXPECT_EQ(plan.datagrams[0].expected_wkc, 2);
    EXPECT_EQ(plan.datagrams[1].logical, 1486u);
    EXPECT_EQ(plan.datagrams[1].outputs, (ImageRange{1486, 514}));
    EXPECT_EQ(plan.datagrams[1].inputs, (ImageRange{0, 972}));
    EXPECT_EQ(plan.datagrams[1].expected_wkc, 3);
    EXPECT_EQ(plan.datagrams[2].inputs, (ImageRange{972, 528}));
    EXPECT_EQ(plan.datagrams[2].expected_wkc, 1);
    EXPECT_FALSE(plan.datagrams[0].continues);
    EXPECT_TRUE(plan.datagrams[1].continues && plan.datagrams[2].continues);
    // 1486 does not fit the first frame (1452 free): frames 1, 2, 3; the last piece must not go to the first one.
    FramePacker packer{plan.mailbox};
    EXPECT_EQ(packer.place(1486), 1u);
    EXPECT_EQ(packer.place(1486, 1), 2u);
    EXPECT_EQ(packer.place(528, 2), 3u);
    EXPECT_EQ(plan.frames, 4u);
}

// The first free place: 1400 and 200 need two frames, the third datagram of 40 still goes into the first.
TEST(PlanLayout, SmallDatagramsFillTheRoomThatLargeOnesLeft) {
    FramePacker packer{MailboxStatusPlan{}};
    EXPECT_EQ(packer.place(1400), 0u);  // 1464 - 1412 = 52 left
    EXPECT_EQ(packer.place(200), 1u);
    EXPECT_EQ(packer.place(40), 0u);
    EXPECT_EQ(packer.place(1), 1u);
    EXPECT_EQ(packer.frames(), 2u);
}

TEST(PlanLayout, MoreFramesThanTheExchangeHasSlotsForAreRefused) {
    // 1486 bytes are a frame each: 27 behind the first.
    EXPECT_EQ(plan_process_data(std::vector(27, block(743, 743))).value().frames, 28u);
    EXPECT_EQ(plan_process_data(std::vector(28, block(743, 743))).error().code, "bus.plan.too_many_frames");
}

//   4 units of 12 + 44 bytes every 4 cycles: one in each cycle.   Cycle: 0 a   1 b   2 c   3 d   4 a ...
TEST(PlanLayout, SlowUnitsAreSpreadOverTheCycles) {
    std::vector slaves{servo("a"), servo("b"), servo("c"), servo("d"), servo("fast")};
    for (std::size_t i = 0; i < 4; ++i) slaves[i].sync_unit = slaves[i].subject;
    const auto plan = planned(slaves, {{"a", 4}, {"b", 4}, {"c", 4}, {"d", 4}});

    ASSERT_THAT(plan.units, SizeIs(5));
    for (std::uint64_t cycle = 0; cycle < 8; ++cycle) {
        int due = 0;
        for (std::size_t u = 0; u < 4; ++u) due += plan.units[u].due(cycle) ? 1 : 0;
        EXPECT_EQ(due, 1) << "cycle " << cycle;
        EXPECT_TRUE(plan.units[4].due(cycle));
    }
    EXPECT_EQ(planned(slaves, {{"a", 4}, {"b", 4}, {"c", 4}, {"d", 4}}).units[2].phase, plan.units[2].phase) << "always the same";
}

// 30 slow servos of 44 bytes need 1680 bytes at once (two frames); spread over 10 cycles three a cycle fit the first frame.
TEST(PlanLayout, SlowUnitsNeedNoFrameOfTheirOwnWhileTheFirstHasRoom) {
    std::vector<PlanSlave> slaves;
    std::vector<SyncUnitConfig> units;
    for (int i = 0; i < 30; ++i) {
        slaves.push_back(servo("s"));
        slaves.back().sync_unit = "u" + std::to_string(i);
        units.push_back({slaves.back().sync_unit, 10});
    }
    const auto plan = planned(slaves, units);
    EXPECT_EQ(plan.frames, 2u);
    for (std::uint64_t cycle = 0; cycle < 10; ++cycle) EXPECT_EQ(frames_in_cycle(plan, cycle), 1u);
}

//   process data 0..43 (x), 44..87 (y), gap of 4, then   92: bit 0 = x, bit 1 = y   93: z, a byte of its own (bit 3 of it)
//   SM1's status register: 0800h + 8 + 5 = 080Dh, "full" is bit 3.
TEST(PlanLayout, FullMailboxesAreOneBitPerSlave) {
    std::vector slaves{servo("x"), servo("y"), servo("z")};
    for (auto& slave : slaves) slave.mailbox_in = 1;
    slaves[2].bitwise_fmmu = false;
    slaves[2].rx.clear();
    slaves[2].tx.clear();
    const auto plan = planned(slaves);

    EXPECT_EQ(plan.mailbox.logical, 92u);
    EXPECT_EQ(plan.mailbox.size, 2);
    EXPECT_EQ(plan.mailbox.expected_wkc, 3);
    EXPECT_EQ(plan.slaves[0].mailbox_bit, 0u);
    EXPECT_EQ(plan.slaves[1].mailbox_bit, 1u);
    EXPECT_EQ(plan.slaves[2].mailbox_bit, 11u);
    EXPECT_EQ(plan.slaves[1].fmmus[2], (Fmmu{92, 1, 1, 1, 0x080D, 3, true, false, true}));
    EXPECT_EQ(plan.slaves[2].fmmus[0], (Fmmu{93, 1, 0, 7, 0x080D, 0, true, false, true}));
}

TEST(PlanLayout, WithoutASpareFmmuTheMailboxIsNotMapped) {
    auto slave = servo("x");
    slave.mailbox_in = 1;
    slave.fmmus = 2;
    const auto plan = planned({slave});
    EXPECT_FALSE(plan.slaves[0].mailbox_bit);
    EXPECT_EQ(plan.mailbox.size, 0);
    EXPECT_THAT(plan.slaves[0].fmmus, SizeIs(2));
}

}  // namespace
}  // namespace taktwerk::ecat
