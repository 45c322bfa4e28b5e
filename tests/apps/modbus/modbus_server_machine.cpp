// A running machine as a Modbus TCP server: what libmodbus and mbpoll read and write, what they get when the cycle stands, and that no client holds
// up the end. Each test in a network of its own, with a loopback and nothing else.

#include <arpa/inet.h>
#include <fcntl.h>
#include <modbus/modbus.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/child.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

constexpr int port = 1502;

/// The thread's network; processes that it starts are in it, too. Only where the test's user may.
bool in_a_network_of_its_own() {
    if (::unshare(CLONE_NEWNET) != 0) return false;
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    request.ifr_flags = IFF_UP;
    const bool ok = ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    ::close(socket);
    return ok;
}

/// Runs `body` there. A thread, for the namespace is a thread's.
void apart(const std::function<void()>& body) {
    bool entered = false;
    std::thread{[&] {
        entered = in_a_network_of_its_own();
        if (entered) body();
    }}.join();
    if (!entered) GTEST_SKIP() << "network namespaces are not permitted here";
}

/// A machine file in a folder of its own, and the command that runs it.
class ServingMachine {
public:
    explicit ServingMachine(const std::string& text) {
        auto pattern = (fs::temp_directory_path() / "taktwerk-served-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        fs::create_directories(folder_ / "machines");
        for (const char* data : {"drives", "devices"})
            fs::create_directory_symlink(fs::path(TAKTWERK_SOURCE_DIR) / "config" / data, folder_ / data);
        file = (folder_ / "machines/served.yaml").string();
        std::ofstream(file) << text << "hmi: { socket: '" << (folder_ / "socket").string() << "', lcm: { enabled: false } }\n";
        run = std::make_unique<Child>(std::vector<std::string>{std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "run", file});
        EXPECT_TRUE(run->says("running, ", 60s)) << run->text();
        auto connected = hmi::Client::connect((folder_ / "socket").string());
        if (connected) client = std::make_unique<hmi::Client>(std::move(connected).value());
        EXPECT_TRUE(client) << run->text();
    }
    ~ServingMachine() {
        run.reset();
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    ServingMachine(const ServingMachine&) = delete;
    ServingMachine& operator=(const ServingMachine&) = delete;

    bool command(const Json& request) {
        const auto answer = client->request(request, 10s);
        if (!answer) ADD_FAILURE() << answer.error().text();
        return answer.ok();
    }
    Json state() {
        const auto answer = client->request({{"cmd", "state"}}, 10s);
        return answer ? (*answer)["state"] : Json{};
    }

    std::string file;
    std::unique_ptr<Child> run;
    std::unique_ptr<hmi::Client> client;

private:
    fs::path folder_;
};

/// The example, with a `max_age` that a busy computer keeps.
std::string example() {
    std::ostringstream text;
    text << std::ifstream(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/served-press.yaml").rdbuf();
    auto words = text.str();
    const std::string as_written = "max_age: 200 ms";
    return words.replace(words.find(as_written), as_written.size(), "max_age: 2 s");
}

/// libmodbus, as a visualisation uses it. What it returns is the answer's, or minus the exception's code.
class Visualisation {
public:
    Visualisation() : modbus_(::modbus_new_tcp("127.0.0.1", port)) {
        ::modbus_set_slave(modbus_, 1);
        ::modbus_set_response_timeout(modbus_, 5, 0);
        EXPECT_EQ(::modbus_connect(modbus_), 0) << ::modbus_strerror(errno);
    }
    ~Visualisation() {
        ::modbus_close(modbus_);
        ::modbus_free(modbus_);
    }
    Visualisation(const Visualisation&) = delete;
    Visualisation& operator=(const Visualisation&) = delete;

    std::vector<std::uint16_t> inputs(int address, int count) {
        std::vector<std::uint16_t> out(static_cast<std::size_t>(count));
        if (judge(::modbus_read_input_registers(modbus_, address, count, out.data())) != count) out.clear();
        return out;
    }
    int input(int address) {
        const auto words = inputs(address, 1);
        return words.empty() ? -exception : words[0];
    }
    std::uint32_t heartbeat() {
        const auto words = inputs(0, 2);
        return words.empty() ? 0 : static_cast<std::uint32_t>(words[0]) << 16 | words[1];
    }
    int coil(int address) {
        std::uint8_t bit = 0;
        return judge(::modbus_read_bits(modbus_, address, 1, &bit)) == 1 ? bit : -exception;
    }
    int holding(int address) {
        std::uint16_t word = 0;
        return judge(::modbus_read_registers(modbus_, address, 1, &word)) == 1 ? word : -exception;
    }
    int write_coil(int address, bool on) { return judge(::modbus_write_bit(modbus_, address, on ? 1 : 0)) == 1 ? 0 : exception; }
    int write_coils(int address, std::vector<std::uint8_t> bits) {
        const auto count = static_cast<int>(bits.size());
        return judge(::modbus_write_bits(modbus_, address, count, bits.data())) == count ? 0 : exception;
    }
    int write_holding(int address, std::uint16_t word) {
        return judge(::modbus_write_register(modbus_, address, word)) == 1 ? 0 : exception;
    }
    int write_holdings(int address, std::vector<std::uint16_t> words) {
        const auto count = static_cast<int>(words.size());
        return judge(::modbus_write_registers(modbus_, address, count, words.data())) == count ? 0 : exception;
    }
    /// Until `done`: what a command does comes a few cycles later.
    static bool until(const std::function<bool()>& done, std::chrono::milliseconds patience = 10s) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!done()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(5ms);
        }
        return true;
    }

    int exception = 0;  // of the last call; 99: it failed otherwise

private:
    int judge(int answer) {
        exception = answer >= 0 ? 0 : errno > MODBUS_ENOBASE && errno <= MODBUS_ENOBASE + 11 ? errno - MODBUS_ENOBASE : 99;
        return answer;
    }
    modbus_t* modbus_;
};

TEST(ModbusServerMachine, AVisualisationReadsWhatTheMachineIs) {
    apart([] {
        ServingMachine machine{example()};
        Visualisation view;
        const auto before = view.heartbeat();
        EXPECT_TRUE(Visualisation::until([&] { return view.heartbeat() > before + 20; }));
        EXPECT_EQ(view.input(8), 6000) << "6 bar, of 16 bar in 16000 steps";
        // A wake-up that this computer made late is an alarm as well, which goes by itself.
        EXPECT_TRUE(Visualisation::until([&] { return view.input(9) == 1; })) << "it is good, and no alarm stands: " << machine.run->text();
        EXPECT_EQ(view.input(2), 0) << "manual";
        EXPECT_TRUE(machine.command({{"cmd", "simulate"}, {"line", "input pressure 8bar"}}));
        EXPECT_TRUE(Visualisation::until([&] { return view.input(8) == 8000; }));
        EXPECT_TRUE(machine.command({{"cmd", "enable"}, {"axis", "x"}}));
        EXPECT_TRUE(Visualisation::until([&] { return view.input(3) == 1; })) << "Standstill: it has power";
        EXPECT_TRUE(machine.command({{"cmd", "home"}, {"axis", "x"}}));
        EXPECT_TRUE(Visualisation::until([&] { return machine.state()["axes"][0]["homed"] == true && view.input(3) == 1; }))
            << "Standstill";
        EXPECT_TRUE(machine.command({{"cmd", "move"}, {"axis", "x"}, {"position", 12.5}, {"velocity", 50}}));
        float position = 0;
        EXPECT_TRUE(Visualisation::until([&] {
            const auto words = view.inputs(4, 2);
            if (words.empty()) return false;
            position = ::modbus_get_float_abcd(words.data());
            return position > 12.49F;
        })) << position;
        EXPECT_LT(position, 12.51F);

        EXPECT_EQ(view.input(10), -2) << "nobody offers it";
        EXPECT_EQ(view.inputs(4, 1).size(), 0u);
        EXPECT_EQ(view.exception, 2) << "half a number";
        EXPECT_TRUE(view.inputs(0, 10).size() == 10) << "all at once";
        EXPECT_TRUE(view.inputs(0, 11).empty());
    });
}

TEST(ModbusServerMachine, AVisualisationWritesWhatAPersonMay) {
    apart([] {
        ServingMachine machine{example()};
        Visualisation other;
        {
            Visualisation view;
            EXPECT_EQ(view.write_coil(0, true), 0);
            EXPECT_EQ(view.write_holding(0, 455), 0);
            EXPECT_TRUE(Visualisation::until([&] { return other.coil(0) == 1 && other.holding(0) == 455; }));
            EXPECT_NEAR(machine.state()["outputs"]["valve"].get<double>(), 45.5, 0.01) << "per cent; the terminal has 32767 steps";
            EXPECT_EQ(view.write_coil(1, true), 2) << "read-only";
            EXPECT_EQ(view.write_coils(0, {1, 1}), 2) << "one of them is";
            EXPECT_EQ(view.write_holding(0, 2000), 3) << "200 %";
            EXPECT_EQ(view.write_holdings(0, {1, 2}), 2);
            EXPECT_EQ(other.holding(0), 455) << "as it was";

            EXPECT_TRUE(machine.command({{"cmd", "mode"}, {"mode", "automatic"}}));
            EXPECT_TRUE(Visualisation::until([&] { return other.input(2) == 2; }));
            EXPECT_EQ(other.coil(0), 0) << "what was set by hand is safe in another mode";
            EXPECT_EQ(view.write_coil(0, true), 4) << "not in automatic mode";
            EXPECT_TRUE(machine.command({{"cmd", "mode"}, {"mode", "manual"}}));
            EXPECT_TRUE(Visualisation::until([&] { return other.input(2) == 0; }));
            EXPECT_EQ(view.write_coil(0, true), 0);
            EXPECT_TRUE(Visualisation::until([&] { return other.coil(0) == 1; }));
        }
        EXPECT_TRUE(Visualisation::until([&] { return other.coil(0) == 0; })) << "it is gone, and the lamp with it";
        EXPECT_TRUE(machine.run->says("is gone: outputs that it was the last to set go to their safe values", 10s)) << machine.run->text();
        EXPECT_THAT(machine.run->text(), ContainsRegex("Modbus client 127.0.0.1:[0-9]+: set_output output lamp = 1"));
    });
}

/// mbpoll 1.4: "[8]: \t6000".
std::string polled(std::vector<std::string> words) {
    words.insert(words.begin(), {"mbpoll", "-m", "tcp", "-p", "1502", "-0", "-1"});
    Child child(std::move(words));
    child.wait(20s);
    return child.text();
}

TEST(ModbusServerMachine, MbpollReadsAndWrites) {
    apart([] {
        if (polled({"-h"}).find("usage") == std::string::npos) GTEST_SKIP() << "mbpoll is not installed";
        ServingMachine machine{example()};
        EXPECT_THAT(polled({"-t", "3", "-r", "8", "127.0.0.1"}), HasSubstr("[8]: \t6000"));
        EXPECT_THAT(polled({"-t", "3:float", "-B", "-r", "4", "127.0.0.1"}), ContainsRegex("\\[4\\]: \t-?[0-9.e-]+"));
        EXPECT_THAT(polled({"-t", "1", "-r", "0", "-c", "3", "127.0.0.1"}), HasSubstr("[0]: \t1\n[1]: \t0\n[2]: \t0"));
        EXPECT_THAT(polled({"-t", "4", "-r", "0", "127.0.0.1", "300"}), HasSubstr("Written 1 references"));
        EXPECT_TRUE(machine.run->says("set_output output valve = 30", 10s)) << machine.run->text();
        EXPECT_THAT(polled({"-t", "3", "-r", "10", "127.0.0.1"}), HasSubstr("Illegal data address"));
        EXPECT_THAT(polled({"-t", "4", "-r", "0", "127.0.0.1", "3000"}), HasSubstr("Illegal data value"));
        EXPECT_THAT(polled({"-a", "9", "-t", "3", "-r", "8", "127.0.0.1"}), HasSubstr("Target device failed to respond"));
    });
}

/// Program `p` moves x, and never comes back from its base task half a second after parameter `how` was 2.
std::string with_a_program_that_hangs() {
    return R"(version: 1
name: served
cycle: 2 ms
start_mode: automatic
bus:
  interface: simulated
  slaves:
    - { name: x_drive, profile: sv33-e }
axes:
  x:
    slave: x_drive
    unit: mm
    gearing: { counts_per_revolution: 131072, feed: 10 mm }
    limits: { velocity: 300 mm/s, acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }
    homing: { kind: set_here }
programs:
  p: { library: )" +
           std::string(TAKTWERK_BINARY_DIR) + R"(/tests/dying_program.so, autostart: true, parameters: { how: 0 } }
realtime: { lock_memory: false }
simulation: { supervision: relaxed }
modbus_server:
  listen: 127.0.0.1:1502
  max_age: 1 s
  points:
    heartbeat: { table: input, address: 0, type: uint32, machine: heartbeat }
    mode: { table: input, address: 2, machine: mode }
    how: { table: holding, address: 0, parameter: p.how, writable: true }
)";
}

