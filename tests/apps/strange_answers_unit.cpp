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
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// One client after the other; `answer`: to each request, without "id"; "ok" is true where it does not say otherwise.
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
                    if (!answer.contains("ok")) answer["ok"] = true;
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

// A switch that a program lets people write is set by its name, as an alarm says that wants it; a parameter of that name comes first.
TEST(StrangeAnswers, ASwitchIsWrittenAsWhatItIs) {
    json layout{{"parameters", {{{"program", "p"}, {"name", "speed"}, {"unit", "mm/s"}}}},
                {"variables",
                 {{{"program", "p"}, {"name", "works"}, {"unit", ""}, {"writable", true}},
                  {{"program", "p"}, {"name", "count"}, {"unit", ""}, {"writable", false}},
                  {{"program", "q"}, {"name", "speed"}, {"unit", ""}, {"writable", true}}}}};
    json asked;
    const StrangeRuntime runtime([&](const json& request) {
        if (request.at("cmd") != "layout") asked = request;
        return json{{"layout", layout}};
    });
    const auto wrote = [&](const std::string& name, const std::string& value) {
        EXPECT_EQ(in_process({"set", name, value, "-s", runtime.path()}).code, exit_ok) << name;
        for (const char* each : {"id", "utime"}) asked.erase(each);  // who asks, and when
        return asked;
    };
    EXPECT_EQ(wrote("works", "1"), (json{{"cmd", "set_value"}, {"variable", "works"}, {"value", 1.0}}));
    EXPECT_EQ(wrote("p.works", "false"), (json{{"cmd", "set_value"}, {"variable", "p.works"}, {"value", 0.0}}));
    EXPECT_EQ(wrote("speed", "6m/min"), (json{{"cmd", "set_parameter"}, {"parameter", "speed"}, {"value", 100.0}}));
    EXPECT_EQ(wrote("count", "3")["cmd"], "set_parameter") << "the machine says why not";
}

// --- a jog of a group, as the machine tells of it -----------------------------------------------------------------------------------

/// A machine with a group "arm" of one axis in degrees; `jogged`: to the renewals, from 1 on. It stands from the first renewal on.
StrangeRuntime::Answer with_an_arm(std::function<json(int)> jogged, const std::string& limiter = "command") {
    return [jogged = std::move(jogged), limiter, renewals = 0](const json& request) mutable -> json {
        if (request["cmd"] == "layout")
            return {{"layout", {{"axes", {{{"name", "j1"}, {"unit", "deg"}}}}, {"groups", {{{"name", "arm"}, {"unit", "mm"}}}}}}};
        if (request["cmd"] == "state") {
            const json group{{"name", "arm"},         {"state", renewals > 0 ? "GroupStandby" : "GroupMoving"},
                             {"tool_known", true},    {"tool_actual", {1, 2, 3, 0, 0, 0}},
                             {"unit", "mm"},          {"limiter", limiter},
                             {"limiting_axis", "j1"}, {"path_velocity", 50},
                             {"override", 1},         {"operators_override", 1},
                             {"path_acceleration", 0}};
            return {{"state", {{"groups", {group}}}}};
        }
        const bool renews = request["velocity"] != 0 && !request.contains("press");
        return renews ? jogged(++renewals) : json::object();
    };
}
json refused_jog(int) {
    return {{"ok", false},
            {"error", {{"code", "command.refused_by_axis"}, {"subject", "group arm"}, {"what", "a limit"}, {"remedy", "jog back"}}}};
}
Outcome jog_arm(const StrangeRuntime& runtime, std::vector<std::string> more) {
    std::vector<std::string> words{"jog", "arm"};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"-s", runtime.path()});
    return in_process(words);
}

// Where it stands before all of the distance was gone something else has stopped it, and the next renewal says what: that is no success.
TEST(GroupJogCommand, ADistanceIsGoneOnlyIfTheMachineSaysSoWhereItStands) {
    const StrangeRuntime limit(with_an_arm([](int n) { return n == 1 ? json::object() : refused_jog(n); }));
    const auto stopped = jog_arm(limit, {"x+", "--velocity", "20%", "--distance", "10mm"});
    EXPECT_EQ(stopped.code, exit_refused) << stopped.out;
    EXPECT_THAT(stopped.err, HasSubstr("a limit"));
    const StrangeRuntime sound(with_an_arm([](int) { return json::object(); }));
    const auto gone = jog_arm(sound, {"x+", "--velocity", "20%", "--distance", "10mm"});
    EXPECT_EQ(gone.code, exit_ok) << gone.err;
    EXPECT_THAT(gone.out, HasSubstr("arm: stands at X 1.000"));
    EXPECT_THAT(gone.out, Not(HasSubstr("let go before")));
}

TEST(GroupJogCommand, ATimeThatEndsBeforeTheDistanceIsSaid) {
    const StrangeRuntime slow([moves = with_an_arm({}), stands = with_an_arm([](int) { return json::object(); }),
                               released = false](const json& request) mutable -> json {
        if (request["cmd"] != "group_jog") return released ? stands(request) : moves(request);
        released = released || request["velocity"] == 0;
        if (released) (void)stands({{"cmd", "group_jog"}, {"velocity", 1}});
        return json::object();
    });
    const auto told = jog_arm(slow, {"x+", "--velocity", "20%", "--distance", "10mm", "--for", "100ms"});
    EXPECT_EQ(told.code, exit_ok) << told.err;
    EXPECT_THAT(told.out, HasSubstr("let go before all of 10mm was gone"));
}

// In acs all of what the mode leaves an axis is what 100 % asks for; in the machine's directions it is less.
TEST(GroupJogCommand, AnAxisThatGoesAsAskedIsNotCalledSlower) {
    for (const auto& [frame, direction, slower] : {std::tuple{"acs", "j1+", false}, std::tuple{"mcs", "x+", true}}) {
        const StrangeRuntime runtime(with_an_arm([](int) { return json::object(); }, "axis_limit"));
        const auto told = jog_arm(runtime, {direction, "--frame", frame, "--velocity", "100%", "--for", "100ms"});
        EXPECT_EQ(told.code, exit_ok) << told.err;
        EXPECT_EQ(told.out.find("slower than asked") != std::string::npos, slower) << frame << told.out;
    }
}

// What is written wrongly is told so by the exit code of wrong arguments, before anything is asked of the machine; a fifth is no 0.2 %.
TEST(GroupJogCommand, WrongArgumentsAreNoRefusalOfTheMachine) {
    const StrangeRuntime runtime(with_an_arm(refused_jog));
    for (const auto& words : std::vector<std::vector<std::string>>{{"x+", "--velocity", "200%"},
                                                                   {"x+", "--velocity", "-20%"},
                                                                   {"x+", "--velocity", "20%", "--distance", "-5mm"},
                                                                   {"x+", "--velocity", "20%", "--distance", "5deg"},
                                                                   {"--velocity", "20%"}})
        EXPECT_EQ(jog_arm(runtime, words).code, exit_usage) << words.back();
    const auto fifth = jog_arm(runtime, {"x+", "--velocity", "0.2"});
    EXPECT_EQ(fifth.code, exit_usage);
    EXPECT_THAT(fifth.err, AllOf(HasSubstr("per cent"), HasSubstr("`20%`"), HasSubstr("`0.2%`")));
    EXPECT_EQ(jog_arm(runtime, {"x+", "--velocity", "0.2%"}).code, exit_refused) << "so slow it was meant";
}

}  // namespace
}  // namespace taktwerk::apps
