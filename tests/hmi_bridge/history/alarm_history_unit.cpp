// The history as a whole: what the service side hands over, what a disk that refuses does to it, and the question on the socket.
#include "hmi_bridge/history/alarm_history.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include <nlohmann/json.hpp>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/socket/json_history.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/hmi_bridge/history/history_folder.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::FakeMachine;
using test::HistoryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t epoch = 1'800'000'000'000'000;

/// A history over a machine that is played by hand, and the socket's language over both.
class Kept {
public:
    explicit Kept(const std::string& path, std::int64_t rows = 1000)
        : history(
              path, rows, [this](const AlarmFact& fact) { return machine.describe(fact); },
              [this](std::string_view text) { said.emplace_back(text); }) {
        requests.set_history(&history);
        requests.on_open(1, {100, 1000, 1000});
    }
    void raise(std::uint16_t index) {
        machine.snapshot.alarms.push_back({{0x3001, AlarmSource::axis, index, 1, 2}, now, 1, true, false, Reaction::stop_axis});
        machine.snapshot.alarm_count = machine.snapshot.alarms.size();
    }
    void clear() {
        machine.snapshot.alarms.clear();
        machine.snapshot.alarm_count = 0;
    }
    /// One look of the service side; `disk`: the other thread works then.
    void step(Duration by, bool disk = true) {
        now += by;
        machine.snapshot.at = now;
        history.look(machine.snapshot, now, epoch + now.time_since_epoch() / 1us);
        if (disk) history.work(now);
        requests.step(now);
    }
    json ask(const std::string& keys = "") {
        requests.on_line(1, R"({"id":3,"cmd":"alarm_history")" + keys + "}", now);
        history.work(now);
        requests.step(now);
        return answer();
    }
    json answer() {
        const auto line = requests.next_line();
        return line ? json::parse(line->text) : json();
    }

    FakeMachine machine;
    AlarmHistory history;
    Gateway gateway{machine};
    JsonRequests requests{gateway, machine, [] { return epoch; }};
    Instant now{10s};
    std::vector<std::string> said;
};

TEST(AlarmHistory, AnAlarmIsInTheAnswerAndAfterARestartStillThere) {
    const HistoryFolder folder;
    {
        Kept kept(folder.file());
        kept.raise(0);
        kept.step(5ms);
        const auto answer = kept.ask();
        ASSERT_EQ(answer["ok"], true) << answer;
        EXPECT_EQ(answer["id"], 3);
        EXPECT_EQ(answer["more"], false);
        ASSERT_THAT(answer["alarms"], SizeIs(1));
        const auto& alarm = answer["alarms"][0];
        EXPECT_EQ(alarm["id"], 1);
        EXPECT_EQ(alarm["utime"], epoch + 10'000'000);
        EXPECT_EQ(alarm["cleared_utime"], nullptr);
        EXPECT_EQ(alarm["state"], "stands");
        EXPECT_EQ(alarm["name"], "following_error");
        EXPECT_EQ(alarm["source"], "axis x");
        EXPECT_EQ(alarm["reaction"], "stop_axis");
        EXPECT_EQ(alarm["english"], "The axis lags behind");
        EXPECT_EQ(alarm["chinese"], "跟随误差过大");
        EXPECT_EQ(alarm["cause"], "It is blocked");
        EXPECT_EQ(alarm["remedy"], "Free it");
        EXPECT_EQ(alarm["manual"], "");
        EXPECT_EQ(alarm["recording"], "");
        kept.clear();
        kept.step(500ms);
        EXPECT_EQ(kept.ask()["alarms"][0]["cleared_utime"], epoch + 10'505'000);
        kept.history.finish(kept.now);
    }
    Kept kept(folder.file());
    ASSERT_THAT(kept.ask()["alarms"], SizeIs(1));
    EXPECT_THAT(kept.said, IsEmpty());
}

TEST(AlarmHistory, WithoutAnAlarmThereIsNoFile) {
    const HistoryFolder folder;
    Kept kept(folder.file());
    for (int i = 0; i < 10; ++i) kept.step(1s);
    EXPECT_THAT(kept.ask()["alarms"], IsEmpty());
    kept.history.finish(kept.now);
    EXPECT_FALSE(std::filesystem::exists(folder.file()));
}

