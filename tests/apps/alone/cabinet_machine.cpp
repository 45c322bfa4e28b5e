// A cabinet as it is bought: a coupler, eight terminals of different kinds, an encoder, servo drives of two other makers. `taktwerk bus init`
// writes its machine file, and that file as it is written comes up, reads, switches and moves: in virtual time, and on a cable between processes.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/machine/load.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// What stands there: the wheel of the encoder runs on what the second drive feeds.
const std::string there = R"(version: 1
name: there
cycle: 2 ms
bus:
  interface: simulated
  slaves:
    - { name: coupler, device: ek1100 }
    - { name: di, device: el1008 }
    - { name: di16, device: el1809 }
    - { name: out, device: el2008 }
    - { name: relay, device: el2622 }
    - { name: ai, device: el3104 }
    - { name: rtd, device: el3202 }
    - { name: tc, device: el3314 }
    - { name: ao, device: el4034 }
    - { name: counter, device: el5101 }
    - { name: press, profile: minas-a6b }
    - { name: feeder, profile: asda-a2-e }
io:
  inputs:
    door: { slave: di, channel: in3, simulated: 1 }
    pressure: { slave: ai, channel: ai2, simulated: 5 V }
    water: { slave: rtd, channel: ai1, simulated: 60 degC }
axes:
  press:
    slave: press
    unit: mm
    gearing: { counts_per_revolution: 131072, feed: 10 mm }
    limits: { velocity: 100 mm/s, acceleration: 500 mm/s2, jerk: 5000 mm/s3 }
    following_error: { window: 2 mm }
  feeder:
    slave: feeder
    unit: mm
    gearing: { counts_per_revolution: 131072, feed: 10 mm }
    limits: { velocity: 100 mm/s, acceleration: 500 mm/s2, jerk: 5000 mm/s3 }
    following_error: { window: 2 mm }
  wheel:
    slave: counter
    encoder: true
    unit: mm
    gearing: { counts_per_revolution: 4096, feed: 10 mm }
    limits: { velocity: 1000 mm/s, acceleration: 10000 mm/s2, jerk: 100000 mm/s3 }
    simulation: { turned_by: feeder }
)";

