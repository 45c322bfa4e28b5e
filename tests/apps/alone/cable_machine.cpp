// Master and slaves in two processes with a cable between: `taktwerk run` and `taktwerk sim` on the ends of a veth pair, each in its own
// network namespace. Needs root; skipped otherwise.

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The example `minimal` with its bus on a cable, in a folder of its own.
struct MinimalOnACable {
    std::filesystem::path folder;
    std::string socket, file;

    MinimalOnACable() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        socket = (folder / "socket").string();
        file = (folder / "machines/cable.yaml").string();
        auto text = text_of(source / "config/machines/minimal.yaml");
        text = replaced(replaced(text, "interface: simulated", "interface: twk0"), "cycle: 1 ms", "cycle: 4 ms");
        text += "hmi: { socket: '" + socket + "', lcm: { enabled: false } }\nsimulation: { supervision: relaxed }\n";
        std::ofstream(file) << text;
    }
    ~MinimalOnACable() { std::filesystem::remove_all(folder); }
    MinimalOnACable(const MinimalOnACable&) = delete;
    MinimalOnACable& operator=(const MinimalOnACable&) = delete;
};

TEST(CommandLineCable, RunMovesTheAxesOfSim) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";

    const MinimalOnACable machine;
    const auto &socket = machine.socket, &file = machine.file;
    const auto capture = (machine.folder / "cable.pcap").string();
    const auto operate = [&](std::vector<std::string> words) {
        words.insert(words.begin(), taktwerk);
        words.insert(words.end(), {"-s", socket});
        std::string said;
        const int code = run(std::move(words), &said);
        EXPECT_EQ(code, exit_ok) << said;
        return said;
    };

    std::string version;
    const bool tshark = run({"tshark", "--version"}, &version) == 0;
    Child listener(tshark ? cable.at_master({"tshark", "-q", "-i", "twk0", "-w", capture}) : std::vector<std::string>{"true"});
    if (tshark) {
        EXPECT_TRUE(listener.says("Capturing", 10s)) << listener.text();
    }
    Child slaves(cable.at_slaves({taktwerk, "sim", file, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slave of 'minimal'", 10s)) << slaves.text();
    Child master(cable.at_master({taktwerk, "run", file}));
    ASSERT_TRUE(master.says("running, manual mode", 30s)) << master.text() << slaves.text();

    operate({"enable", "x", "--wait"});
    operate({"home", "x", "--wait"});
    EXPECT_THAT(operate({"jog", "x", "--velocity", "20", "--for", "600ms"}), HasSubstr("stands at 1"));  // 12 mm and the ramp
    const auto state = operate({"monitor", "--once", "--json"});
    EXPECT_THAT(state, HasSubstr("\"missed_ticks\":"));
    EXPECT_THAT(state, HasSubstr("\"frames_lost\":"));

    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(10s), exit_ok) << master.text();
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
    EXPECT_THAT(slaves.text(), HasSubstr("-> OP"));
    std::smatch counts;
    const std::string said = slaves.text();
    ASSERT_TRUE(std::regex_search(said, counts, std::regex{"([0-9]+) frames came, ([0-9]+) answers went back"})) << said;
    EXPECT_EQ(counts[1], counts[2]);

    if (tshark) {
        listener.signal(SIGINT);
        listener.wait(10s);
        std::string malformed;
        EXPECT_EQ(run({"tshark", "-r", capture, "-Y", "_ws.malformed"}, &malformed), 0) << malformed;
        EXPECT_THAT(malformed, Not(HasSubstr("Malformed")));
        std::string exchanges;  // LRW is command 12 (ETG.1000.4, table of commands)
        EXPECT_EQ(run({"tshark", "-r", capture, "-Y", "ecat.cmd == 12", "-T", "fields", "-e", "frame.number"}, &exchanges), 0);
        EXPECT_GT(std::count(exchanges.begin(), exchanges.end(), '\n'), 200) << exchanges;
    }
}

TEST(CommandLineCable, ACaptureDisturbsNobodyAndEvidenceStaysWhenTheSlavesAreGone) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    const MinimalOnACable machine;
    const auto captured = (machine.folder / "cable.pcapng").string(), evidence = (machine.folder / "evidence").string();
    const auto listen = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {taktwerk, "bus", "capture", "--nic", "twk0", "--duration", "1s"});
        std::string said;
        const int code = run(cable.at_master(std::move(words)), &said);
        return std::pair{code, said};
    };
    EXPECT_THAT(listen({}).second, HasSubstr("no EtherCAT frame was heard"));

    Child slaves(cable.at_slaves({taktwerk, "sim", machine.file, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slave of 'minimal'", 10s)) << slaves.text();
    Child master(cable.at_master({taktwerk, "run", machine.file, "--evidence", evidence}));
    ASSERT_TRUE(master.says("running, manual mode", 30s)) << master.text() << slaves.text();

    const auto [code, said] = listen({"--json", "-o", captured});
    ASSERT_EQ(code, exit_ok) << said;
    const auto heard = nlohmann::json::parse(said);
    ASSERT_EQ(heard["masters"].size(), 1u) << said;
    const auto& ours = heard["masters"][0];
    EXPECT_NEAR(ours["cycle_ms"].get<double>(), 4, 0.8) << said;
    EXPECT_GT(ours["back"].get<double>(), 100) << said;
    EXPECT_EQ(ours["sent"], 0) << "a frame that bypasses the kernel's queue passes listeners by";
    EXPECT_EQ(ours["damaged"], 0);
    EXPECT_EQ(ecat::test::read_pcapng(captured).size(), heard["frames"].get<std::size_t>());
    EXPECT_EQ(listen({"-o", captured}).first, exit_bad_file) << "it is not written over";
    EXPECT_THAT(master.text(), Not(HasSubstr("ALARM"))) << "nobody was disturbed";

    slaves.signal(SIGKILL);
    ASSERT_TRUE(master.says(" s around ", 20s)) << master.text();
    master.signal(SIGTERM);
    master.wait(20s);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(evidence)) files.push_back(entry.path());
    ASSERT_EQ(files.size(), 1u) << master.text();
    EXPECT_GT(ecat::test::read_pcapng(files[0]).size(), 400u) << "a second before at the least";
    EXPECT_THAT(text_of(files[0]), HasSubstr("ALARM "));
}

}  // namespace
}  // namespace taktwerk::apps