// 1,000 alarms a second that each last a millisecond, looked at each 5 ms: all are there, in few writes.
TEST(AlarmHistory, ABurstOfAThousandASecondIsAllThere) {
    const HistoryFolder folder;
    Kept kept(folder.file(), 5000);
    for (int cycle = 0; cycle < 3000; ++cycle) {
        const auto at = kept.now + std::chrono::milliseconds{cycle % 5};
        kept.machine.snapshot.passed_alarms.note(
            {{0x3001, AlarmSource::axis, static_cast<std::uint16_t>(cycle % 3), double(cycle), 0}, Reaction::stop_axis, at, at + 1ms});
        if (cycle % 5 == 4) kept.step(5ms);
    }
    kept.history.finish(kept.now);
    json rows = json::array();
    std::string before;
    for (bool more = true; more;) {
        const auto page = kept.ask(R"(,"limit":500)" + before);
        ASSERT_EQ(page["ok"], true) << page;
        rows.insert(rows.end(), page["alarms"].begin(), page["alarms"].end());
        more = page["more"];
        if (more) before = R"(,"before":)" + page["alarms"].back()["id"].dump();
    }
    ASSERT_EQ(rows.size(), 3000u);
    EXPECT_EQ(rows.back()["utime"], epoch + 10'000'000);
    EXPECT_EQ(rows.front()["utime"], epoch + 12'999'000);
    EXPECT_THAT(kept.said, IsEmpty());
}

TEST(AlarmHistory, ADiskThatHangsHoldsUpNobodyAndTheQuestionIsAnswered) {
    const HistoryFolder folder;
    Kept kept(folder.file());
    for (std::uint16_t i = 0; i < AlarmHistory::most_waiting + 10; ++i) {
        kept.clear();
        kept.raise(i);
        kept.step(1ms, false);
    }
    kept.requests.on_line(1, R"({"id":9,"cmd":"alarm_history"})", kept.now);
    kept.step(1s, false);
    EXPECT_TRUE(kept.answer().is_null()) << "it waits";
    kept.step(5s, false);
    const auto answer = kept.answer();
    EXPECT_EQ(answer["ok"], false);
    EXPECT_EQ(answer["id"], 9);
    EXPECT_EQ(answer["error"]["code"], "history.silent");
    kept.step(1ms);  // the disk is back
    EXPECT_TRUE(kept.answer().is_null()) << "one answer";
    ASSERT_THAT(kept.said, SizeIs(1));
    EXPECT_THAT(kept.said[0], HasSubstr("10 alarms found no room"));
}

TEST(AlarmHistory, TooManyQuestionsAreRefusedToWhoAsks) {
    const HistoryFolder folder;
    Kept kept(folder.file());
    for (std::size_t i = 0; i <= AlarmHistory::most_questions; ++i) kept.requests.on_line(1, R"({"id":1,"cmd":"alarm_history"})", kept.now);
    kept.requests.step(kept.now);
    EXPECT_EQ(kept.answer()["error"]["code"], "command.queue_full");
    EXPECT_TRUE(kept.answer().is_null());
    kept.history.work(kept.now);
    kept.requests.step(kept.now);
    for (std::size_t i = 0; i < AlarmHistory::most_questions; ++i) EXPECT_EQ(kept.answer()["ok"], true);
    EXPECT_TRUE(kept.answer().is_null());
}

// A folder that cannot be made stands for every disk that refuses, also where the tests' user may write everywhere.
TEST(AlarmHistory, AFolderThatRefusesIsToldOnceAndWorksAgainLater) {
    const HistoryFolder folder;
    const auto in_the_way = folder.path() + "/state";
    std::ofstream(in_the_way) << "a file";
    Kept kept(in_the_way + "/demo.sqlite");
    kept.raise(0);
    for (int i = 0; i < 60; ++i) kept.step(1s);
    ASSERT_THAT(kept.said, SizeIs(1));
    EXPECT_THAT(kept.said[0], HasSubstr("runs on"));
    const auto refused = kept.ask();
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(refused["error"]["code"], "history.folder");

    std::filesystem::remove(in_the_way);
    for (int i = 0; i < 11; ++i) kept.step(1s);
    ASSERT_THAT(kept.said, SizeIs(2));
    EXPECT_THAT(kept.said[1], HasSubstr("again"));
    EXPECT_THAT(kept.ask()["alarms"], SizeIs(1)) << "what waited is there";
}

TEST(AlarmHistory, AReadOnlyFileIsToldAndTheMachineRunsOn) {
    if (::geteuid() == 0) GTEST_SKIP() << "root writes into every file";
    const HistoryFolder folder;
    { Kept(folder.file()).step(1ms); }
    ::chmod(folder.path().c_str(), 0500);
    Kept kept(folder.file());
    kept.raise(0);
    for (int i = 0; i < 30; ++i) kept.step(1s);
    ASSERT_THAT(kept.said, SizeIs(1));
    EXPECT_EQ(kept.ask()["error"]["code"], "history.open");
}

/// Files of this process grow no further, much as on a disk that is full.
class FullDisk {
public:
    explicit FullDisk(rlim_t most) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &usual_);
        const rlimit full{most, usual_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &full);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &usual_);
        std::signal(SIGXFSZ, before_);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

private:
    rlimit usual_{};
    void (*before_)(int);
};