TEST(ModbusServerMachine, AStandingCycleIsAnExceptionAndNoOldNumber) {
    apart([] {
        ServingMachine machine{with_a_program_that_hangs()};
        Visualisation view;
        const auto before = view.heartbeat();
        EXPECT_TRUE(Visualisation::until([&] { return view.heartbeat() > before; }));
        EXPECT_EQ(view.holding(0), 0);
        EXPECT_EQ(view.write_holding(0, 7), 3) << "beyond what the program takes";
        EXPECT_EQ(view.write_holding(0, 2), 0);
        // From here on the cycle may stand at any moment; when it does, no answer is older than 1 s.
        std::uint32_t last = view.heartbeat();
        auto moved = std::chrono::steady_clock::now();
        std::chrono::steady_clock::duration longest{};
        const bool stood = Visualisation::until(
            [&] {
                const auto beat = view.heartbeat();
                if (view.exception == 4) return true;
                EXPECT_EQ(view.exception, 0);
                const auto now = std::chrono::steady_clock::now();
                if (beat != last) moved = now;
                longest = std::max(longest, now - moved);
                last = beat;
                return false;
            },
            30s);
        EXPECT_TRUE(stood) << machine.run->text();
        EXPECT_LT(longest, 3s) << "1 s, and as late as this computer is";
        EXPECT_EQ(view.holding(0), -4);
        EXPECT_EQ(view.write_holding(0, 0), 4);
        EXPECT_EQ(view.input(9), -2) << "what it never had it does not have now";
        EXPECT_TRUE(machine.run->says("STUCK", 10s)) << machine.run->text();
    });
}

