// What other people's HMIs hear of a machine, by the tools that they have: the SDK's example in C++, the one in Python, `taktwerk lcm`, and LCM's own logger and player.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/lcm/log_file.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/lcm/own_network.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/programs/installed_sdk.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto patience = 60s;

class Lcm : public ::testing::Test {
protected:
    void SetUp() override {
        auto pattern = (fs::temp_directory_path() / "taktwerk-lcm-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        network_ = std::make_unique<OwnNetwork>();
        if (!network_->made()) GTEST_SKIP() << "this system does not allow a network namespace of one's own";
    }
    void TearDown() override {
        machine_.reset();
        network_.reset();
        fs::remove_all(folder_);
    }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    /// minimal.yaml, simulated, publishing into the namespace.
    void start_machine() {
        std::ifstream in(source / "config/machines/minimal.yaml");
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        std::ofstream(path("machine.yaml")) << text << "hmi: { socket: '" << path("socket")
                                            << "', rate: 100 Hz }\nsimulation: { supervision: relaxed }\n";
        machine_ = std::make_unique<Child>(network_->in({taktwerk, "run", path("machine.yaml"), "--simulate"}));
        ASSERT_TRUE(machine_->says("commands are taken", patience)) << machine_->text();
        for (int i = 0; i < 200 && operate({"monitor", "--once"}).first != exit_ok; ++i) ::usleep(100'000);
    }
    std::pair<int, std::string> command(std::vector<std::string> words, std::chrono::milliseconds for_up_to = patience) const {
        words.insert(words.begin(), taktwerk);
        Child child(network_->in(words));
        const int code = child.wait(for_up_to);
        return {code, child.text()};
    }
    std::pair<int, std::string> operate(std::vector<std::string> words) const {
        words.insert(words.end(), {"-s", path("socket")});
        return command(std::move(words));
    }
    double position() const {
        const auto state = json::parse(operate({"monitor", "--once", "--json"}).second, nullptr, false);
        return state.is_object() ? state["axes"][0]["actual_position"].get<double>() : -1e9;
    }
    void move_axis() const {
        ASSERT_EQ(operate({"mode", "manual"}).first, exit_ok);
        const auto enabled = operate({"enable", "x", "--wait"});
        ASSERT_EQ(enabled.first, exit_ok) << enabled.second;
        const auto jogged = operate({"jog", "x", "--velocity", "7", "--for", "600ms"});
        ASSERT_EQ(jogged.first, exit_ok) << jogged.second;
        for (double before = -1; before != position();) {
            before = position();
            ::usleep(300'000);
        }
    }
    static bool installed(const char* tool) { return std::system(fmt::format("command -v {} >/dev/null 2>&1", tool).c_str()) == 0; }
    static std::set<std::string> channels_of(const std::string& file) {
        std::set<std::string> out;
        auto log = LogReader::open(file);
        EXPECT_TRUE(log) << log.error().text();
        while (const auto message = log->next()) out.insert(message->channel);
        return out;
    }

    std::string folder_;
    std::unique_ptr<OwnNetwork> network_;
    std::unique_ptr<Child> machine_;
};

// Anybody on the computer may send anything: a datagram that ends before its channel does (LCM takes its data for 4 GB), a fragment that promises as
// much, a type whose counts lie. Whoever listens lives on, and its terminal shows no bytes of theirs.
TEST_F(Lcm, HostileDatagramsEndNobody) {
    if (!installed("python3")) GTEST_SKIP() << "python3 sends the datagrams";
    start_machine();
    const auto log = path("hostile.lcmlog");
    Child spy(network_->in({taktwerk, "lcm", "spy", ".*", "--json"}));
    Child table(network_->in({taktwerk, "lcm", "spy"}));
    Child recorder(network_->in({taktwerk, "lcm", "record", log}));
    ASSERT_TRUE(spy.says("HEARTBEAT", patience) && table.says("HEARTBEAT", patience) && recorder.says("recording", patience));
    std::ofstream(path("hostile.py")) << R"(
import socket, struct, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
def send(data): s.sendto(data, ("239.255.76.67", 7667))
def short(channel, data): return struct.pack(">II", 0x4C433032, 1) + channel + data
for n in range(200):
    send(short(b"TAKTWERK_MINIMAL_AXIS_STATE", b""))  # no NUL behind the channel
    send(short(b"\x1b[31mRED\0", bytes(40)))
    send(short(b"TAKTWERK_MINIMAL_IO_STATE\0", bytes([n]) * (n % 60)))
    if n % 20 == 0: time.sleep(0.01)
for size in (0xFFFFFFFF, 0x7FFFFFFF):
    send(struct.pack(">IIIIHH", 0x4C433033, size, size, 0, 0, 1) + b"BIG\0" + b"x" * 40)
for n in range(40):
    send(short(b"LAST\0", b"12345678"))
    time.sleep(0.05)
)";
    Child sender(network_->in({"python3", path("hostile.py")}));
    ASSERT_EQ(sender.wait(patience), 0) << sender.text();
    EXPECT_TRUE(spy.says("\"channel\":\"LAST\"", patience)) << "it has outlived them";
    EXPECT_TRUE(table.says("LAST", patience));
    EXPECT_THAT(table.text(), Not(HasSubstr("\x1b[31m")));
    for (auto* child : {&spy, &table, &recorder}) {
        child->signal(SIGINT);
        EXPECT_EQ(child->wait(patience), exit_ok);
    }
    EXPECT_THAT(recorder.text(), Not(HasSubstr("are full")));
    EXPECT_EQ(channels_of(log).count("LAST"), 1u);
}

// What reads the table may go: `taktwerk lcm spy | head -2` ends.
TEST_F(Lcm, SpyEndsWhenNobodyReadsIt) {
    start_machine();
    Child pipe(network_->in({"sh", "-c", std::string(taktwerk) + " lcm spy | head -2"}));
    EXPECT_EQ(pipe.wait(patience), 0) << pipe.text();
    EXPECT_THAT(pipe.text(), HasSubstr("channel"));
}

// The 41 lines of the SDK, built as their reader builds them: they show the machine's number to the last digit, and say when it is old.
TEST_F(Lcm, TheExampleOfTheSdkShowsPositionsAndSaysStale) {
    const testing::InstalledSdk sdk;
    for (const auto& entry : fs::directory_iterator(sdk.prefix() / "share/taktwerk/examples/lcm"))
        fs::copy(entry.path(), sdk.project() / entry.path().filename());
    const auto built = sdk.build_project();
    ASSERT_EQ(built.status, 0) << built.output;

    start_machine();
    Child view(network_->in({(sdk.build() / "axis_positions").string(), "MINIMAL"}));
    ASSERT_TRUE(view.says("(off)", patience)) << view.text();
    move_axis();
    const auto shown = fmt::format("x={:.6f} mm", position());
    ASSERT_GT(position(), 1) << "it has moved";
    EXPECT_TRUE(view.says("\n" + shown, patience)) << shown << "\n" << view.text();
    EXPECT_THAT(view.text(), Not(HasSubstr("STALE " + shown)));
    machine_->signal(SIGKILL);
    EXPECT_TRUE(view.says("STALE " + shown, patience)) << view.text();

    if (!installed("python3") || !installed("lcm-gen")) return;
    machine_.reset();
    fs::remove(path("socket"));
    start_machine();
    const auto types = std::system(fmt::format("cd {} && lcm-gen -p --ppath . {}/share/taktwerk/lcm/*.lcm >/dev/null 2>&1",
                                               sdk.project().string(), sdk.prefix().string())
                                       .c_str());
    ASSERT_EQ(types, 0);
    Child python(network_->in({"python3", (sdk.project() / "axis_positions.py").string(), "MINIMAL"}));
    move_axis();
    const auto in_python = fmt::format("x={:.6f} mm", position());
    EXPECT_TRUE(python.says("\n" + in_python, patience)) << in_python << "\n" << python.text();
    machine_->signal(SIGKILL);
    EXPECT_TRUE(python.says("STALE " + in_python, patience)) << python.text();
}

TEST_F(Lcm, SpyShowsChannelsAndFields) {
    start_machine();
    const auto channels = command({"lcm", "spy", "--once", "--json"});
    ASSERT_EQ(channels.first, exit_ok) << channels.second;
    const auto table = json::parse(channels.second);
    std::map<std::string, json> rows;
    for (const auto& row : table["channels"]) rows[row["channel"]] = row;
    ASSERT_EQ(rows.count("TAKTWERK_MINIMAL_HEARTBEAT"), 1u) << channels.second;
    EXPECT_EQ(rows["TAKTWERK_MINIMAL_AXIS_STATE"]["type"], "axis_state_v1_t");
    // 100 Hz and 10 Hz by the configuration; a busy computer may be slower, never faster.
    EXPECT_GT(rows["TAKTWERK_MINIMAL_AXIS_STATE"]["rate_hz"], 20);
    EXPECT_LT(rows["TAKTWERK_MINIMAL_AXIS_STATE"]["rate_hz"], 120);
    EXPECT_LT(rows["TAKTWERK_MINIMAL_HEARTBEAT"]["rate_hz"], 12);
    EXPECT_EQ(table["machines"][0]["channels"], "TAKTWERK_MINIMAL_");

    const auto fields = command({"lcm", "spy", "TAKTWERK_MINIMAL_AXIS_STATE", "--once"});
    EXPECT_EQ(fields.first, exit_ok) << fields.second;
    EXPECT_THAT(fields.second, HasSubstr("\n  name: x\n"));
    EXPECT_THAT(fields.second, HasSubstr("\n  state: 0 DISABLED\n"));
    EXPECT_TRUE(std::regex_search(fields.second, std::regex("\n  set_velocity: 0 mm/s\n"))) << fields.second;

    EXPECT_EQ(command({"lcm", "spy", "NOBODY", "--once", "--for", "500ms"}).first, exit_no_runtime);
    EXPECT_EQ(command({"lcm", "spy", "(", "--once"}).first, exit_usage);
}

TEST_F(Lcm, WhatIsRecordedIsPlayedOnlyWhereNobodyLivesAndLcmsOwnToolsReadIt) {
    start_machine();
    const auto ours = path("ours.lcmlog");
    std::unique_ptr<Child> theirs;
    if (installed("lcm-logger"))
        theirs =
            std::make_unique<Child>(network_->in({"lcm-logger", "-q", "--lcm-url=udpm://239.255.76.67:7667?ttl=0", path("theirs.lcmlog")}));
    Child recorder(network_->in({taktwerk, "lcm", "record", ours}));
    ASSERT_TRUE(recorder.says("recording", patience)) << recorder.text();
    ::sleep(2);
    recorder.signal(SIGINT);
    ASSERT_EQ(recorder.wait(patience), exit_ok) << recorder.text();
    EXPECT_TRUE(std::regex_search(recorder.text(), std::regex("[0-9]+ messages of [0-9]+ channels, .* in "))) << recorder.text();
    EXPECT_THAT(recorder.text(), HasSubstr("TAKTWERK_MINIMAL_*: "));
    const auto channels = channels_of(ours);
    EXPECT_EQ(channels.count("TAKTWERK_MINIMAL_AXIS_STATE"), 1u);
    EXPECT_EQ(command({"lcm", "record", ours}).first, exit_bad_file) << "not written over";

    const auto live = command({"lcm", "play", ours, "--speed", "0"});
    EXPECT_EQ(live.first, exit_refused);
    EXPECT_THAT(live.second, HasSubstr("somebody publishes"));
    EXPECT_EQ(command({"lcm", "play", ours, "--url", "udpm://239.255.76.67:7667?ttl=1"}).first, exit_refused);

    machine_->signal(SIGKILL);
    machine_->wait(patience);
    Child listener(network_->in({taktwerk, "lcm", "spy", "TAKTWERK_MINIMAL_AXIS_STATE", "--once", "--json", "--for", "30s"}));
    const auto played = command({"lcm", "play", ours, "--speed", "2"});
    EXPECT_EQ(played.first, exit_ok) << played.second;
    EXPECT_THAT(played.second, HasSubstr(" played in "));
    EXPECT_EQ(listener.wait(patience), exit_ok) << listener.text();
    EXPECT_THAT(listener.text(), HasSubstr("\"name\":\"x\""));

    if (theirs) {
        theirs->signal(SIGINT);
        theirs->wait(patience);
        const auto file = fs::exists(path("theirs.lcmlog")) ? path("theirs.lcmlog") : path("theirs.lcmlog.00");
        EXPECT_EQ(channels_of(file).count("TAKTWERK_MINIMAL_AXIS_STATE"), 1u) << "lcm-logger's file";
        const auto spied = command({"lcm", "spy", "--file", file});
        EXPECT_THAT(spied.second, HasSubstr("axis_state_v1_t"));
    }
    if (installed("lcm-logplayer")) {
        Child hears(network_->in({taktwerk, "lcm", "spy", "TAKTWERK_MINIMAL_AXIS_STATE", "--once", "--for", "30s"}));
        Child player(network_->in({"lcm-logplayer", "-l", "udpm://239.255.76.67:7667?ttl=0", ours}));
        EXPECT_EQ(hears.wait(patience), exit_ok) << hears.text() << player.text();
        EXPECT_THAT(hears.text(), HasSubstr("name: x"));
    }
}

TEST_F(Lcm, WithoutARouteTheTwoCommandsAreNamed) {
    Child child({"unshare", "--user", "--map-root-user", "--net", taktwerk, "lcm", "spy", "--once"});
    EXPECT_EQ(child.wait(patience), exit_bus);
    EXPECT_THAT(child.text(), HasSubstr("ip link set lo multicast on"));
    EXPECT_THAT(child.text(), HasSubstr("ip route add 224.0.0.0/4 dev lo"));
}

}  // namespace
}  // namespace taktwerk::apps