TEST(AlarmHistory, WhatAFullDiskHasIsShownAndWhatItHasNotComesWhenThereIsRoom) {
    const HistoryFolder folder;
    Kept kept(folder.file());
    kept.raise(0);
    kept.step(1s);
    {
        const FullDisk full(std::filesystem::file_size(folder.file() + "-wal") + 100);
        for (std::uint16_t i = 1; i < 30; ++i) {  // less than until it is tried again
            kept.raise(i);
            kept.step(200ms);
        }
        ASSERT_THAT(kept.said, SizeIs(1)) << "once";
        EXPECT_THAT(kept.said[0], HasSubstr("cannot be written"));
        const auto shown = kept.ask();
        ASSERT_EQ(shown["ok"], true) << shown;
        EXPECT_THAT(shown["alarms"], SizeIs(1)) << "what is there is there";
    }
    for (int i = 0; i < 11; ++i) kept.step(1s);
    EXPECT_THAT(kept.said, SizeIs(2));
    EXPECT_THAT(kept.ask()["alarms"], SizeIs(30));
}

TEST(AlarmHistory, TornWhileItIsOpenANewOneBeginsAndTheAlarmIsInIt) {
    const HistoryFolder folder;
    {
        Kept kept(folder.file());
        kept.raise(0);
        kept.step(5ms);
        kept.history.finish(kept.now);
    }
    { std::ofstream(folder.file(), std::ios::binary) << std::string(8192, 'x'); }
    Kept kept(folder.file());
    kept.raise(1);
    kept.step(5ms);
    ASSERT_THAT(kept.said, SizeIs(1));
    EXPECT_THAT(kept.said[0], HasSubstr(".torn"));
    EXPECT_THAT(kept.ask()["alarms"], SizeIs(1));
}

TEST(AlarmHistory, TheQuestionIsReadStrictly) {
    const HistoryFolder folder;
    Kept kept(folder.file());
    const auto code = [&](const std::string& keys) { return kept.ask(keys)["error"]["code"]; };
    EXPECT_EQ(code(R"(,"limit":0)"), "command.bad_value");
    EXPECT_EQ(code(R"(,"limit":501)"), "command.bad_value");
    EXPECT_EQ(code(R"(,"before":0)"), "command.bad_value");
    EXPECT_EQ(code(R"(,"before":"7")"), "request.wrong_type");
    EXPECT_EQ(code(R"(,"text":7)"), "request.wrong_type");
    EXPECT_EQ(code(R"(,"txt":"x")"), "request.unknown_key");
    EXPECT_EQ(code(R"(,"text":")" + std::string(257, 'x') + R"(")"), "command.bad_value");
    EXPECT_EQ(kept.ask(R"(,"limit":500,"before":1,"text":"x","source":"axis x","since_utime":-5,"until_utime":9223372036854775807)")["ok"],
              true);
    kept.requests.set_history(nullptr);
    EXPECT_EQ(code(""), "history.off");
}

TEST(AlarmHistory, AnAnswerIsBoundedInBytesAndSaysThatThereIsMore) {
    HistoryPage page;
    for (int i = 0; i < most_rows; ++i) {
        page.rows.push_back(test::raised(1, 1).row);
        page.rows.back().id = most_rows - i;
        page.rows.back().english = std::string(HistoryStore::longest_text, 'x');
    }
    const auto line = history_line("7", page);
    EXPECT_LT(line.size(), longest_history_answer + 100);
    const auto answer = json::parse(line);
    EXPECT_EQ(answer["more"], true);
    EXPECT_GT(answer["alarms"].size(), 100u);
}

// The bridge joins them: a line on the socket's language, an alarm of the snapshot, the other thread's work.
TEST(AlarmHistory, TheBridgeLooksByItself) {
    const HistoryFolder folder;
    FakeMachine machine;
    HmiConfig config;
    config.lcm = false;
    config.socket = folder.path() + "/socket";
    HmiOptions options;
    options.wall_utime = [] { return epoch; };
    auto bridge = HmiBridge::open(config, machine, std::move(options));
    ASSERT_TRUE(bridge) << bridge.error().text();
    const auto history = std::make_shared<AlarmHistory>(
        folder.file(), 10, [&](const AlarmFact& fact) { return machine.describe(fact); }, nullptr);
    (*bridge)->keep(history);
    machine.snapshot.alarms.push_back({{0x3001, AlarmSource::axis, 0, 1, 2}, Instant{1s}, 1, true, false, Reaction::stop_axis});
    machine.snapshot.alarm_count = 1;
    (*bridge)->step(Instant{2s});
    history->work(Instant{2s});
    history->ask(1, "5", {}, Instant{2s});
    history->work(Instant{2s});
    const auto answer = history->next_answer(Instant{2s});
    ASSERT_TRUE(answer && answer->page);
    ASSERT_THAT(answer->page->rows, SizeIs(1));
    EXPECT_EQ(answer->page->rows[0].utime, epoch - 1'000'000);
}

}  // namespace
}  // namespace taktwerk::hmi
