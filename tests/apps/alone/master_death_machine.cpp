// The master dies while an axis moves: killed, by a program's wild pointer, by a program that never comes back. Nobody sends any more;
// the slaves' watchdogs are the reaction (docs/faults.md, "master gone"). Two processes on a veth cable; needs root, skipped otherwise.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/alone/cable.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

struct Death {
    const char* name;
    int how;     // parameter of the program
    int signal;  // sent to the master, 0 = none
};

class MasterDeath : public ::testing::TestWithParam<Death> {};

TEST_P(MasterDeath, EndsInTheSlavesWatchdogAndTheDriveStopsByItself) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-death-XXXXXX").string();
    const std::filesystem::path folder = ::mkdtemp(pattern.data());
    std::filesystem::create_directories(folder / "machines");
    std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
    const auto file = (folder / "machines/death.yaml").string();
    std::ostringstream text;
    text << std::ifstream(source / "config/machines/minimal.yaml").rdbuf();
    auto yaml = text.str();
    const auto replace = [&](const std::string& from, const std::string& to) {
        const auto at = yaml.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        yaml.replace(at, from.size(), to);
    };
    replace("interface: simulated", "interface: twk0");
    replace("cycle: 1 ms", "cycle: 4 ms");
    yaml += "start_mode: automatic\nhmi: { socket: '" + (folder / "socket").string() + "', lcm: { enabled: false } }\n" +
            "simulation: { supervision: relaxed }\nprograms:\n  dying:\n    library: " + TAKTWERK_BINARY_DIR +
            "/tests/dying_program.so\n    autostart: true\n    parameters: { how: " + std::to_string(GetParam().how) +
            " }\n    tasks:\n      main: { every: 1 cycles }\n";
    std::ofstream(file) << yaml;

    Child slaves(cable.at_slaves({taktwerk, "sim", file, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says(" of '", 10s)) << slaves.text();
    Child master(cable.at_master({taktwerk, "run", file}));
    ASSERT_TRUE(slaves.says("-> operation enabled", 30s)) << master.text() << slaves.text();
    if (GetParam().signal != 0) master.signal(GetParam().signal);

    // Relaxed supervision sets the watchdog to 500 ms.
    EXPECT_TRUE(slaves.says("OP -> SAFEOP", 10s)) << master.text() << slaves.text();
    EXPECT_TRUE(slaves.says("operation enabled -> fault", 5s)) << slaves.text();
    EXPECT_TRUE(slaves.says("-> fault\n", 5s)) << slaves.text();
    if (GetParam().how != 2) {
        EXPECT_GT(master.wait(5s), 0) << "it is dead: by the signal, or by what a sanitizer makes of it";
    }
    std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(By, MasterDeath,
                         ::testing::Values(Death{"kill_9", 0, SIGKILL}, Death{"wild_pointer", 1, 0}, Death{"endless_loop", 2, 0}),
                         [](const auto& death) { return death.param.name; });

}  // namespace
}  // namespace taktwerk::apps
