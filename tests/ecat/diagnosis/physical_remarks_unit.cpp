// What a survey says of the copper: links that are not full duplex, terminals that take more from the E-bus than there is.

#include "ecat/diagnosis/physical_remarks.hpp"

#include <gmock/gmock.h>

#include "tests/ecat/diagnosis/probed_bus.hpp"

namespace taktwerk::ecat {
namespace {

using test::ProbedBus;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<Error> links_of(ProbedBus& bus) {
    const Survey found = bus.look();
    auto probe = bus.probe();
    const auto wrong = probe.run(wrong_links(probe.port(), found));
    EXPECT_TRUE(wrong);
    return wrong ? *wrong : std::vector<Error>{};
}

TEST(WrongLinks, AreNamedByTheirPortAndSoundOnesAreNot) {
    ProbedBus bus{"sts"};
    EXPECT_THAT(links_of(bus), IsEmpty());
    auto& phy = bus.network.slave(1).controller().phys().phy(1);
    phy.partner = 0x0080;
    phy.partner_negotiates = false;
    const auto wrong = links_of(bus);
    ASSERT_THAT(wrong, SizeIs(1));
    EXPECT_EQ(wrong[0].code, "bus.wrong_link");
    EXPECT_EQ(wrong[0].subject, "slave 1");
    EXPECT_THAT(wrong[0].what, HasSubstr("port 1: 100 Mbit half duplex"));
}

/// A row of a coupler (negative: mA that it supplies) and terminals.
struct EbusRow : ProbedBus {
    EbusRow(std::initializer_list<int> currents) : ProbedBus("") {
        for (const int current : currents) {
            auto terminal = test::terminal_description();
            terminal->ebus_current = static_cast<std::int16_t>(current);
            network.add(terminal, std::make_unique<test::InvertingTerminal>());
        }
    }
};

// 2000 mA: the third terminal takes the 2001st, whoever stands behind it is not told as well.
TEST(EbusOverload, IsToldAtTheFirstTerminalThatGetsTooLittle) {
    EbusRow enough{-2000, 1000, 900, 100};
    EXPECT_THAT(ebus_overloads(enough.look()), IsEmpty());
    EbusRow bus{-2000, 1000, 900, 101, 50};
    const auto found = ebus_overloads(bus.look());
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].subject, "slave 3");
    EXPECT_THAT(found[0].what, HasSubstr("take 2001 mA from the E-bus, and slave 0 supplies 2000 mA"));
}

TEST(EbusOverload, IsToldOfEachCoupler) {
    EbusRow bus{-500, 600, -500, 600};
    EXPECT_THAT(ebus_overloads(bus.look()), SizeIs(2));
}

// What stands on the E-bus has no PHY to ask.
TEST(WrongLinks, AreNotLookedForOnTheEbus) {
    EbusRow bus{-500, 100};
    const Survey found = bus.look();
    EXPECT_EQ(found.slaves[0].ports[0].kind, PortKind::mii);
    EXPECT_EQ(found.slaves[0].ports[1].kind, PortKind::ebus);
    EXPECT_EQ(found.slaves[1].ports[0].kind, PortKind::ebus);
    EXPECT_THAT(links_of(bus), IsEmpty());
}

}  // namespace
}  // namespace taktwerk::ecat
