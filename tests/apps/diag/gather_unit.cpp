// What goes into the file of a machine that does not run.
#include "apps/diag/gather.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Gathering : ::testing::Test {
    Gathering() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-diag-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        ::setenv("STATE_DIRECTORY", (folder / "state").c_str(), 1);
        fs::create_directories(folder / "state/recordings");
    }
    ~Gathering() override {
        ::unsetenv("STATE_DIRECTORY");
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    void write(const std::string& path, const std::string& text) const { std::ofstream(folder / path, std::ios::binary) << text; }
    [[nodiscard]] const DiagPart* part(const std::string& path) const {
        const auto found = std::find_if(all.parts.begin(), all.parts.end(), [&](const auto& p) { return p.path == path; });
        return found == all.parts.end() ? nullptr : &*found;
    }
    fs::path folder;
    Gathered all;
};

TEST_F(Gathering, AFileThatIsWrongIsPackedWithWhatIsWrong) {
    write("cell.yaml", "machine: cell\npassword: hunter2\n");
    gather_files(all, (folder / "cell.yaml").string(), true);
    ASSERT_NE(part("machine/cell.yaml"), nullptr);
    EXPECT_THAT(part("machine/cell.yaml")->bytes, Not(HasSubstr("hunter2")));
    EXPECT_THAT(part("machine/cell.yaml")->masked, Contains("line 2: password"));
    ASSERT_NE(part("machine/problems.txt"), nullptr);
    EXPECT_THAT(part("machine/problems.txt")->bytes, HasSubstr("password"));
    EXPECT_THAT(part("machine/problems.txt")->bytes, Not(HasSubstr("hunter2")));
}

