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

}  // namespace
}  // namespace taktwerk::ecat
