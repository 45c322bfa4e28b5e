// What `taktwerk check` tells of the Modbus TCP devices of a machine.

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::HasSubstr;

const std::string press = (source / "config" / "machines" / "press-valves.yaml").string();

TEST(CheckOfModbusDevices, SaysWhereTheyAreAndWhatIsAsked) {
    const auto said = in_process({"check", press});
    ASSERT_EQ(said.code, exit_ok) << said.err;
    EXPECT_THAT(said.out, HasSubstr("Modbus TCP devices\n  valves"));
    EXPECT_THAT(said.out, HasSubstr("writes by function"));
    EXPECT_THAT(said.out, HasSubstr("reads by  function 4, input registers 0 to 4: pressure, flow, overload\n"));
}

// Outputs first; neighbours in one request, across one register that nobody named; one register and one coil by functions 6 and 5.
TEST(CheckOfModbusDevices, EveryRegisterIsInTheRequestThatThePageTellsOf) {
    const auto said = in_process({"check", press, "--json"});
    ASSERT_EQ(said.code, exit_ok) << said.err;
    const auto devices = said.json()["modbus_tcp"];
    ASSERT_EQ(devices.size(), 1u);
    EXPECT_EQ(devices[0]["host"], "192.168.1.50");
    EXPECT_EQ(devices[0]["poll_ms"], 20.0);
    EXPECT_TRUE(devices[0]["unused"].empty());
    std::vector<std::string> requests;
    for (const auto& one : devices[0]["requests"]) {
        std::string text = fmt::format("{}{} {}+{}:", one["write"].get<bool>() ? "write " : "read ", one["function"].get<int>(),
                                       one["address"].get<int>(), one["count"].get<int>());
        for (const auto& name : one["registers"]) text += " " + name.get<std::string>();
        requests.push_back(text);
    }
    EXPECT_THAT(requests, ::testing::UnorderedElementsAre("write 5 0+1: open", "write 6 10+1: opening", "read 2 0+1: closed",
                                                          "read 4 0+5: pressure flow overload"));
}

TEST(CheckOfModbusDevices, SaysNothingWhereThereAreNone) {
    const auto said = in_process({"check", serial_axis});
    ASSERT_EQ(said.code, exit_ok) << said.err;
    EXPECT_EQ(said.out.find("Modbus TCP devices"), std::string::npos);
}

}  // namespace
}  // namespace taktwerk::apps