int raw_connection(bool small_buffer) {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int little = 2048;
    if (small_buffer) ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &little, sizeof little);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)!::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);  // at the end nobody listens any more
    ::fcntl(socket, F_SETFL, O_NONBLOCK);
    return socket;
}

// Seven hostile clients: half frames, answers that nobody reads, floods, other protocols, connections that come and go. The eighth is served, no cycle
// is missed because of them, and the run ends as soon as one without clients.
TEST(ModbusServerMachine, HostileClientsHoldUpNeitherTheOthersNorTheEnd) {
    apart([] {
        ServingMachine machine{example()};
        Visualisation view;
        EXPECT_EQ(view.input(8), 6000);
        std::atomic<bool> over{false};
        std::vector<int> sockets;
        for (int i = 0; i < 5; ++i) sockets.push_back(raw_connection(true));
        std::thread hostile{[&] {
            const std::uint8_t ask[] = {0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 10};
            const char http[] = "GET / HTTP/1.1\r\n\r\n";
            (void)!::send(sockets[0], ask, 7, MSG_NOSIGNAL);  // half a frame, and nothing more
            while (!over.load()) {
                for (std::size_t i = 1; i < sockets.size(); ++i) (void)!::send(sockets[i], ask, sizeof ask, MSG_NOSIGNAL);  // never read
                const int visitor = raw_connection(false);
                (void)!::send(visitor, http, sizeof http, MSG_NOSIGNAL);
                ::close(visitor);
            }
        }};
        int served = 0;
        for (const auto end = std::chrono::steady_clock::now() + 3s; std::chrono::steady_clock::now() < end;) {
            EXPECT_EQ(view.input(8), 6000);
            ++served;
        }
        EXPECT_GT(served, 100);
        EXPECT_EQ(machine.state()["phase"], "running");

        const auto told = std::chrono::steady_clock::now();
        machine.run->signal(SIGTERM);
        EXPECT_EQ(machine.run->wait(20s), exit_ok) << machine.run->text();
        EXPECT_LT(std::chrono::steady_clock::now() - told, 5s);
        over.store(true);
        hostile.join();
        for (const int socket : sockets) ::close(socket);
    });
}

