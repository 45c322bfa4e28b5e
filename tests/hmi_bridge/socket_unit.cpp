// The local socket with real sockets: server, client, and what broken or rude clients get. The client blocks, so the bridge steps
// on a thread beside it; nothing here depends on how fast either is.
#include "hmi_bridge/socket/client.hpp"

#include <gmock/gmock.h>
#include <grp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/socket/socket_path.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/patience.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::Answer;
using test::FakeMachine;
using testing::HasSubstr;

/// A folder of its own, gone afterwards.
class Folder {
public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string file(const char* name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

HmiConfig config_at(const std::string& socket) {
    HmiConfig config;
    config.lcm = false;
    config.socket = socket;
    return config;
}

/// Accepts everything, and steps the bridge until it is destroyed.
class AnsweringMachine final : public MachineLink {
public:
    bool submit(const runtime::OperatorCommand& command) override {
        fake.submit(command);
        fake.answer(Answer::accepted);
        return true;
    }
    std::optional<runtime::CommandAnswer> next_answer() override { return fake.next_answer(); }
    const runtime::Snapshot* latest() override { return fake.latest(); }
    [[nodiscard]] const runtime::MachineLayout& layout() const override { return fake.layout(); }
    [[nodiscard]] runtime::AlarmText describe(const AlarmFact& fact) const override { return fake.describe(fact); }
    [[nodiscard]] Drive drive(std::uint16_t axis) override { return fake.drive(axis); }
    runtime::StopLevels::Ticket request_stop(std::uint16_t axis) override { return fake.request_stop(axis); }
    runtime::StopLevels::Ticket release_jog(std::uint16_t axis) override { return fake.release_jog(axis); }
    runtime::StopLevels::Ticket request_shutdown() override { return fake.request_shutdown(); }
    [[nodiscard]] bool taken(runtime::StopLevels::Ticket ticket) const override { return fake.taken(ticket); }
    [[nodiscard]] std::uint64_t levels_raised() const override { return fake.levels_raised(); }
    [[nodiscard]] std::optional<std::string> stuck() const override { return fake.stuck(); }
    FakeMachine fake;
};

class SocketTest : public testing::Test {
protected:
    SocketTest() {
        auto opened =
            HmiBridge::open(config_at(path), machine,
                            {.log = [this](std::string_view line) { log.emplace_back(line); }, .wall_utime = wall_utime, .bus = nullptr});
        EXPECT_TRUE(opened) << opened.error().text();
        bridge = std::move(opened).value();
    }
    ~SocketTest() override { stop(); }

    void serve() {
        server = std::thread([this] {
            while (!ended.load()) {
                bridge->step(now += 5ms);
                std::this_thread::yield();
            }
        });
    }
    void stop() {
        ended = true;
        if (server.joinable()) server.join();
    }
    /// A client that does as it likes.
    int raw_client() const {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        return socket;
    }
    static std::string read_now(int socket) {
        std::string all(1 << 20, '\0');
        const auto got = ::recv(socket, all.data(), all.size(), MSG_DONTWAIT);
        all.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return all;
    }
    static bool closed(int socket) {
        char byte = 0;
        return ::recv(socket, &byte, 1, MSG_DONTWAIT) == 0;
    }
    void send_all(int socket, std::string_view text) {
        for (Patience patience{1'000'000}; patience.lasts(!text.empty());) {
            const auto sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent > 0) text.remove_prefix(static_cast<std::size_t>(sent));
            else if (errno != EAGAIN) return;
            bridge->step(now += 5ms);
        }
    }

    Folder folder;
    std::string path = folder.file("demo.sock");
    AnsweringMachine machine;
    std::vector<std::string> log;
    std::unique_ptr<HmiBridge> bridge;
    Instant now{1s};
    std::thread server;
    std::atomic<bool> ended{false};
};

TEST_F(SocketTest, AClientCommandsAndReadsTheState) {
    serve();
    auto client = Client::connect(path);
    ASSERT_TRUE(client) << client.error().text();

    const auto pressed = client->request({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 20}, {"press", true}});
    const auto state = client->request({{"cmd", "state"}});
    const auto wrong = client->request({{"cmd", "home"}, {"axis", "turet"}});

