// Axes of every kind in a group that comes and goes: an encoder at a counter terminal, an amplifier at +-10 V with its wires. The tool changer runs
// with them in its gripper, and nobody complains of what is in the rack.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// The shipped file with more in it: `slaves` at the end of the gripper's group, points and axes in their sections.
struct MoreInTheGripper {
    std::string slaves, inputs, outputs, axes;

    [[nodiscard]] std::string file() const {
        std::ifstream from{source / "config" / "machines" / "tool-changer.yaml"};
        std::stringstream read;
        read << from.rdbuf();
        std::string text = read.str();
        const auto behind = [&](const std::string& line, const std::string& more) {
            const auto at = text.find(line);
            ASSERT_NE(at, std::string::npos) << line;
            text.insert(text.find('\n', at + 1) + 1, more);
        };
        behind("- { name: gripper_out,", slaves);
        behind("\n  inputs:", inputs);
        behind("\n  outputs:", outputs);
        behind("\naxes:", axes);
        const auto library = text.find("tool_changer.so");
        text.insert(library, std::string(TAKTWERK_BINARY_DIR) + "/programs/");
        return text;
    }
};

Outcome run_for(const MoreInTheGripper& more, const char* duration) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("taktwerk-group-axes-{}", ::getpid());
    fs::create_directories(folder / "machines");
    for (const char* shared : {"drives", "devices"}) fs::create_directory_symlink(source / "config" / shared, folder / shared);
    const auto file = (folder / "machines" / "tools.yaml").string();
    std::ofstream{file} << more.file();
    auto said = in_process({"run", file, "--simulate", "--virtual-time", "--duration", duration});
    fs::remove_all(folder);
    return said;
}

/// Both tools were taken and laid down again, and nothing was told but that.
void both_tools_worked(const Outcome& said) {
    EXPECT_EQ(said.code, exit_ok) << said.out << said.err;
    const std::string all = said.out + said.err;
    EXPECT_THAT(all, AllOf(HasSubstr("'tool_a' has joined"), HasSubstr("'tool_a' has left"), HasSubstr("'tool_b' has joined"),
                           HasSubstr("screw Disabled -> DiscreteMotion")));
    EXPECT_THAT(all, AllOf(Not(HasSubstr(" alarm ")), Not(HasSubstr(" warning ")), Not(HasSubstr("ErrorStop")), Not(HasSubstr("why:"))));
}

TEST(GroupAxes, AnEncoderComesAndGoes) {
    both_tools_worked(run_for({.slaves = "    - { name: counter, device: el5101, hot_connect: tool_a }\n",
                               .inputs = {},
                               .outputs = {},
                               .axes = "  wheel:\n    slave: counter\n    encoder: true\n    unit: mm\n"
                                       "    gearing: { counts_per_revolution: 4096, feed: 200 mm }\n"
                                       "    limits: { velocity: 1000 mm/s, acceleration: 5000 mm/s2, jerk: 50000 mm/s3 }\n"
                                       "    simulation: { turned_by: x, index_pulse: 50 mm }\n"},
                              "20s"));
}

TEST(GroupAxes, AnAnalogAmplifierComesAndGoes) {
    both_tools_worked(run_for({.slaves = "    - { name: counter, device: el5101, hot_connect: tool_a }\n"
                                         "    - { name: volts, device: el4032, hot_connect: tool_a }\n"
                                         "    - { name: di, device: el1008, hot_connect: tool_a }\n"
                                         "    - { name: do, device: el2008, hot_connect: tool_a }\n",
                               .inputs = "    q_ready: { slave: di, channel: in1 }\n"
                                         "    q_healthy: { slave: di, channel: in2, inverted: true }\n",
                               .outputs = "    q_speed: { slave: volts, channel: ao1 }\n    q_enable: { slave: do, channel: out1 }\n",
                               .axes = "  q:\n    slave: counter\n    unit: mm\n"
                                       "    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
                                       "    limits: { velocity: 400 mm/s, acceleration: 2000 mm/s2, jerk: 40000 mm/s3 }\n"
                                       "    control: { mode: velocity, kv: 20 }\n"
                                       "    following_error: { window: 8 mm, time: 10 ms }\n"
                                       "    homing: { kind: set_here }\n"
                                       "    analog: { setpoint: q_speed, velocity_at_10V: 500 mm/s, polarity_distance: 2 mm, enable: "
                                       "q_enable, ready: q_ready, fault: q_healthy }\n"},
                              "20s"));
}

}  // namespace
}  // namespace taktwerk::apps
