// What a master finds out about the PHYs of simulated slaves, and what it says of links that are no good for EtherCAT.
#include "ecat/diagnosis/phy_report.hpp"

#include <gmock/gmock.h>

#include "tests/ecat/diagnosis/probed_bus.hpp"

namespace taktwerk::ecat {
namespace {

using test::ProbedBus;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<PhyReport> phys(ProbedBus& bus, std::size_t position, std::optional<unsigned> only = {}) {
    const auto found = bus.look();
    auto probe = bus.probe();
    auto reports = probe.run(read_phys(probe.port(), found.slaves.at(position), only, "slave"));
    EXPECT_TRUE(reports) << (reports ? "" : reports.error().text());
    return reports ? *reports : std::vector<PhyReport>{};
}

TEST(PhyReport, ShowsEveryPortWithItsLink) {
    ProbedBus bus{"st"};
    const auto first = phys(bus, 0);
    ASSERT_THAT(first, SizeIs(2));
    for (const auto& report : first) {
        EXPECT_EQ(report.link(), (PhyLink{true, 100, true, true, true})) << report.port;
        EXPECT_THAT(phy_finding(report), IsEmpty());
    }
    const auto last = phys(bus, 1);
    ASSERT_THAT(last, SizeIs(2));
    EXPECT_TRUE(last[0].link().up);
    EXPECT_FALSE(last[1].link().up);
    EXPECT_THAT(phy_finding(last[1]), IsEmpty()) << "nothing is plugged in: nothing is wrong";
    ASSERT_THAT(phys(bus, 0, 1), SizeIs(1));
    EXPECT_EQ(phys(bus, 0, 1)[0].port, 1u);
}

TEST(PhyReport, SaysHalfDuplexAndTenMegabits) {
    ProbedBus bus{"s"};
    auto& phy = bus.network.slave(0).controller().phys().phy(0);
    phy.partner = 0x0080;  // seen by parallel detection: 100 Mbit half duplex
    phy.partner_negotiates = false;
    auto report = phys(bus, 0, 0).at(0);
    EXPECT_THAT(phy_finding(report), HasSubstr("port 0: 100 Mbit half duplex"));
    EXPECT_THAT(phy_finding(report), HasSubstr("the other end does not negotiate"));
    phy.partner = 0x4061;
    phy.partner_negotiates = true;
    report = phys(bus, 0, 0).at(0);
    EXPECT_THAT(phy_finding(report), HasSubstr("10 Mbit full duplex"));
    phy.auto_negotiation = false;
    phy.advertised = 0x0081;
    report = phys(bus, 0, 0).at(0);
    EXPECT_THAT(phy_finding(report), HasSubstr("100 Mbit half duplex"));
    EXPECT_THAT(phy_finding(report), HasSubstr("auto-negotiation is off"));
}

TEST(PhyReport, SaysThatAPhyDoesNotAnswer) {
    ProbedBus bus{"s"};
    bus.network.slave(0).controller().phys().phy(1).answers = false;
    const auto reports = phys(bus, 0);
    ASSERT_THAT(reports, SizeIs(2));
    EXPECT_TRUE(reports[0].phy);
    EXPECT_FALSE(reports[1].phy);
    ASSERT_TRUE(reports[1].trouble);
    EXPECT_EQ(reports[1].trouble->code, "phy.silent");
}

}  // namespace
}  // namespace taktwerk::ecat
