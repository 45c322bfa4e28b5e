// The tree that is there laid over the tree that was known. DL status: bit 9+2p signal, bit 8+2p loop closed (ETG.1000.4, 0110h).
#include "ecat/bringup/presence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::Optional;

std::uint16_t open_ports(std::initializer_list<unsigned> ports) {
    unsigned status = 0x5500;  // all loops closed
    for (const unsigned port : ports) status = (status & ~(1u << (8 + 2 * port))) | (1u << (9 + 2 * port));
    return static_cast<std::uint16_t>(status);
}
Topology tree(std::initializer_list<std::uint16_t> dl_status) { return build_topology(std::vector<std::uint16_t>{dl_status}).value(); }

// 0: ports 0 3 1; behind port 3: 1 - 2; behind port 1: 3 - 4
const auto whole = tree({open_ports({0, 1, 3}), open_ports({0, 1}), open_ports({0}), open_ports({0, 1}), open_ports({0})});

TEST(PlacesNow, EverybodyStandsWhereItStood) {
    EXPECT_THAT(places_now(whole, whole), ElementsAre(Optional(0u), Optional(1u), Optional(2u), Optional(3u), Optional(4u)));
}

TEST(PlacesNow, BehindAMissingBranchTheOthersMoveUp) {
    const auto without_branch = tree({open_ports({0, 1}), open_ports({0, 1}), open_ports({0})});
    EXPECT_THAT(places_now(whole, without_branch),
                ElementsAre(Optional(0u), Eq(std::nullopt), Eq(std::nullopt), Optional(1u), Optional(2u)));
}

TEST(PlacesNow, TheEndOfABranchMissingMovesWhoComesAfterIt) {
    const auto without_end = tree({open_ports({0, 1, 3}), open_ports({0}), open_ports({0, 1}), open_ports({0})});
    EXPECT_THAT(places_now(whole, without_end), ElementsAre(Optional(0u), Optional(1u), Eq(std::nullopt), Optional(2u), Optional(3u)));
}

TEST(PlacesNow, ASlaveAtAPortThatWasFreeIsNobody) {
    const auto known = tree({open_ports({0, 1}), open_ports({0})});
    const auto now = tree({open_ports({0, 1, 3}), open_ports({0}), open_ports({0})});
    EXPECT_THAT(places_now(known, now), ElementsAre(Optional(0u), Optional(2u)));
}

// A ring of four; the known tree is that of the line as which it was measured, with its way out.
Topology ring_of_four() {
    Topology known = tree({open_ports({0, 1}), open_ports({0, 1}), open_ports({0, 1}), open_ports({0})});
    known.ring_end = RingEnd{3, 1};
    return known;
}

TEST(PlacesNow, BehindABreakSlavesAreFoundFromTheOtherEnd) {
    const auto broken = build_ring_topology(std::vector{open_ports({0, 1}), open_ports({0}), open_ports({1}), open_ports({0, 1})}, 2);
    ASSERT_TRUE(broken);
    EXPECT_THAT(places_now(ring_of_four(), *broken), ElementsAre(Optional(0u), Optional(1u), Optional(2u), Optional(3u)));
    const auto at_the_first =
        build_ring_topology(std::vector{open_ports({1}), open_ports({0, 1}), open_ports({0, 1}), open_ports({0, 1})}, 0);
    ASSERT_TRUE(at_the_first);
    EXPECT_THAT(places_now(ring_of_four(), *at_the_first), ElementsAre(Optional(0u), Optional(1u), Optional(2u), Optional(3u)));
}

TEST(PlacesNow, OneMissingInARingMovesOnlyThoseBehindIt) {
    const auto without_second = build_ring_topology(std::vector{open_ports({0}), open_ports({1}), open_ports({0, 1})}, 1);
    ASSERT_TRUE(without_second);
    EXPECT_THAT(places_now(ring_of_four(), *without_second), ElementsAre(Optional(0u), Eq(std::nullopt), Optional(1u), Optional(2u)));
    const auto without_first = build_ring_topology(std::vector{open_ports({1}), open_ports({0, 1}), open_ports({0, 1})}, 0);
    ASSERT_TRUE(without_first);
    EXPECT_THAT(places_now(ring_of_four(), *without_first), ElementsAre(Eq(std::nullopt), Optional(0u), Optional(1u), Optional(2u)));
}

}  // namespace
}  // namespace taktwerk::ecat