    EXPECT_TRUE(pressed) << pressed.error().text();
    ASSERT_TRUE(state) << state.error().text();
    EXPECT_EQ((*state)["state"]["axes"][0]["name"], "x");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, "command.unknown_name");
    EXPECT_THAT(wrong.error().remedy, HasSubstr("turret"));
}

TEST_F(SocketTest, AClientThatGoesAwayWhileJoggingStopsItsAxis) {
    serve();
    {
        auto client = Client::connect(path);
        ASSERT_TRUE(client);
        ASSERT_TRUE(client->request({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 20}, {"press", true}}));
    }
    auto witness = Client::connect(path);
    ASSERT_TRUE(witness);
    // Two answered rounds after the close: the server has seen it.
    ASSERT_TRUE(witness->request({{"cmd", "hello"}}));
    ASSERT_TRUE(witness->request({{"cmd", "hello"}}));
    stop();

    EXPECT_THAT(machine.fake.releases, testing::Contains(0));
}

TEST_F(SocketTest, TheSocketIsForItsUserAndGroupAndPeersAreLogged) {
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0660u);

    const int socket = raw_client();
    bridge->step(now);

    EXPECT_THAT(log.back(), ::testing::StartsWith("command socket: process " + std::to_string(::getpid()) + " ("));
    EXPECT_THAT(log.back(), ::testing::EndsWith(") of user " + std::to_string(::getuid()) + " connected"));
    ::close(socket);
}

TEST_F(SocketTest, TheGroupOfTheConfigurationMayConnectAndTheLogSaysWho) {
    const auto* someone = ::getgrgid(::getgid());
    ASSERT_NE(someone, nullptr);
    auto config = config_at(folder.file("grouped.sock"));
    config.socket_group = someone->gr_name;
    FakeMachine other;
    std::vector<std::string> said;
    const auto grouped = HmiBridge::open(config, other, {.log = [&](std::string_view line) { said.emplace_back(line); }, .bus = nullptr});
    ASSERT_TRUE(grouped) << grouped.error().text();
    struct stat info {};
    ASSERT_EQ(::stat(config.socket.c_str(), &info), 0);
    EXPECT_EQ(info.st_gid, someone->gr_gid);
    EXPECT_EQ(info.st_mode & 0777, 0660u);
    EXPECT_THAT(said, testing::Contains(HasSubstr("group '" + config.socket_group + "'")));
    ASSERT_EQ(::stat((config.socket + ".lock").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 077, 0u) << "who can open the lock can hold it, and nobody could start";

    config.socket = folder.file("nowhere.sock");
    config.socket_group = "no-such-group-here";
    const auto refused = HmiBridge::open(config, other, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "socket.group");
}

// Everybody may make folders in /tmp: one with this user's number holds up nobody.
TEST_F(SocketTest, AFolderThatSomebodyElseHasMadeInTmpHoldsNobodyUp) {
    if (::geteuid() != 0) GTEST_SKIP() << "it takes two users";
    constexpr uid_t user = 64001, other_user = 64002;
    const std::string taken = "/tmp/taktwerk-" + std::to_string(user);
    std::filesystem::remove_all(taken);
    ASSERT_EQ(::mkdir(taken.c_str(), 0755), 0);
    ASSERT_EQ(::chown(taken.c_str(), other_user, other_user), 0);
    ::unsetenv("XDG_RUNTIME_DIR");
    ASSERT_EQ(::seteuid(user), 0);
    const auto made = make_socket_path("cell");
    const auto folders = socket_folders();
    ASSERT_EQ(::seteuid(0), 0);

    ASSERT_TRUE(made) << made.error().text();
    EXPECT_THAT(*made, testing::StartsWith(taken + "-"));
    EXPECT_THAT(folders, testing::Contains(std::filesystem::path(*made).parent_path().string())) << "commands look there, too";
    EXPECT_THAT(folders, testing::Not(testing::Contains(taken))) << "and not where somebody else could pretend to be the machine";
    std::filesystem::remove_all(taken);
    std::filesystem::remove_all(std::filesystem::path(*made).parent_path());
}

TEST_F(SocketTest, ASecondRuntimeIsToldWhoHasTheSocket) {
    FakeMachine other;
    const auto second = HmiBridge::open(config_at(path), other, {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, "socket.in_use");
    EXPECT_THAT(second.error().what, HasSubstr(std::to_string(::getpid())));
}

TEST_F(SocketTest, ASocketLeftBehindByADeadRuntimeIsReplaced) {
    const auto left = folder.file("left.sock");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    left.copy(address.sun_path, sizeof address.sun_path - 1);
    const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(dead);

    const auto refused = Client::connect(left);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "socket.no_runtime");

    FakeMachine other;
    EXPECT_TRUE(HmiBridge::open(config_at(left), other, {}));
    EXPECT_FALSE(std::filesystem::exists(left)) << "removed at the end";
}

TEST_F(SocketTest, AFileThatIsNoSocketIsLeftAlone) {
    const auto file = folder.file("letter.txt");
    {
        const auto written = ::fopen(file.c_str(), "w");
        ::fclose(written);
    }
    FakeMachine other;
    const auto opened = HmiBridge::open(config_at(file), other, {});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, "socket.not_a_socket");
    EXPECT_TRUE(std::filesystem::exists(file));
    EXPECT_EQ(HmiBridge::open(config_at(folder.file("none/x.sock")), other, {}).error().code, "socket.bind");
    EXPECT_EQ(HmiBridge::open(config_at("/" + std::string(120, 'x')), other, {}).error().code, "hmi.socket_too_long");
}

