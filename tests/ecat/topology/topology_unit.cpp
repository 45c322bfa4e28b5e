// Trees drawn by hand, the DL status words that such slaves report, and the tree that must come out.

#include "ecat/topology/topology.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>

namespace taktwerk::ecat {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// 0110h with these ports open (signal), the loops of the others closed. ETG.1000.4: bit 8+2p loop, bit 9+2p signal.
std::uint16_t ports(std::initializer_list<unsigned> open) {
    std::uint16_t status = 0x5500;
    for (const unsigned p : open)
        status = static_cast<std::uint16_t>((status & ~(1u << (8 + 2 * p))) | (1u << (9 + 2 * p)) | (1u << (4 + p)));
    return status;
}

// master -- A -- B -- C
TEST(Topology, Line) {
    const auto tree = build_topology(std::vector{ports({0, 1}), ports({0, 1}), ports({0})});
    ASSERT_TRUE(tree);
    EXPECT_FALSE(tree->slaves[0].parent);
    EXPECT_EQ(tree->slaves[1].parent, 0u);
    EXPECT_EQ(tree->slaves[2].parent, 1u);
    EXPECT_EQ(tree->slaves[2].parent_port, 1u);
    EXPECT_EQ(tree->slaves[2].depth, 2u);
    EXPECT_THAT(tree->behind(1), ElementsAre(1, 2));
}

// A coupler with terminals on port 1 and a drive on port 3: the frame takes port 3 first (order 0-3-1-2).
//   master -- 0[coupler]1 -- T1 -- T2
//                3 -- drive
TEST(Topology, BranchesAreTakenInProcessingOrder) {
    const auto tree = build_topology(std::vector{ports({0, 1, 3}), ports({0}), ports({0, 1}), ports({0})});
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->slaves[1].parent_port, 3u);
    EXPECT_EQ(tree->slaves[2].parent_port, 1u);
    EXPECT_EQ(tree->slaves[3].parent, 2u);
    EXPECT_EQ(tree->slaves[0].child[3], 1u);
    EXPECT_EQ(tree->slaves[0].child[1], 2u);
    EXPECT_THAT(tree->behind(2), ElementsAre(2, 3));
    EXPECT_THAT(tree->behind(1), ElementsAre(1));
}

// A star junction with three branches, one of them with a branch of its own.
TEST(Topology, NestedBranches) {
    const auto tree = build_topology(std::vector{ports({0, 1, 2, 3}), ports({0, 3, 1}), ports({0}), ports({0}), ports({0}), ports({0})});
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->slaves[1].parent_port, 3u);
    EXPECT_EQ(tree->slaves[2].parent, 1u);
    EXPECT_EQ(tree->slaves[2].parent_port, 3u);
    EXPECT_EQ(tree->slaves[3].parent, 1u);
    EXPECT_EQ(tree->slaves[3].parent_port, 1u);
    EXPECT_EQ(tree->slaves[4].parent_port, 1u);
    EXPECT_EQ(tree->slaves[5].parent_port, 2u);
    EXPECT_THAT(tree->behind(1), ElementsAre(1, 2, 3));
}

// Physical link without communication (loop still closed) is not an open port: ethercrab issue 372.
TEST(Topology, LinkAloneIsNotOpen) {
    const auto only_link = static_cast<std::uint16_t>(ports({0}) | (1u << 5));
    const auto tree = build_topology(std::vector{only_link});
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->slaves[0].open_ports(), 1u);
}

TEST(Topology, SignalWithClosedLoopIsNotOpen) {
    const auto signal_but_closed = static_cast<std::uint16_t>(ports({0}) | (1u << 11));
    const auto tree = build_topology(std::vector{signal_but_closed});
    ASSERT_TRUE(tree);
    EXPECT_FALSE(tree->slaves[0].open[1]);
}

// The cable from the master goes into port 1 of the slave.
TEST(Topology, EntryThroughAnotherPort) {
    const auto tree = build_topology(std::vector{ports({0, 1}), ports({1})});
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->slaves[1].entry_port, 1u);
}

