// The currents of a row of terminals against what their coupler supplies.

#include "runtime/check/ebus_remarks.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

MachineConfig row_of(const std::vector<std::optional<std::int16_t>>& currents) {
    MachineConfig config;
    for (std::size_t i = 0; i < currents.size(); ++i) {
        auto device = std::make_shared<ecat::DeviceDescription>();
        device->ebus_current = currents[i];
        ecat::SlaveConfig slave;
        slave.name = "s" + std::to_string(i);
        slave.device = device;
        config.bus.slaves.push_back(slave);
    }
    return config;
}

TEST(EbusRemarks, WhatACouplerFeedsIsEnoughToTheLastMilliampere) {
    EXPECT_TRUE(ebus_remarks(row_of({-2000, 1000, 900, 100})).empty());
    const auto found = ebus_remarks(row_of({-2000, 1000, 900, 101, 50}));
    ASSERT_EQ(found.size(), 1u) << "one remark, at the first that gets too little";
    EXPECT_EQ(found[0].subject, "bus.slaves.3");
    EXPECT_NE(found[0].what.find("take 2001 mA"), std::string::npos) << found[0].what;
}

TEST(EbusRemarks, AFeedTerminalBeginsAnew) {
    EXPECT_TRUE(ebus_remarks(row_of({-500, 400, -2000, 1900})).empty());
    EXPECT_EQ(ebus_remarks(row_of({-500, 600, -500, 600})).size(), 2u);
}

TEST(EbusRemarks, WhatIsNotKnownIsSaidAndCountsAsNothing) {
    EXPECT_TRUE(ebus_remarks(row_of({-500, std::nullopt, 400})).empty());
    const auto found = ebus_remarks(row_of({-500, std::nullopt, 501}));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].what.find("1 whose current is not known"), std::string::npos) << found[0].what;
    EXPECT_TRUE(ebus_remarks(row_of({std::nullopt, 5000})).empty()) << "drives on the cable, no coupler";
}

}  // namespace
}  // namespace taktwerk::runtime
