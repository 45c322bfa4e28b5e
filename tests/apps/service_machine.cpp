// The built command as a service: what its manager hears, in which order, and what a restart after a crash may do.

#include <linux/capability.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/datagram_in.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct ServiceRun : ::testing::Test {
    ServiceRun() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-service-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        heard.emplace((folder / "notify").string());
        ::setenv("NOTIFY_SOCKET", heard->path().c_str(), 1);
    }
    ~ServiceRun() override {
        for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    std::string socket() const { return (folder / "service.sock").string(); }
    std::string machine(const std::string& more = "") const {
        std::ostringstream text;
        text << std::ifstream(source / "config/machines/minimal.yaml").rdbuf();
        auto file = (folder / "machines/service.yaml").string();
        std::ofstream(file) << text.str() << "hmi: { socket: '" << socket()
                            << "', lcm: { enabled: false } }\nsimulation: { supervision: relaxed }\n"
                            << more;
        return file;
    }
    std::string mode() const {
        auto client = hmi::Client::connect(socket());
        if (!client) return "no client";
        const auto answer = client->request({{"cmd", "state"}}, 5s);
        return answer ? (*answer)["state"]["mode"].get<std::string>() : answer.error().text();
    }

    std::filesystem::path folder;
    std::optional<DatagramIn> heard;
};

TEST_F(ServiceRun, IsReadyWhenTheBusIsOperationalAndSaysThatItEnds) {
    ::setenv("WATCHDOG_USEC", "400000", 1);
    Child run({taktwerk, "run", machine()});
    ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
    EXPECT_EQ(mode(), "manual") << "who is ready answers";
    // Before it nothing but how the start goes; the first sign of life may come with it.
    for (const auto& message : heard->all()) {
        if (message == "READY=1") break;
        EXPECT_THAT(message, ::testing::AnyOf(StartsWith("STATUS="), StartsWith("EXTEND_TIMEOUT_USEC="), "WATCHDOG=1"));
    }
    ASSERT_TRUE(heard->gets("STATUS=running, manual mode, 0 of 1 axes powered, no alarm, SIMULATED bus", 5s));
    const auto fed = heard->count("WATCHDOG=1");
    ::poll(nullptr, 0, 600);
    EXPECT_GT(heard->count("WATCHDOG=1"), fed);
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_ok);
    EXPECT_EQ(heard->count("STOPPING=1"), 1u);
}

// The watchdog's purpose: what looks alive from outside, and does not control.
TEST_F(ServiceRun, ACycleThatHangsIsNotFed) {
    ::setenv("WATCHDOG_USEC", "400000", 1);
    Child run(
        {taktwerk, "run",
         machine(
             "start_mode: automatic\nprograms:\n  dying:\n    library: " + std::string(TAKTWERK_BINARY_DIR) +
             "/tests/dying_program.so\n    autostart: true\n    parameters: { how: 2 }\n    tasks:\n      main: { every: 1 cycles }\n")});
    ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
    ASSERT_TRUE(run.says("STUCK", 30s)) << run.text();
    const auto fed = heard->count("WATCHDOG=1");
    EXPECT_GT(fed, 0u) << "before it hung it was";
    ::poll(nullptr, 0, 1000);
    EXPECT_EQ(heard->count("WATCHDOG=1"), fed);
}

TEST_F(ServiceRun, ARestartBehindACrashIsInManualMode) {
    const auto file = machine("start_mode: automatic\n");
    {
        Child run({taktwerk, "run", file});
        ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
        EXPECT_EQ(mode(), "automatic") << "an ordinary start";
        run.signal(SIGKILL);
        EXPECT_EQ(run.wait(10s), 128 + SIGKILL);
    }
    {  // and one that does not come up in between changes nothing
        Child run({taktwerk, "run", file, "--duration", "1ms"});
        EXPECT_EQ(run.wait(30s), exit_bus) << run.text();
    }
    heard.emplace((folder / "notify").string());
    {
        Child run({taktwerk, "run", file});
        ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
        EXPECT_EQ(mode(), "manual");
        EXPECT_TRUE(run.says("did not end in order", 5s)) << run.text();
        run.signal(SIGTERM);
        EXPECT_EQ(run.wait(20s), exit_ok);
    }
    heard.emplace((folder / "notify").string());
    Child run({taktwerk, "run", file});
    ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
    EXPECT_EQ(mode(), "automatic") << "the one before ended in order";
}

// docs/security.md: each thread, also those of libraries, and whatever it starts.
TEST_F(ServiceRun, ItHasGivenUpWhatNoMachineNeeds) {
    Child run({taktwerk, "run", machine()});
    ASSERT_TRUE(heard->gets("READY=1", 30s)) << run.text();
    constexpr std::uint64_t kept = 1ULL << CAP_NET_RAW | 1ULL << CAP_NET_ADMIN | 1ULL << CAP_BPF | 1ULL << CAP_NET_BIND_SERVICE |
                                   1ULL << CAP_SYS_NICE | 1ULL << CAP_IPC_LOCK | 1ULL << CAP_DAC_OVERRIDE | 1ULL << CAP_CHOWN |
                                   1ULL << CAP_FOWNER;
    std::size_t threads = 0;
    for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(run.pid()) + "/task")) {
        ++threads;
        std::ifstream status(thread.path() / "status");
        std::map<std::string, std::string> fields;
        for (std::string name, value; status >> name && std::getline(status, value);)
            fields[name] = value.substr(std::min(value.size(), value.find_first_not_of(" \t")));
        EXPECT_EQ(fields["NoNewPrivs:"], "1");
        EXPECT_EQ(fields["Seccomp:"], "2");
        for (const char* set : {"CapPrm:", "CapEff:", "CapInh:", "CapAmb:"})
            EXPECT_EQ(std::stoull("0" + fields[set], nullptr, 16) & ~kept, 0u) << set << fields[set];
    }
    EXPECT_GT(threads, 4u);
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_ok);
}

TEST_F(ServiceRun, TheLogGoesToTheJournalOnlyWhereTheOutputIsTheJournals) {
    ::setenv("JOURNAL_STREAM", "1:1", 1);  // somebody else's
    Child run({taktwerk, "run", machine()});
    ::unsetenv("JOURNAL_STREAM");
    EXPECT_TRUE(run.says("running, manual mode", 30s)) << run.text();
}

}  // namespace
}  // namespace taktwerk::apps