TEST_F(SocketTest, WithoutARuntimeTheClientSaysHowToStartOne) {
    const auto client = Client::connect(folder.file("nobody.sock"));
    ASSERT_FALSE(client);
    EXPECT_EQ(client.error().code, "socket.no_runtime");
    EXPECT_THAT(client.error().remedy, HasSubstr("taktwerk run"));
    EXPECT_EQ(Client::connect("no-such-machine-here").error().code, "socket.not_found");
}

TEST_F(SocketTest, AMachineIsFoundByItsNameOrBecauseItIsTheOnlyOne) {
    ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
    const auto home = folder.file("taktwerk");
    std::filesystem::create_directory(home);
    const auto only = home + "/only-one-of-this-test.sock";
    FakeMachine a;
    const auto first = HmiBridge::open(config_at(only), a, {});
    ASSERT_TRUE(first) << first.error().text();
    // One that was killed: its socket is there, its lock is not.
    ASSERT_EQ(::mknod((home + "/killed.sock").c_str(), S_IFSOCK | 0660, 0), 0);

    EXPECT_EQ(*find_socket("only-one-of-this-test"), only);
    EXPECT_EQ(*find_socket("/any/path"), "/any/path");
    bool elsewhere = false;  // a runtime of somebody else on this computer
    for (const auto& place : socket_folders())
        elsewhere = elsewhere || (place != home && std::filesystem::exists(place) && !std::filesystem::is_empty(place));
    if (!elsewhere) {
        const auto found = find_socket("");
        ASSERT_TRUE(found) << found.error().text();
        EXPECT_EQ(*found, only);
        FakeMachine b;
        const auto second = HmiBridge::open(config_at(home + "/second.sock"), b, {});
        ASSERT_TRUE(second);
        EXPECT_EQ(find_socket("").error().code, "socket.ambiguous");
    }
    ::unsetenv("XDG_RUNTIME_DIR");
}

TEST_F(SocketTest, ARuntimeThatDoesNotAnswerTimesOut) {
    auto client = Client::connect(path);  // nobody steps the bridge
    ASSERT_TRUE(client);
    EXPECT_EQ(client->request({{"cmd", "state"}}, 20ms).error().code, "socket.timeout");
}

TEST_F(SocketTest, ARuntimeThatEndsIsNoticed) {
    auto client = Client::connect(path);
    ASSERT_TRUE(client);
    bridge->step(now);
    bridge.reset();
    EXPECT_EQ(client->request({{"cmd", "state"}}).error().code, "socket.closed");
}

TEST_F(SocketTest, LinesComeInPiecesAndSeveralAtOnce) {
    const int socket = raw_client();
    send_all(socket, R"({"id":1,"cmd":)");
    bridge->step(now);
    EXPECT_EQ(read_now(socket), "");
    send_all(socket, "\"acknowledge\"}\r\n\n{\"id\":2,\"cmd\":\"acknowledge\"}\n{\"id\":3,\"cm");
    bridge->step(now);
    bridge->step(now);
    EXPECT_EQ(read_now(socket), "{\"id\":1,\"ok\":true}\n{\"id\":2,\"ok\":true}\n");
    ::close(socket);
    bridge->step(now);
    EXPECT_EQ(machine.fake.submitted.size(), 2u) << "half a line at the end is nobody's request";
}

