// What the registers of a PHY say of a link. IEEE 802.3: 22.2.4 (registers), 28B.3 (priorities).
#include "ecat/wire/phy.hpp"

#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

/// Both ends offer all four, and have agreed.
PhyRegisters good() {
    PhyRegisters phy;
    phy.control = 0x3100;  // auto-negotiation
    phy.status = 0x786D;   // link, complete
    phy.advertised = 0x01E1;
    phy.partner = 0x45E1;
    phy.expansion = 0x0001;
    return phy;
}

TEST(PhyLink, IsTheBestThatBothEndsCan) {
    EXPECT_EQ(phy_link(good()), (PhyLink{true, 100, true, true, true}));
    auto phy = good();
    phy.partner = 0x40A1;  // 100 half, 10 half
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 100, false, true, true}));
    phy.partner = 0x4061;  // 10 full, 10 half
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 10, true, true, true}));
    phy.advertised = 0x0021;
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 10, false, true, true}));
    phy.partner = 0x4001;
    EXPECT_EQ(phy_link(phy).megabits, 0u) << "nothing that both can";
}

// 28.2.3.1, parallel detection: the other end's speed is seen, its duplex is not, and half is assumed.
TEST(PhyLink, WithAnEndThatDoesNotNegotiateIsHalfDuplex) {
    auto phy = good();
    phy.partner = 0x0080;
    phy.expansion = 0;
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 100, false, true, false}));
}

TEST(PhyLink, IsWhatIsSetWhereNothingIsNegotiated) {
    auto phy = good();
    phy.control = 0x2100;
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 100, true, false, false}));
    phy.control = 0x0000;
    EXPECT_EQ(phy_link(phy), (PhyLink{true, 10, false, false, false}));
}

TEST(PhyLink, IsNoneWithoutTheLinkBit) {
    auto phy = good();
    phy.status = 0x7849;
    EXPECT_EQ(phy_link(phy), (PhyLink{false, 0, false, true, false}));
}

// DP83848 (National Semiconductor, 2000h 5C90h), KSZ8081 (Micrel, 0022h 1560h): their data sheets, registers 2 and 3.
TEST(PhyMaker, IsKnownByRegistersTwoAndThree) {
    PhyRegisters phy;
    EXPECT_EQ(phy_maker_code(phy), 0u);
    phy.id1 = 0x2000, phy.id2 = 0x5C90;
    EXPECT_EQ(phy_maker(phy_maker_code(phy)), "National Semiconductor (TI)");
    phy.id1 = 0x0022, phy.id2 = 0x1560;
    EXPECT_EQ(phy_maker(phy_maker_code(phy)), "Micrel (Microchip)");
    phy.id1 = 0x1234, phy.id2 = 0x5678;
    EXPECT_EQ(phy_maker(phy_maker_code(phy)), "");
    phy.id1 = phy.id2 = 0xFFFF;
    EXPECT_EQ(phy_maker_code(phy), 0u) << "nobody drives the wire";
}

// 0510h bits 3 to 7.
TEST(MiiManagement, SaysTheAddressOfTheFirstPhy) {
    EXPECT_EQ(mii::address_offset(0x0000), 0);
    EXPECT_EQ(mii::address_offset(0x0008), 1);
    EXPECT_EQ(mii::address_offset(0x80F8), 31);
}

}  // namespace
}  // namespace taktwerk::ecat