// The key of a secret may stand before the cut, and the secret behind it.
TEST_F(Gathering, ATextIsMaskedBeforeItIsCut) {
    std::string text = "start: 1\n" + std::string("secret: |\n");
    const auto line = "  hunter2 " + std::string(90, 'x') + "\n";
    while (text.size() < most_text_bytes + 10'000) text += line;
    add_text(all, "log.txt", "a log", text + "end: 1\n");
    ASSERT_EQ(all.parts.size(), 1u);
    EXPECT_THAT(all.parts[0].bytes, Not(HasSubstr("hunter2")));
    EXPECT_THAT(all.parts[0].bytes, HasSubstr("end: 1"));

    std::string noise;
    while (noise.size() < most_text_bytes + 10'000) noise += "line of a log\n";
    add_text(all, "long.txt", "a log", noise);
    EXPECT_LE(all.parts[1].bytes.size(), most_text_bytes) << "the control: it is cut";
    EXPECT_THAT(all.parts[1].about, HasSubstr("its last 4 MB"));
}

TEST_F(Gathering, TwoFilesOfOneNameAreTwoParts) {
    add_text(all, "machine/x.yaml", "one", "1\n");
    add_text(all, "machine/x.yaml", "two", "2\n");
    add_text(all, "machine/x.yaml", "three", "3\n");
    EXPECT_EQ(part("machine/x.yaml")->bytes, "1\n");
    ASSERT_NE(part("machine/x.2.yaml"), nullptr);
    EXPECT_EQ(part("machine/x.2.yaml")->bytes, "2\n");
    EXPECT_EQ(part("machine/x.3.yaml")->bytes, "3\n");
}

TEST_F(Gathering, ReasonsAreMaskedToo) {
    all.missing = {"log: mqtt://plc:hunter2@broker does not answer", "cell.yaml: password: hunter2"};
    mask_reasons(all);
    for (const auto& reason : all.missing) EXPECT_THAT(reason, Not(HasSubstr("hunter2")));
    EXPECT_THAT(all.missing[0], HasSubstr("does not answer"));
}

// A pipe would never end, and a folder is no text.
TEST_F(Gathering, WhatIsNoFileIsSaidAndHoldsNobodyUp) {
    ASSERT_EQ(::mkfifo((folder / "pipe.yaml").c_str(), 0600), 0);
    for (const auto& path : {folder / "pipe.yaml", folder}) {
        all = {};
        gather_files(all, path.string(), true);
        EXPECT_THAT(all.parts, IsEmpty()) << path;
        EXPECT_THAT(all.missing, Contains(HasSubstr("cannot be read"))) << path;
    }
}

TEST_F(Gathering, OneThatIsNotThereIsSaid) {
    gather_files(all, (folder / "none.yaml").string(), true);
    EXPECT_THAT(all.parts, IsEmpty());
    EXPECT_THAT(all.missing, Contains(HasSubstr("none.yaml: cannot be read")));
}

TEST_F(Gathering, TheMachineWithItsDriveFilesAndTheNewestRecordingsOfItsOwn) {
    all.machine = "five-drives";
    for (int i = 0; i < 7; ++i)
        write("state/recordings/five_drives-2026112" + std::to_string(i) + "T101500.000-drive_fault.twscope",
              std::string(10, static_cast<char>('0' + i)));
    write("state/recordings/other-20261129T101500.000-drive_fault.twscope", "not its own");
    write("state/five-drives.alarms.sqlite", "history");
    gather_files(all, std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/five-drives.yaml", false);
    EXPECT_NE(part("machine/five-drives.yaml"), nullptr);
    EXPECT_NE(part("machine/xp200.yaml"), nullptr) << "a drive file that it names";
    EXPECT_EQ(part("machine/problems.txt"), nullptr);
    std::vector<std::string> recordings;
    for (const auto& p : all.parts)
        if (p.path.starts_with("recordings/")) recordings.push_back(p.bytes);
    EXPECT_THAT(recordings, ::testing::ElementsAre(std::string(10, '6'), std::string(10, '5'), std::string(10, '4'), std::string(10, '3'),
                                                   std::string(10, '2')));
}

TEST_F(Gathering, ALogThatGrewKeepsItsEnd) {
    std::string log;
    while (log.size() < most_text_bytes + 100) log += "a line of the log that is forty bytes\n";
    log += "the last\n";
    add_text(all, "log", "log", log);
    EXPECT_LE(all.parts[0].bytes.size(), most_text_bytes);
    EXPECT_TRUE(all.parts[0].bytes.starts_with("a line"));
    EXPECT_TRUE(all.parts[0].bytes.ends_with("the last\n"));
    EXPECT_THAT(all.parts[0].about, HasSubstr("its last"));
}

TEST_F(Gathering, TheHostHasVersionsAndTheDoctor) {
    gather_host(all, "");
    for (const auto* path : {"host/versions.txt", "host/doctor.txt", "host/doctor.json", "host/cmdline.txt"}) {
        ASSERT_NE(part(path), nullptr) << path;
        EXPECT_FALSE(part(path)->bytes.empty()) << path;
    }
    EXPECT_THAT(part("host/versions.txt")->bytes, HasSubstr("taktwerk"));
}

/// A runtime's side of the socket: one client, an answer a line.
class FakeRuntime {
public:
    using Answer = std::function<nlohmann::json(const nlohmann::json&)>;
    FakeRuntime(const std::string& path, Answer answer)
        : listening_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)), answer_(std::move(answer)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        EXPECT_EQ(::bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(::listen(listening_, 1), 0);
        thread_ = std::thread{[this] { serve(); }};
    }
    ~FakeRuntime() {
        ::shutdown(listening_, SHUT_RDWR);
        thread_.join();
        ::close(listening_);
    }

private:
    void serve() {
        const int client = ::accept(listening_, nullptr, nullptr);
        std::string in;
        char some[4096];
        for (ssize_t got = 0; client >= 0 && (got = ::read(client, some, sizeof some)) > 0;) {
            in.append(some, static_cast<std::size_t>(got));
            for (auto end = in.find('\n'); end != std::string::npos; end = in.find('\n')) {
                const auto request = nlohmann::json::parse(in.substr(0, end));
                in.erase(0, end + 1);
                auto reply = answer_(request);
                reply["id"] = request["id"];
                if (!reply.contains("ok")) reply["ok"] = true;
                const auto line = reply.dump() + "\n";
                if (::write(client, line.data(), line.size()) < 0) break;
            }
        }
        if (client >= 0) ::close(client);
    }

    int listening_;
    Answer answer_;
    std::thread thread_;
};

// Seven recordings, each in two pieces; a log of two pages; what the machine refuses is said and nothing else is lost by it.
TEST_F(Gathering, EverythingThatARunningMachineTells) {
    const FakeRuntime runtime{
        (folder / "cell.sock").string(), [](const nlohmann::json& request) -> nlohmann::json {
            const auto cmd = request["cmd"].get<std::string>();
            if (cmd == "bus")
                return {{"ok", false}, {"error", {{"code", "state.not_yet"}, {"subject", ""}, {"what", "no cycle yet"}, {"remedy", ""}}}};
            if (cmd == "state") return {{"state", {{"machine", "cell"}, {"api_token", "hunter2"}}}};
            if (cmd == "log") {
                const auto after = request["after"].get<int>();
                if (after == 0) return {{"log", {{"last", 2}, {"lines", {{{"number", 1}, {"text", "first"}}}}}}};
                return {{"log", {{"last", 2}, {"lines", {{{"number", 2}, {"text", "second"}}}}}}};
            }
            if (cmd == "recordings") {
                auto list = nlohmann::json::array();
                for (int i = 7; i > 0; --i)
                    list.push_back({{"name", "cell-" + std::to_string(i)}, {"alarm", "drive_fault"}, {"source", "axis x"}, {"bytes", 5}});
                return {{"recordings", list}};
            }
            if (cmd == "recording_part")  // "abcde": RFC 4648 of "abc" and of "de"
                return request["from"] == 0 ? nlohmann::json{{"size", 5}, {"from", 0}, {"data", "YWJj"}}
                                            : nlohmann::json{{"size", 5}, {"from", 3}, {"data", "ZGU="}};
            return {{cmd, nlohmann::json::object()}};
        }};
    auto client = hmi::Client::connect((folder / "cell.sock").string());
    ASSERT_TRUE(client.ok()) << client.error().text();
    EXPECT_TRUE(gather_running(all, *client));

    ASSERT_NE(part("running/state.json"), nullptr);
    EXPECT_THAT(part("running/state.json")->bytes, Not(HasSubstr("hunter2")));
    ASSERT_NE(part("running/log.txt"), nullptr);
    EXPECT_EQ(part("running/log.txt")->bytes, "first\nsecond\n");
    std::size_t recordings = 0;
    for (const auto& p : all.parts) {
        if (!p.path.starts_with("recordings/")) continue;
        EXPECT_EQ(p.bytes, "abcde") << p.path;
        ++recordings;
    }
    EXPECT_EQ(recordings, most_recordings);
    EXPECT_NE(part("recordings/cell-7.twscope"), nullptr);
    EXPECT_EQ(part("running/bus.json"), nullptr);
    EXPECT_THAT(all.missing, ::testing::ElementsAre(HasSubstr("no cycle yet"), HasSubstr("2 older recordings")));
}

// Each question that is not answered takes three seconds: somebody waits for the file. Nobody takes this connection.
TEST_F(Gathering, AMachineThatHangsIsAskedOnce) {
    const auto path = (folder / "cell.sock").string();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const int listens = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ASSERT_EQ(::bind(listens, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(::listen(listens, 4), 0);
    auto client = hmi::Client::connect(path);
    ASSERT_TRUE(client.ok()) << client.error().text();

    EXPECT_FALSE(gather_running(all, *client));

    EXPECT_THAT(all.parts, IsEmpty());
    EXPECT_THAT(all.missing, ::testing::ElementsAre(HasSubstr("did not answer in time"), HasSubstr("not asked any more")));
    ::close(listens);
}

}  // namespace
}  // namespace taktwerk::apps
