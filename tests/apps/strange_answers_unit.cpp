// Something answers at the socket, in JSON, and not as this version's runtime would: another version, or no runtime at all. Each command says so.

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <thread>

#include <gmock/gmock.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"

namespace taktwerk::apps {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// One client after the other; `answer`: to each request, without "id" and "ok".
class StrangeRuntime {
public:
    using Answer = std::function<json(const json&)>;
    explicit StrangeRuntime(Answer answer) : answer_(std::move(answer)) {
        auto pattern = ::testing::TempDir() + "/strange-XXXXXX";
        folder_ = ::mkdtemp(pattern.data());
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::strncpy(address.sun_path, path().c_str(), sizeof address.sun_path - 1);
        door_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        EXPECT_EQ(::bind(door_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0) << path();
        EXPECT_EQ(::listen(door_, 4), 0);
        thread_ = std::thread([this] { serve(); });
    }
    ~StrangeRuntime() {
        ended_ = true;
        thread_.join();
        ::close(door_);
        ::unlink(path().c_str());
        ::rmdir(folder_.c_str());
    }
    StrangeRuntime(const StrangeRuntime&) = delete;
    StrangeRuntime& operator=(const StrangeRuntime&) = delete;
    [[nodiscard]] std::string path() const { return folder_ + "/s"; }

private:
    [[nodiscard]] bool ready(int file) const {
        pollfd wait{file, POLLIN, 0};
        while (!ended_)
            if (::poll(&wait, 1, 10) > 0) return true;
        return false;
    }
    void serve() {
        while (ready(door_)) {
            const int client = ::accept4(door_, nullptr, nullptr, SOCK_CLOEXEC);
            std::string text;
            char part[4096];
            while (ready(client)) {
                const auto got = ::read(client, part, sizeof part);
                if (got <= 0) break;
                text.append(part, static_cast<std::size_t>(got));
                for (std::size_t end = 0; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
                    const auto request = json::parse(text.substr(0, end));
                    auto answer = answer_(request);
                    answer["id"] = request["id"];
                    answer["ok"] = true;
                    const auto line = answer.dump() + "\n";
                    if (::send(client, line.data(), line.size(), MSG_NOSIGNAL) < 0) break;
                }
            }
            ::close(client);
        }
    }

    Answer answer_;
    std::string folder_;
    int door_ = -1;
    std::atomic<bool> ended_ = false;
    std::thread thread_;
};

void expect_told(const json& answer, std::vector<std::string> words) {
    const StrangeRuntime runtime([&](const json&) { return answer; });
    words.insert(words.end(), {"-s", runtime.path()});
    const auto told = in_process(words);
    EXPECT_EQ(told.code, exit_no_runtime) << words[0] << " with " << answer;
    EXPECT_THAT(told.err, HasSubstr("the answer is not what this version understands")) << words[0] << " with " << answer << told.out;
}

TEST(StrangeAnswers, OfTheAlarmsAreTold) {
    // The control: what the runtime of this version says.
    const StrangeRuntime sound([](const json&) {
        return json{
            {"alarms", {{{"source", "axis x"}, {"name", "drive_fault"}, {"count", 2}, {"reaction", "stop_axis"}, {"standing", true}}}}};
    });
    const auto good = in_process({"alarms", "-s", sound.path()});
    EXPECT_EQ(good.code, exit_ok) << good.err;
    EXPECT_THAT(good.out, HasSubstr("drive_fault"));

    for (const auto& alarms : {json("none"), json{1}, json{{{"source", 5}}}, json{{{"count", "two"}}}, json{{{"standing", "yes"}}}})
        expect_told({{"alarms", alarms}}, {"alarms"});
    expect_told(json::object(), {"alarms"});
    expect_told({{"alarms", {{{"cause", 3}}}}}, {"alarms", "--why"});
}

TEST(StrangeAnswers, OfTheHistoryAreTold) {
    for (const auto& rows :
         {json{1}, json{{{"id", "one"}}}, json{{{"utime", "now"}}}, json{{{"utime", 1}, {"cleared_utime", 1.5}, {"state", 3}}}})
        expect_told({{"alarms", rows}, {"more", false}}, {"alarms", "--history"});
    expect_told({{"more", true}}, {"alarms", "--history"});
    expect_told({{"alarms", {{{"name", "a"}}}}, {"more", true}}, {"alarms", "--history"});
    expect_told({{"alarms", json::array()}, {"more", "yes"}}, {"alarms", "--history"});
}

TEST(StrangeAnswers, OfEverythingElseAreTold) {
    const json axes{{{"name", "x"}, {"unit", 7}, {"disabled", "no"}}};
    const json answer{
        {"state", {{"axes", axes}, {"mode", 3}}}, {"layout", {{"axes", axes}, {"parameters", 5}}}, {"measure_plan", 3}, {"note", 5}};
    const std::vector<std::vector<std::string>> commands{
        {"monitor", "--once"},
        {"jog", "x", "--velocity", "5"},
        {"enable", "x", "--wait"},
        {"home", "all"},
        {"start"},
        {"set", "p.speed", "3"},
        {"stop", "x"},
        {"move", "x", "5mm", "--velocity", "5"},
        {"measure", "x", "step"},
        {"drive", "params", "x"},
    };
    for (const auto& command : commands) expect_told(answer, command);
}

}  // namespace
}  // namespace taktwerk::apps