// master -- A -- 1[B]0 -- C -- D: the frame leaves B through its port 0 before B processes it. So B comes last, behind a line A C D.
TEST(Topology, ASlaveInTheLineWithItsPlugsExchangedIsNamed) {
    const auto tree = build_topology(std::vector{ports({0, 1}), ports({0, 1}), ports({0}), ports({0, 1})});
    ASSERT_FALSE(tree);
    EXPECT_EQ(tree.error().code, "bus.plugs_exchanged");
    EXPECT_EQ(tree.error().subject, "slave 3");
    EXPECT_THAT(tree.error().what, HasSubstr("in its port 1 (OUT)"));
    // Two of them, or one that leads nowhere, are something else.
    EXPECT_EQ(build_topology(std::vector{ports({0}), ports({0, 1}), ports({0, 1})}).error().code, "bus.topology");
    EXPECT_EQ(build_topology(std::vector{ports({0}), ports({0})}).error().code, "bus.topology");
    EXPECT_EQ(build_topology(std::vector{ports({0}), ports({1, 2})}).error().code, "bus.topology");
}

TEST(Topology, OpenPortWithoutSlaveIsNamed) {
    const auto tree = build_topology(std::vector{ports({0, 1, 3}), ports({0})});
    ASSERT_FALSE(tree);
    EXPECT_EQ(tree.error().code, "bus.topology");
    EXPECT_THAT(tree.error().text(), HasSubstr("port 1 is open"));
}

TEST(Topology, SlaveWithoutParentIsNamed) {
    const auto tree = build_topology(std::vector{ports({0}), ports({0})});
    ASSERT_FALSE(tree);
    EXPECT_THAT(tree.error().text(), HasSubstr("slave 1"));
}

// first interface -- A -- B -- C -- second interface; C's port 1 has no slave behind it.
TEST(RingTopology, TheOneOpenPortWithoutASlaveLeadsToTheSecondInterface) {
    const std::vector status{ports({0, 1}), ports({0, 1}), ports({0, 1})};
    EXPECT_FALSE(build_topology(status)) << "on a line that is a port without a slave";
    const auto tree = build_ring_topology(status, 3);
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->ring_end, (RingEnd{2, 1}));
    EXPECT_EQ(tree->behind_break, 0u);
    EXPECT_EQ(tree->slaves[2].parent, 1u);
}

// A with a terminal behind its port 3; the frame goes there before it goes on.
TEST(RingTopology, ABranchIsNoWayOut) {
    const auto tree = build_ring_topology(std::vector{ports({0, 3, 1}), ports({0}), ports({0, 1})}, 3);
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->ring_end, (RingEnd{2, 1}));
    EXPECT_EQ(tree->slaves[1].parent_port, 3u);
}

// A -x- B -- C: B's port 0 is closed, and B is the first to process what the second interface sends.
TEST(RingTopology, BehindABreakIsATreeOfItsOwn) {
    const auto tree = build_ring_topology(std::vector{ports({0}), ports({1}), ports({0, 1})}, 1);
    ASSERT_TRUE(tree);
    EXPECT_EQ(tree->behind_break, 2u);
    EXPECT_FALSE(tree->slaves[1].parent);
    EXPECT_EQ(tree->slaves[2].parent, 1u);
    EXPECT_EQ(tree->ring_end, (RingEnd{2, 1}));
}

TEST(RingTopology, BrokenAtEitherInterface) {
    const auto first = build_ring_topology(std::vector{ports({1}), ports({0, 1})}, 0);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->behind_break, 2u);
    const auto second = build_ring_topology(std::vector{ports({0, 1}), ports({0})}, 2);
    ASSERT_TRUE(second);
    EXPECT_FALSE(second->ring_end);
    EXPECT_EQ(second->behind_break, 0u);
}

TEST(RingTopology, WhatFitsNoRingIsRefused) {
    EXPECT_FALSE(build_ring_topology(std::vector{ports({0, 1, 3}), ports({0, 1}), ports({0, 1})}, 3)) << "two ways out";
    EXPECT_FALSE(build_ring_topology(std::vector{ports({0, 1}), ports({1})}, 1)) << "the slave before the break has a way on";
    EXPECT_FALSE(build_ring_topology(std::vector{ports({0}), ports({})}, 1)) << "no way to the second interface";
}

TEST(Topology, SlaveWithoutOpenPort) { EXPECT_FALSE(build_topology(std::vector{ports({})})); }
TEST(Topology, NothingIsATree) { EXPECT_TRUE(build_topology({})); }

}  // namespace
}  // namespace taktwerk::ecat