TEST_F(SocketTest, AHugeLineIsRefusedOnceAndTheConnectionStays) {
    const int socket = raw_client();
    for (int i = 0; i < 3; ++i) {
        send_all(socket, std::string(SocketServer::max_line + 1000, 'x'));
        bridge->step(now);
        bridge->step(now);
        EXPECT_EQ(read_now(socket).find("request.too_long") != std::string::npos, i == 0);
    }
    EXPECT_EQ(read_now(socket), "");
    send_all(socket, "\n{\"id\":1,\"cmd\":\"acknowledge\"}\n");
    bridge->step(now);
    bridge->step(now);
    EXPECT_EQ(read_now(socket), "{\"id\":1,\"ok\":true}\n");
    ::close(socket);
}

TEST_F(SocketTest, ALineOfTheGreatestLengthIsStillRead) {
    const int socket = raw_client();
    const std::string request = R"({"cmd":"hello"})";
    send_all(socket, request + std::string(SocketServer::max_line - request.size(), ' ') + "\n");
    bridge->step(now);
    EXPECT_THAT(read_now(socket), HasSubstr("protocol_version"));
    ::close(socket);
}

TEST_F(SocketTest, BinaryRubbishGetsAnErrorAndTheNextLineIsServed) {
    const int socket = raw_client();
    std::string rubbish;
    for (int i = 1; i < 256; ++i)
        if (i != '\n') rubbish += static_cast<char>(i);
    send_all(socket, rubbish + "\n{\"id\":1,\"cmd\":\"acknowledge\"}\n");
    bridge->step(now);
    bridge->step(now);
    const auto answer = read_now(socket);
    EXPECT_THAT(answer, HasSubstr("request.not_json"));
    EXPECT_THAT(answer, HasSubstr("{\"id\":1,\"ok\":true}\n"));
    ::close(socket);
}

TEST_F(SocketTest, ClientsAreBounded) {
    std::vector<int> sockets;
    for (std::size_t i = 0; i < SocketServer::max_connections; ++i) {
        sockets.push_back(raw_client());
        bridge->step(now);
    }
    const int ninth = raw_client();
    bridge->step(now);
    EXPECT_FALSE(closed(ninth)) << "it may stop and shut down";
    send_all(ninth, "{\"cmd\":\"hello\"}\n");
    bridge->step(now);
    EXPECT_THAT(read_now(ninth), HasSubstr("socket.too_many_clients"));
    bridge->step(now += SocketServer::reserve_stay + 1ms);
    EXPECT_TRUE(closed(ninth)) << "its place is for the next one";

    ::close(sockets.back());
    bridge->step(now);
    sockets.back() = raw_client();
    send_all(sockets.back(), "{\"cmd\":\"hello\"}\n");
    bridge->step(now);
    bridge->step(now);
    EXPECT_THAT(read_now(sockets.back()), HasSubstr("protocol_version"));
    ::close(ninth);
    for (const int socket : sockets) ::close(socket);
}

TEST_F(SocketTest, AClientThatNeverReadsIsDroppedAndTheOthersAreServed) {
    const int deaf = raw_client();
    for (int i = 0; i < 200'000 && bridge &&
                    std::none_of(log.begin(), log.end(), [](const auto& l) { return l.find("does not read") != std::string::npos; });
         ++i) {
        constexpr std::string_view ask = "{\"cmd\":\"state\"}\n";
        [[maybe_unused]] const auto sent = ::send(deaf, ask.data(), ask.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        bridge->step(now += 5ms);
    }
    EXPECT_THAT(log.back(), HasSubstr("does not read"));
    const int good = raw_client();
    send_all(good, "{\"cmd\":\"hello\"}\n");
    bridge->step(now);
    bridge->step(now);
    EXPECT_THAT(read_now(good), HasSubstr("protocol_version"));
    ::close(deaf);
    ::close(good);
}

}  // namespace
}  // namespace taktwerk::hmi
