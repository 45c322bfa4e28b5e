// What a machine offers to Modbus TCP clients: what the example loads as. What must be refused: tests/config/bad/modbus_server_*.yaml.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "config/machine_file/machine_loader.hpp"
#include "hmi_bridge/modbus/shown_value.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using hmi::ShownValue;
using modbus::server::ListenAddress;
using modbus::server::NumberType;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string served_press = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/served-press.yaml";

LoadedMachine served_machine(const std::string& from = {}, const std::string& to = {}) {
    std::ostringstream text;
    text << std::ifstream(served_press).rdbuf();
    auto words = text.str();
    if (!from.empty()) words.replace(words.find(from), from.size(), to);
    auto result = load_machine_text(served_press, words);
    if (const auto* errors = std::get_if<1>(&result)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    return std::get<0>(std::move(result));
}

const hmi::ModbusPoint& served_point(const LoadedMachine& loaded, const std::string& name) {
    return *std::ranges::find(loaded.hmi.modbus_server->points, name, [](const hmi::ModbusPoint& p) { return p.place.name; });
}

TEST(ModbusServerFile, TheExampleLoadsAsItIsWritten) {
    const auto loaded = served_machine();
    ASSERT_TRUE(loaded.hmi.modbus_server);
    const auto& server = loaded.hmi.modbus_server->server;
    EXPECT_EQ(server.listen, (ListenAddress{"127.0.0.1", 1502}));
    EXPECT_EQ(server.max_age, 200ms);
    EXPECT_EQ(server.idle, 10s);

    const auto& position = served_point(loaded, "x_position");
    EXPECT_EQ(position.place.type, NumberType::float32);
    EXPECT_EQ(position.place.address, 4);
    EXPECT_EQ(position.shows.of, ShownValue::Of::axis);
    EXPECT_EQ(position.shows.what, ShownValue::What::position);
    EXPECT_EQ(position.shows.name, "x");
    EXPECT_FALSE(position.place.writable) << "nothing may be written that does not say so";

    const auto& pressure = served_point(loaded, "pressure");
    EXPECT_DOUBLE_EQ(6 * pressure.factor + pressure.offset, 6000) << "16 bar are 16000";
    EXPECT_EQ(served_point(loaded, "door_closed").place.type, NumberType::boolean) << "a discrete input, without `type`";
    EXPECT_EQ(served_point(loaded, "alarm").place.bit, 1);
    EXPECT_EQ(served_point(loaded, "x_velocity").place.order, modbus::server::WordOrder::low_first);
    EXPECT_TRUE(served_point(loaded, "lamp").place.writable);
    EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST(ModbusServerFile, WithoutAnAddressItServesThisComputerAlone) {
    EXPECT_EQ(served_machine("  listen: 127.0.0.1:1502 ", "  #").hmi.modbus_server->server.listen, (ListenAddress{"127.0.0.1", 502}));
}

TEST(ModbusServerFile, AnotherAddressIsRemarkedWithWhatItGivesAway) {
    const auto loaded = served_machine("127.0.0.1:1502", "0.0.0.0:1502");
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_EQ(loaded.warnings[0].code, "served.open");
    EXPECT_THAT(loaded.warnings[0].subject, HasSubstr("served-press.yaml:46:"));
    EXPECT_THAT(loaded.warnings[0].what,
                HasSubstr("whoever reaches any address of this computer reads 14 values of this machine and may write 2"));
}

TEST(ModbusServerFile, AMachineWithoutTheSectionServesNobody) {
    auto result = load_machine(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/minimal.yaml");
    ASSERT_EQ(result.index(), 0u);
    EXPECT_FALSE(std::get<0>(result).hmi.modbus_server);
}

// What programs have is known when they are loaded: then it is told at the place in the file.
TEST(ModbusServerFile, AVariableThatNoProgramHasIsToldWhereItStands) {
    const auto loaded = served_machine("machine: mode }", "variable: cell.cout }");
    hmi::ShownNames names = hmi::names_of(loaded.machine);
    EXPECT_THAT(hmi::check(*loaded.hmi.modbus_server, names), IsEmpty()) << "not known yet";
    names.with_programs = true;
    names.variables = {{"cell.count", ""}};
    const auto errors = hmi::check(*loaded.hmi.modbus_server, names);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_THAT(errors[0].text(), HasSubstr("served-press.yaml:52:"));
    EXPECT_THAT(errors[0].text(), HasSubstr("did you mean `cell.count`?"));
}

}  // namespace
}  // namespace taktwerk::config
