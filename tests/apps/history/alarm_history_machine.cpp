// The alarms of a run are there in the next one, also when the first was killed; a run in virtual time keeps them only when it is told to, and alike each time.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/history/history_store.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr auto patience = 60s;

class AlarmHistoryOfARun : public ::testing::Test {
protected:
    AlarmHistoryOfARun() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-alarms-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        std::ifstream in(source / "config/machines/minimal.yaml");
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        std::ofstream(path("machine.yaml")) << text << "hmi: { socket: '" << path("minimal.sock")
                                            << "', lcm: { enabled: false } }\nsimulation: { supervision: relaxed }\n";
    }
    ~AlarmHistoryOfARun() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    std::unique_ptr<Child> run() const {
        auto child = std::make_unique<Child>(std::vector<std::string>{taktwerk, "run", path("machine.yaml"), "--simulate"});
        for (int i = 0; i < 300 && command({"monitor", "--once"}).first != exit_ok; ++i) ::usleep(100'000);
        return child;
    }
    std::pair<int, std::string> command(std::vector<std::string> words) const {
        words.insert(words.begin(), taktwerk);
        words.insert(words.end(), {"-s", path("minimal.sock")});
        Child child(words);
        const int code = child.wait(patience);
        return {code, child.text()};
    }
    json history(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"alarms", "--history", "--json"});
        const auto answer = command(more);
        EXPECT_EQ(answer.first, exit_ok) << answer.second;
        return json::parse(answer.second, nullptr, false)["alarms"];
    }
    json until_there(const std::string& text) const {
        for (int i = 0; i < 100; ++i) {
            auto alarms = history({"--text", text});
            if (!alarms.empty()) return alarms;
            ::usleep(100'000);
        }
        return json::array();
    }
    std::string folder_;
};

TEST_F(AlarmHistoryOfARun, IsThereAfterAKillAndAfterAnOrderlyEnd) {
    auto machine = run();
    EXPECT_EQ(command({"simulate", "drive-fault", "x", "0x3130"}).first, exit_ok);
    const auto first = until_there("drive_fault");
    ASSERT_FALSE(first.empty()) << machine->text();
    EXPECT_EQ(first[0]["source"], "axis x");
    EXPECT_EQ(first[0]["cleared_utime"], nullptr);
    machine->signal(SIGKILL);
    machine->wait(patience);
    fs::remove(path("minimal.sock"));

    machine = run();
    const auto again = history({"--text", "drive_fault"});
    ASSERT_EQ(again.size(), 1u) << machine->text();
    EXPECT_EQ(again[0]["utime"], first[0]["utime"]);
    EXPECT_EQ(again[0]["english"], first[0]["english"]);
    EXPECT_EQ(again[0]["state"], "unknown") << "nobody saw how it went on";

    // An orderly end writes what there is to write.
    EXPECT_EQ(command({"simulate", "drive-fault", "x", "0x3130"}).first, exit_ok);
    for (int i = 0; i < 100 && command({"alarms"}).second.find("drive_fault") == std::string::npos; ++i) ::usleep(50'000);
    EXPECT_EQ(command({"shutdown"}).first, exit_ok);
    machine->wait(patience);
    machine = run();
    EXPECT_EQ(history({"--text", "drive_fault"}).size(), 2u);
    const auto shown = command({"alarms", "--history", "--why", "--source", "axis x"});
    EXPECT_THAT(shown.second, HasSubstr("drive_fault"));
    EXPECT_THAT(shown.second, HasSubstr("remedy: "));
    EXPECT_EQ(command({"alarms", "--text", "x"}).first, exit_usage) << "a filter is for the history";
}

TEST_F(AlarmHistoryOfARun, InVirtualTimeIsKeptOnlyWhereThatWasAskedForAndIsTheSameEachTime) {
    std::ifstream in(path("machine.yaml"));
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string simulation = "simulation: { supervision: relaxed }";
    text.replace(text.find(simulation), simulation.size(),
                 "simulation: { supervision: relaxed, events: [ { at: 5 s, drive_fault: x, code: 0x3130 } ] }");
    std::ofstream(path("faulty.yaml")) << text;
    const auto run_virtual = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {taktwerk, "run", path("faulty.yaml"), "--virtual-time", "--duration", "8s", "--quiet"});
        Child child(more);
        child.wait(patience);
        return child.text();
    };
    const auto said = run_virtual({});
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) EXPECT_NE(entry.path().extension(), ".sqlite") << said;

    std::vector<std::vector<hmi::AlarmRow>> runs;
    for (const char* where : {"one", "two"}) {
        const auto told = run_virtual({"--history", path(where)});
        const auto store = hmi::HistoryStore::open(path(where) + "/minimal.alarms.sqlite", 1000);
        ASSERT_TRUE(store) << store.error().text();
        const auto page = store->store->read({});
        ASSERT_TRUE(page);
        ASSERT_FALSE(page->rows.empty()) << told;
        runs.push_back(page->rows);
    }
    ASSERT_EQ(runs[0].size(), runs[1].size());
    bool fault = false;
    for (std::size_t i = 0; i < runs[0].size(); ++i) {
        EXPECT_EQ(runs[0][i].utime, runs[1][i].utime);
        EXPECT_EQ(runs[0][i].cleared_utime, runs[1][i].cleared_utime);
        EXPECT_EQ(runs[0][i].english, runs[1][i].english);
        fault = fault || (runs[0][i].name == "drive_fault" && runs[0][i].utime >= 5'000'000 && runs[0][i].utime < 5'100'000);
    }
    EXPECT_TRUE(fault) << "at five seconds of machine time";
}

}  // namespace
}  // namespace taktwerk::apps