// While axes ramp down and the bus goes, what is answered is live or exception 4; then the connection ends.
TEST(ModbusServerMachine, AtTheEndAClientHearsLiveValuesOrNone) {
    apart([] {
        ServingMachine machine{with_a_program_that_hangs()};
        Visualisation view;
        EXPECT_TRUE(Visualisation::until([&] { return view.heartbeat() > 100; }));
        machine.run->signal(SIGTERM);
        std::uint32_t last = 0;
        int live = 0;
        auto moved = std::chrono::steady_clock::now();
        const bool ended = Visualisation::until(
            [&] {
                const auto beat = view.heartbeat();
                if (view.exception == 99) return true;
                EXPECT_TRUE(view.exception == 0 || view.exception == 4) << view.exception;
                if (view.exception != 0) return false;
                ++live;
                EXPECT_GE(beat, last);
                const auto now = std::chrono::steady_clock::now();
                if (beat != last) moved = now;
                EXPECT_LT(now - moved, 3s) << "1 s, and as late as this computer is";
                last = beat;
                return false;
            },
            30s);
        EXPECT_TRUE(ended);
        EXPECT_GT(live, 0);
        EXPECT_EQ(machine.run->wait(20s), exit_ok) << machine.run->text();
    });
}

TEST(ModbusServerMachine, APortThatIsTakenIsSaidBeforeAnythingMoves) {
    apart([] {
        ServingMachine machine{example()};
        auto second = machine.file;
        second.replace(second.find("served.yaml"), 11, "second.yaml");
        std::ostringstream text;
        text << std::ifstream(machine.file).rdbuf();
        auto words = text.str();
        for (auto at = words.find("/socket"); at != std::string::npos; at = words.find("/socket", at + 8)) words.replace(at, 7, "/second");
        std::ofstream(second) << words;
        Child run({std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "run", second});
        EXPECT_EQ(run.wait(20s), exit_bad_file) << run.text();
        EXPECT_THAT(run.text(), HasSubstr("cannot listen at 127.0.0.1:1502"));
        EXPECT_THAT(run.text(), HasSubstr("another process listens there"));
    });
}

