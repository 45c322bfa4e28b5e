// The built command with every thread that it has, and something to do for each: cycle, slower task, service, door, programs, disk (positions),
// files (trace, capture), output, watch, Modbus server. Its worth is under the thread sanitizer (preset tsan), which ends a run in which two of them meet
// without order with a code of its own. All waits are bounded, and wide.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/child.hpp"
#include "tests/modbus/server/raw_client.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class Folder {
public:
    Folder() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-threads-XXXXXX").string();
        path = ::mkdtemp(pattern.data());
        fs::create_directories(path / "machines");
        fs::create_directory_symlink(fs::path(TAKTWERK_SOURCE_DIR) / "config/drives", path / "drives");
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string at(const std::string& name) const { return (path / name).string(); }
    fs::path path;
};

/// One that nobody listens at: it was free just now.
std::uint16_t free_port() {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), length), 0);
    EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length), 0);
    ::close(socket);
    return ntohs(address.sin_port);
}

/// Program `p` moves x in its slower task, the operator has y.
std::string machine(const Folder& folder, std::uint16_t modbus_port) {
    auto file = folder.at("machines/threads.yaml");
    std::ofstream(file) << R"(version: 1
name: threads
cycle: 4 ms
bus:
  interface: simulated
  slaves:
    - { name: x_drive, profile: sv33-e }
    - { name: y_drive, profile: sv33-e }
axes:
  x:
    slave: x_drive
    unit: mm
    gearing: &gearing { counts_per_revolution: 131072, feed: 10 mm }
    limits: &limits { velocity: 300 mm/s, acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }
    homing: { kind: set_here }
    position_memory: { absolute: true }
  y: { slave: y_drive, unit: mm, gearing: *gearing, limits: *limits, homing: { kind: set_here } }
realtime: { lock_memory: false }
simulation: { supervision: relaxed }
hmi: { socket: ')" << folder.at("socket")
                        << R"(', lcm: { enabled: false } }
modbus_server:
  listen: 127.0.0.1:)" << modbus_port
                        << R"(
  points:
    heartbeat: { table: input, address: 0, type: uint32, machine: heartbeat }
    x: { table: input, address: 2, type: float32, axis: x, shows: position }
    how: { table: holding, address: 0, parameter: p.how, writable: true }
programs:
  p:
    library: )" << TAKTWERK_BINARY_DIR
                        << R"(/tests/dying_program.so
    autostart: true
    parameters: { how: 0 }
    tasks:
      main: { every: 2 cycles }
)";
    return file;
}

TEST(WholeRun, EveryThreadHasSomethingToDoAndTheRunEndsInOrder) {
    const Folder folder;
    const auto port = free_port();
    Child run({std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "run", machine(folder, port), "--trace", folder.at("trace.csv"), "--pcap",
               folder.at("frames.pcap"), "--retain", folder.at("kept")});
    ASSERT_TRUE(run.says("commands are taken", 60s)) << run.text();
    auto first = hmi::Client::connect(folder.at("socket")), second = hmi::Client::connect(folder.at("socket"));
    ASSERT_TRUE(first && second) << run.text();

    bool running = false;
    for (int look = 0; look < 600 && !running; ++look) {
        const auto state = first->request({{"cmd", "state"}}, 10s);
        running = state && (*state)["state"]["phase"] == "running";
        if (!running) run.says("(not said)", 100ms);
    }
    ASSERT_TRUE(running) << run.text();
    // What is refused is as good: what counts is that each thread is asked while the others work.
    using modbus::server::testing::framed;
    modbus::server::testing::RawClient reader{port}, writer{port};
    std::size_t read = 0, written = 0;
    int answered = 0;
    const auto ask = [&](hmi::Client& client, nlohmann::json request) {
        const auto answer = client.request(std::move(request), 10s);
        answered += answer || !answer.error().code.starts_with("socket.");
    };
    constexpr int rounds = 12, asked_a_round = 14;
    for (int round = 0; round < rounds; ++round) {
        reader.send(framed({4, 0, 0, 0, 4}));
        writer.send(framed({6, 0, 0, 0, 0}));
        ask(*first, {{"cmd", "enable"}, {"axis", "y"}});
        ask(*first, {{"cmd", "home"}, {"axis", "y"}});
        ask(*second, {{"cmd", "state"}});
        ask(*first, {{"cmd", "jog"}, {"axis", "y"}, {"velocity", 5}, {"press", true}});
        ask(*second, {{"cmd", "stop"}, {"axis", "y"}});
        ask(*first, {{"cmd", "jog"}, {"axis", "y"}, {"velocity", 0}});
        ask(*second, {{"cmd", "simulate"}, {"line", "duplicate 1"}});
        ask(*first, {{"cmd", "drive_read"}, {"axis", "y"}, {"parameter", "6084h"}});
        ask(*second, {{"cmd", "set_parameter"}, {"parameter", "p.how"}, {"value", 0}});
        ask(*second, {{"cmd", round % 3 == 2 ? "program_stop" : "program_start"}, {"program", "p"}});
        ask(*first, {{"cmd", "acknowledge"}});
        ask(*second, {{"cmd", "mode"}, {"mode", round < rounds / 2 ? "manual" : "automatic"}});
        ask(*first, {{"cmd", "nonsense"}});
        ask(*second, {{"cmd", "reset"}});
        run.says("(not said)", 150ms);
        read += reader.take().size();
        written += writer.take().size();
    }
    EXPECT_GT(read, 0u);
    EXPECT_GT(written, 0u);
    EXPECT_EQ(answered, rounds * asked_a_round);
    run.signal(SIGTERM);

    EXPECT_EQ(run.wait(60s), exit_ok) << run.text();
    EXPECT_THAT(run.text(), ::testing::Not(::testing::HasSubstr("ThreadSanitizer")));
    EXPECT_THAT(run.text(), ::testing::HasSubstr("axes stop along their ramps"));
    EXPECT_THAT(run.text(), ::testing::HasSubstr("p running"));
    EXPECT_GT(fs::file_size(folder.at("trace.csv")), 1000u);
    EXPECT_GT(fs::file_size(folder.at("frames.pcap")), 1000u);
    EXPECT_TRUE(fs::is_directory(folder.at("kept")) && !fs::is_empty(folder.at("kept")));
}

}  // namespace
}  // namespace taktwerk::apps
