// `taktwerk run --hmi`: the page is served by a process of its own, which ends with the run and whose death the machine does not feel.

#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/hmi/quiet_machine.hpp"
#include "tests/hmi_bridge/web/page_client.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class PageBesideTheMachine : public ::testing::Test {
protected:
    void SetUp() override {
        if (!page_is_built()) GTEST_SKIP() << "the page is not built (no npm, or TAKTWERK_PAGE=OFF)";
    }
};

TEST_F(PageBesideTheMachine, TheRunServesItAndItsDeathIsToldAndNothingElse) {
    QuietMachine machine{{"--hmi"}};
    const auto port = machine.port();
    ASSERT_NE(port, 0) << machine.child->text();
    const auto answer = hmi::web::http_request(port, "GET /");
    EXPECT_EQ(answer.status, 200) << answer.head;
    EXPECT_THAT(answer.body, HasSubstr("page.js"));

    const auto server = QuietMachine::child_of(machine.child->pid());
    ASSERT_GT(server, 1);
    ::kill(server, SIGKILL);
    EXPECT_TRUE(machine.child->says("the page's server is gone: ended by signal 9", 5s)) << machine.child->text();
    const auto before = machine.cycle(20s);
    ASSERT_GE(before, 0) << machine.child->text();
    ::usleep(100'000);
    EXPECT_GT(machine.cycle(1s), before);
    machine.child->signal(SIGTERM);
    EXPECT_EQ(machine.child->wait(20s), exit_ok) << machine.child->text();
}

// The run may be root's or may have borrowed what the bus needs: its page's server, which strangers talk to, has nothing of it.
TEST_F(PageBesideTheMachine, TheServerHasNoneOfTheRunsRights) {
    QuietMachine machine{{"--hmi=127.0.0.1:0"}};
    ASSERT_NE(machine.port(), 0) << machine.child->text();
    const auto rights = [](pid_t of, const std::string& name) {
        std::ifstream status("/proc/" + std::to_string(of) + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with(name + ":")) return std::stoull(line.substr(name.size() + 1), nullptr, 16);
        return ~0ull;
    };
    const auto server = QuietMachine::child_of(machine.child->pid());
    ASSERT_GT(server, 1);
    // CAP_DAC_OVERRIDE and CAP_NET_BIND_SERVICE of capability.h, and those of root alone.
    const auto may = ::geteuid() == 0 ? 1ull << 1 | 1ull << 10 : 0ull;
    for (const char* set : {"CapEff", "CapPrm", "CapInh", "CapAmb"}) EXPECT_EQ(rights(server, set) & ~may, 0u) << set;
    EXPECT_EQ(rights(server, "NoNewPrivs"), 1u);
    if (::geteuid() == 0) {
        EXPECT_NE(rights(machine.child->pid(), "CapEff") & ~may, 0u) << "else the run had nothing to lose";
    }
}

TEST_F(PageBesideTheMachine, ItEndsWithTheRunHoweverThatEnds) {
    for (const int signal : {SIGTERM, SIGKILL}) {
        QuietMachine machine{{"--hmi=127.0.0.1:0"}};
        const auto port = machine.port();
        ASSERT_NE(port, 0) << machine.child->text();
        machine.child->signal(signal);
        EXPECT_NE(machine.child->wait(20s), -1);
        bool listens = true;
        for (int tries = 0; tries < 250 && listens; ++tries) {
            listens = hmi::web::TcpEnd{}.open(port);
            if (listens) ::usleep(20'000);
        }
        EXPECT_FALSE(listens) << "5 s after signal " << signal;
    }
}

TEST_F(PageBesideTheMachine, APortThatIsTakenIsToldAndTheMachineRuns) {
    QuietMachine first{{"--hmi=127.0.0.1:0"}};
    const auto port = first.port();
    ASSERT_NE(port, 0) << first.child->text();
    QuietMachine second{{"--hmi=127.0.0.1:" + std::to_string(port)}};
    EXPECT_TRUE(second.child->says("cannot listen", 20s)) << second.child->text();
    EXPECT_TRUE(second.child->says("the page's server is gone", 5s)) << second.child->text();
    second.child->signal(SIGTERM);
    EXPECT_EQ(second.child->wait(20s), exit_ok) << second.child->text();
}

TEST(PageInVirtualTime, IsRefused) {
    Child run({taktwerk, "run", demo, "--virtual-time", "--hmi"});
    EXPECT_EQ(run.wait(20s), exit_usage);
    EXPECT_THAT(run.text(), HasSubstr("virtual time has no page"));
}

// bin/taktwerk finds the page where `cmake --install` puts it; PATH holds no node.
TEST_F(PageBesideTheMachine, TheInstalledPackageCarriesItAndNeedsNoNode) {
    const auto prefix = std::filesystem::temp_directory_path() / ("taktwerk-page-" + std::to_string(::getpid()));
    for (const char* component : {"runtime", "hmi"}) {
        Child install({TAKTWERK_CMAKE, "--install", TAKTWERK_BINARY_DIR, "--component", component, "--prefix", prefix.string()});
        ASSERT_EQ(install.wait(120s), 0) << install.text();
    }
    Child server({"/usr/bin/env", "-i", "PATH=/nowhere", (prefix / "bin" / "taktwerk").string(), "hmi", "--listen", "127.0.0.1:0",
                  "--audit", (prefix / "audit").string()});
    ASSERT_TRUE(server.says("the page: http://127.0.0.1:", 20s)) << server.text();
    const auto port = static_cast<std::uint16_t>(std::stoi(server.text().substr(server.text().find("127.0.0.1:") + 10, 6)));
    for (const char* file : {"/", "/page.js", "/page.css", "/icon.svg"}) {
        const auto answer = hmi::web::http_request(port, std::string("GET ") + file);
        EXPECT_EQ(answer.status, 200) << file;
        EXPECT_FALSE(answer.body.empty()) << file;
    }
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait(10s), exit_ok) << server.text();
    std::filesystem::remove_all(prefix);
}

}  // namespace
}  // namespace taktwerk::apps