TEST(ModbusServerMachine, InVirtualTimeNobodyIsServedAndThatIsSaid) {
    Child run({std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "run",
               std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/served-press.yaml", "--virtual-time", "--duration", "2s"});
    EXPECT_EQ(run.wait(60s), exit_ok) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("no Modbus TCP client is served"));
}

TEST(ModbusServerMachine, CheckSaysWhatIsOfferedToWhom) {
    const std::string file = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/served-press.yaml";
    Child text({std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "check", file});
    EXPECT_EQ(text.wait(20s), exit_ok);
    EXPECT_THAT(
        text.text(),
        HasSubstr("14 values are offered over Modbus TCP at 127.0.0.1:1502, unit 1, to this computer alone; 2 of them may be written."));
    EXPECT_THAT(text.text(), ContainsRegex("input registers 4 and 5 +float32, high word first +x_position: axis x position, in mm\n"));
    EXPECT_THAT(text.text(),
                ContainsRegex("holding register 0 +uint16 +valve: output valve, 1 in the register is 0.1 %; MAY BE WRITTEN\n"));
    EXPECT_THAT(text.text(), ContainsRegex("bit 1 of input register 9 +bool +alarm: alarm\n"));

    Child json({std::string(TAKTWERK_BINARY_DIR) + "/taktwerk", "check", "--json", file});
    EXPECT_EQ(json.wait(20s), exit_ok);
    const auto said = Json::parse(json.text(), nullptr, false);
    ASSERT_TRUE(said.is_object()) << json.text();
    const auto& server = said["modbus_server"];
    EXPECT_EQ(server["listen"], "127.0.0.1:1502");
    EXPECT_EQ(server["reach"], "this computer alone");
    ASSERT_EQ(server["points"].size(), 14u);
    const auto& valve = server["points"][5];
    EXPECT_EQ(valve["name"], "valve");
    EXPECT_EQ(valve["table"], "holding");
    EXPECT_EQ(valve["address"], 0);
    EXPECT_EQ(valve["unit"], "%");
    EXPECT_EQ(valve["factor"], 10);
    EXPECT_EQ(valve["writable"], true);
}

}  // namespace
}  // namespace taktwerk::apps