class Cabinet : public ::testing::Test {
protected:
    void SetUp() override {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        for (const char* shelf : {"drives", "devices"})
            std::filesystem::create_directory_symlink(source / "config" / shelf, folder / shelf);
        std::ofstream(real()) << there;
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::string real() const { return folder / "machines/there.yaml"; }
    [[nodiscard]] std::string cell() const { return folder / "machines/cell.yaml"; }
    [[nodiscard]] static runtime::MachineConfig load(const std::string& file) {
        auto result = read_machine_without_programs(file, true);
        if (!std::holds_alternative<LoadedFile>(result)) {
            ADD_FAILURE() << file;
            return {};
        }
        return std::move(std::get<LoadedFile>(result).machine);
    }
    static std::size_t place_of(const std::vector<std::string>& names, const std::string& name) {
        const auto at = std::find(names.begin(), names.end(), name);
        EXPECT_NE(at, names.end()) << name;
        return static_cast<std::size_t>(at - names.begin());
    }
    std::filesystem::path folder;
};

TEST_F(Cabinet, WhatBusInitWritesComesUpAndMoves) {
    const auto init = in_process({"bus", "init", "--machine", real(), "--simulate", "-o", cell()});
    ASSERT_EQ(init.code, exit_ok) << init.err;
    const auto check = in_process({"check", cell()});
    ASSERT_EQ(check.code, exit_ok) << check.out << check.err;
    EXPECT_THAT(check.out, HasSubstr("12 slaves, 3 axes, 0 programs: no problem found"));

    auto config = load(cell());
    config.start_mode = runtime::Mode::manual;
    runtime::testing::TestMachine m{config, load(real())};
    ASSERT_TRUE(m.up());
    m.run(500ms);
    EXPECT_EQ(m.alarms(), "");
    const auto input = [&](const std::string& name) { return m.state().input_values[place_of(m.machine->layout().inputs, name)].value; };
    EXPECT_EQ(input("el1008_1_in3"), 1);
    EXPECT_EQ(input("el1008_1_in4"), 0);
    EXPECT_NEAR(input("el3104_5_ai2"), 5, 0.001);
    EXPECT_NEAR(input("el3202_6_ai1"), 60, 0.1);

    m.enable(0);
    m.enable(1);
    for (std::uint16_t axis = 0; axis < 2; ++axis) {
        ASSERT_EQ(m.command(runtime::OperatorAction::home, axis).answer, runtime::Answer::accepted);
        ASSERT_TRUE(m.until([&] { return m.axis(axis).homed; }, 5s)) << m.alarms();
    }
    const double press = m.axis(0).actual_position, feeder = m.axis(1).actual_position, wheel = m.axis(2).actual_position;
    for (std::uint16_t axis = 0; axis < 2; ++axis)
        ASSERT_EQ(
            m.command(runtime::OperatorAction::move_absolute, axis, false, m.axis(axis).actual_position + (axis == 0 ? 12 : 20), 8).answer,
            runtime::Answer::accepted);
    ASSERT_TRUE(m.until([&] { return std::abs(m.axis(1).actual_position - feeder - 20) < 0.01 && m.axis(1).in_position; }, 10s))
        << m.alarms();
    EXPECT_NEAR(m.axis(0).actual_position - press, 12, 0.01);
    EXPECT_NEAR(m.axis(2).actual_position - wheel, 20, 0.02) << "the encoder saw all of it";
    EXPECT_EQ(m.alarms(), "");
}

class CabinetOnACable : public Cabinet {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
        if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        Cabinet::SetUp();
    }
    void TearDown() override {
        if (!folder.empty()) Cabinet::TearDown();
    }
    [[nodiscard]] std::string socket() const { return folder / "socket"; }
    std::string tell(std::vector<std::string> words, int expected = exit_ok) const {
        words.insert(words.begin(), taktwerk);
        words.insert(words.end(), {"-s", socket()});
        std::string said;
        EXPECT_EQ(run(std::move(words), &said), expected) << said;
        return said;
    }
    [[nodiscard]] nlohmann::json state() const { return nlohmann::json::parse(tell({"monitor", "--once", "--json"}), nullptr, false); }
    [[nodiscard]] double position(std::size_t axis) const { return state().at("axes").at(axis).at("actual_position").get<double>(); }
    const Cable cable;
};

// The builder's own edits: the name of a socket, and a computer without real time.
TEST_F(CabinetOnACable, TheSameAcrossACable) {
    Child slaves(cable.at_slaves({taktwerk, "sim", real(), "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'there'", 20s)) << slaves.text();
    std::string said;
    ASSERT_EQ(run(cable.at_master({taktwerk, "bus", "init", "--nic", "twk0", "-o", cell()}), &said), exit_ok) << said;
    std::stringstream text;
    text << std::ifstream(cell()).rdbuf();
    auto edited = text.str();
    const auto at = edited.find("cycle: 1 ms");
    ASSERT_NE(at, std::string::npos) << edited;
    edited.replace(at, 11, "cycle: 8 ms");
    std::ofstream(cell()) << edited << "hmi: { socket: '" << socket() << "' }\nsimulation: { supervision: relaxed }\nstart_mode: manual\n";

    Child master(cable.at_master({taktwerk, "run", cell()}));
    ASSERT_TRUE(master.says("running", 60s)) << master.text();
    tell({"enable", "axis1", "--wait"});
    tell({"enable", "axis2", "--wait"});
    tell({"home", "axis1", "--wait"});
    tell({"home", "axis2", "--wait"});
    const double press = position(0), feeder = position(1), wheel = position(2);
    tell({"move", "axis1", std::to_string(press + 6), "--velocity", "8"});
    tell({"move", "axis2", std::to_string(feeder + 10), "--velocity", "8"});
    for (int i = 0; i < 100 && std::abs(position(1) - feeder - 10) > 0.01; ++i) std::this_thread::sleep_for(100ms);
    EXPECT_NEAR(position(0) - press, 6, 0.01) << master.text();
    EXPECT_NEAR(position(1) - feeder, 10, 0.01) << master.text();
    EXPECT_NEAR(position(2) - wheel, 10, 0.02) << master.text();
    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(20s), exit_ok) << master.text();
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

}  // namespace
}  // namespace taktwerk::apps
