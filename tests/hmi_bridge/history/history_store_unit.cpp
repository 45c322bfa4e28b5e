// The file of the history: what it keeps over restarts, how it is bounded, what it makes of a torn one, of a kill, of a folder that refuses.
#include "hmi_bridge/history/history_store.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <vector>

#include "tests/hmi_bridge/history/history_folder.hpp"

namespace taktwerk::hmi {
namespace {

using test::HistoryFolder;
using test::raised;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Changes = std::vector<AlarmWatch::Change>;

std::unique_ptr<HistoryStore> opened(const std::string& path, std::int64_t rows = 1000) {
    auto out = HistoryStore::open(path, rows);
    EXPECT_TRUE(out) << out.error().text();
    if (!out) return nullptr;
    EXPECT_EQ(out->moved_aside, "");
    return std::move(out->store);
}

std::vector<AlarmRow> all(HistoryStore& store, HistoryQuery query = {}) {
    auto page = store.read(query);
    EXPECT_TRUE(page) << page.error().text();
    return page ? page->rows : std::vector<AlarmRow>{};
}

std::vector<std::int64_t> utimes(HistoryStore& store, const HistoryQuery& query = {}) {
    std::vector<std::int64_t> out;
    for (const auto& row : all(store, query)) out.push_back(row.utime);
    return out;
}

TEST(HistoryStore, ARestartKeepsEveryWordAndNumber) {
    const HistoryFolder folder;
    auto change = raised(1, 1'800'000'000'123'456);
    change.row.cleared_utime = 1'800'000'001'000'000;
    change.row.acknowledged_utime = 1'800'000'002'000'000;
    change.row.state = AlarmState::gone;
    change.row.count = 7;
    change.row.manual = "SV33-E 9.3";
    change.row.recording = "demo-20261125";
    {
        const auto store = opened(folder.file());
        ASSERT_TRUE(store->write(Changes{change}));
    }
    const auto rows = all(*opened(folder.file()));
    ASSERT_THAT(rows, SizeIs(1));
    const auto& row = rows[0];
    EXPECT_EQ(row.id, 1);
    EXPECT_EQ(row.utime, 1'800'000'000'123'456);
    EXPECT_EQ(row.cleared_utime, 1'800'000'001'000'000);
    EXPECT_EQ(row.acknowledged_utime, 1'800'000'002'000'000);
    EXPECT_EQ(row.state, AlarmState::gone);
    EXPECT_EQ(row.count, 7u);
    EXPECT_EQ(row.alarm, 0x3001);
    EXPECT_EQ(row.reaction, Reaction::stop_axis);
    EXPECT_EQ(row.name, "following_error");
    EXPECT_EQ(row.source, "axis x");
    EXPECT_EQ(row.english, "The axis lags behind by 1 mm");
    EXPECT_EQ(row.chinese, "跟随误差过大");
    EXPECT_EQ(row.cause, "It is blocked");
    EXPECT_EQ(row.remedy, "Free it");
    EXPECT_EQ(row.manual, "SV33-E 9.3");
    EXPECT_EQ(row.recording, "demo-20261125");
}

TEST(HistoryStore, WhatWasListedWhenTheRunEndedIsUnknownAndTheNextRunsKeysAreItsOwn) {
    const HistoryFolder folder;
    {
        const auto store = opened(folder.file());
        ASSERT_TRUE(store->write(Changes{raised(1, 100), raised(2, 200)}));
    }
    const auto store = opened(folder.file());
    ASSERT_TRUE(store->write(Changes{raised(1, 300)}));
    const auto rows = all(*store);
    ASSERT_THAT(rows, SizeIs(3));
    EXPECT_EQ(rows[0].state, AlarmState::stands);
    EXPECT_EQ(rows[1].state, AlarmState::unknown);
    EXPECT_EQ(rows[2].state, AlarmState::unknown);
    EXPECT_EQ(rows[2].utime, 100);
}

TEST(HistoryStore, ReopenedWithinTheRunAnAlarmIsStillItsRow) {
    const HistoryFolder folder;
    std::int64_t run = 0;
    {
        const auto store = opened(folder.file());
        ASSERT_TRUE(store->write(Changes{raised(1, 100)}));
        run = store->run();
    }
    auto again = HistoryStore::open(folder.file(), 1000, run);
    ASSERT_TRUE(again);
    EXPECT_EQ(all(*again->store).at(0).state, AlarmState::stands);
    auto gone = raised(1, 100);
    gone.row.state = AlarmState::gone;
    ASSERT_TRUE(again->store->write(Changes{gone}));
    const auto rows = all(*again->store);
    ASSERT_THAT(rows, SizeIs(1));
    EXPECT_EQ(rows[0].state, AlarmState::gone);
}

TEST(HistoryStore, KeepsTheNewestRowsAndNoIdComesTwice) {
    const HistoryFolder folder;
    const auto store = opened(folder.file(), 10);
    for (std::uint64_t key = 1; key <= 25; ++key) ASSERT_TRUE(store->write(Changes{raised(key, static_cast<std::int64_t>(key))}));
    EXPECT_THAT(utimes(*store), ElementsAre(25, 24, 23, 22, 21, 20, 19, 18, 17, 16));
    EXPECT_EQ(all(*store).front().id, 25);
    // One call with more than there is room for.
    Changes burst;
    for (std::uint64_t key = 100; key < 130; ++key) burst.push_back(raised(key, static_cast<std::int64_t>(key)));
    ASSERT_TRUE(store->write(burst));
    EXPECT_EQ(all(*store).size(), 10u);
    EXPECT_EQ(all(*store).front().id, 55);
}

TEST(HistoryStore, PagesGoOnWhereTheLastOneEnded) {
    const HistoryFolder folder;
    const auto store = opened(folder.file());
    Changes changes;
    for (std::uint64_t key = 1; key <= 7; ++key) changes.push_back(raised(key, static_cast<std::int64_t>(key * 10)));
    ASSERT_TRUE(store->write(changes));
    HistoryQuery query;
    query.limit = 3;
    auto page = store->read(query);
    ASSERT_TRUE(page);
    EXPECT_TRUE(page->more);
    EXPECT_THAT(utimes(*store, query), ElementsAre(70, 60, 50));
    query.before = page->rows.back().id;
    EXPECT_THAT(utimes(*store, query), ElementsAre(40, 30, 20));
    query.before = 2;
    page = store->read(query);
    ASSERT_TRUE(page);
    EXPECT_FALSE(page->more);
    EXPECT_THAT(utimes(*store, query), ElementsAre(10));
    query.before = 1;
    EXPECT_THAT(utimes(*store, query), IsEmpty());
    query = {};
    query.limit = 7;
    EXPECT_FALSE(store->read(query)->more) << "exactly all of them";
}

TEST(HistoryStore, FiltersByTimeSourceAndText) {
    const HistoryFolder folder;
    const auto store = opened(folder.file());
    auto percent = raised(4, 400, "input_out_of_limits", "input 'tank_level'");
    percent.row.english = "The input is at 100% of its range";
    ASSERT_TRUE(
        store->write(Changes{raised(1, 100), raised(2, 200, "drive_fault", "axis y"), raised(3, 300, "frames_lost", "bus"), percent}));
    const auto found = [&](auto fill) {
        HistoryQuery query;
        fill(query);
        return utimes(*store, query);
    };
    EXPECT_THAT(found([](auto& q) { q.since_utime = 200; }), ElementsAre(400, 300, 200)) << "both ends belong to it";
    EXPECT_THAT(found([](auto& q) { q.until_utime = 200; }), ElementsAre(200, 100));
    EXPECT_THAT(found([](auto& q) { q.source = "axis y"; }), ElementsAre(200));
    EXPECT_THAT(found([](auto& q) { q.source = "axis"; }), IsEmpty()) << "a source is meant whole";
    EXPECT_THAT(found([](auto& q) { q.text = "FRAMES"; }), ElementsAre(300));
    EXPECT_THAT(found([](auto& q) { q.text = "跟随"; }), ElementsAre(400, 300, 200, 100));
    EXPECT_THAT(found([](auto& q) { q.text = "0%"; }), ElementsAre(400)) << "no wildcard";
    EXPECT_THAT(found([](auto& q) { q.text = "tank_l"; }), ElementsAre(400));
    EXPECT_THAT(found([](auto& q) { q.text = "tankXl"; }), IsEmpty());
    EXPECT_THAT(found([](auto& q) { q.text = "' OR 1=1 --"; }), IsEmpty());
    EXPECT_THAT(found([](auto& q) { q.source = "axis x' OR '1'='1"; }), IsEmpty());
    EXPECT_THAT(found([](auto& q) { q.text = std::string("\0x", 2); }), IsEmpty());
}

TEST(HistoryStore, ALongTextIsCutBetweenTwoCharacters) {
    const HistoryFolder folder;
    const auto store = opened(folder.file());
    auto change = raised(1, 1);
    change.row.chinese.clear();
    while (change.row.chinese.size() < 10'000) change.row.chinese += "急";  // three bytes
    ASSERT_TRUE(store->write(Changes{change}));
    const auto kept = all(*store).at(0).chinese;
    EXPECT_EQ(kept.size(), 1998u);
    EXPECT_EQ(kept.substr(1995), "急");
}

TEST(HistoryStore, ATornFileIsMovedAsideAndANewOneBegins) {
    const HistoryFolder folder;
    {
        const auto store = opened(folder.file());
        Changes changes;
        for (std::uint64_t key = 1; key <= 200; ++key) changes.push_back(raised(key, 1));
        ASSERT_TRUE(store->write(changes));
    }
    {
        std::fstream file(folder.file(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(5000);
        const std::string rubbish(20'000, '\x5A');
        file.write(rubbish.data(), static_cast<std::streamsize>(rubbish.size()));
    }
    auto again = HistoryStore::open(folder.file(), 1000);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->moved_aside, folder.file() + ".torn");
    EXPECT_TRUE(std::filesystem::exists(folder.file() + ".torn")) << "somebody may mend it";
    EXPECT_THAT(all(*again->store), IsEmpty());
    EXPECT_TRUE(again->store->write(Changes{raised(1, 5)}));
}

TEST(HistoryStore, WhatIsNoHistoryAtAllIsNotWrittenOver) {
    for (const std::string& text :
         {std::string("my diary, which is longer than a page of SQLite's header is: ") + std::string(2000, 'x'), std::string("short")}) {
        const HistoryFolder folder;
        std::ofstream(folder.file()) << text;
        const auto opened_new = HistoryStore::open(folder.file(), 1000);
        ASSERT_TRUE(opened_new) << opened_new.error().text();
        std::ifstream aside(opened_new->moved_aside, std::ios::binary);
        EXPECT_EQ(std::string((std::istreambuf_iterator<char>(aside)), {}), text);
    }
}

TEST(HistoryStore, TheFileBelongsToOneProcess) {
    const HistoryFolder folder;
    const auto mine = opened(folder.file());
    ASSERT_TRUE(mine->write(Changes{raised(1, 1)}));
    const auto another = HistoryStore::open(folder.file(), 1000);
    ASSERT_FALSE(another);
    EXPECT_EQ(another.error().code, "history.in_use");
    EXPECT_THAT(another.error().remedy, HasSubstr("directory"));
}

TEST(HistoryStore, AFolderThatCannotBeMadeIsNamed) {
    const HistoryFolder folder;
    std::ofstream(folder.path() + "/in_the_way") << "a file";
    const auto failed = HistoryStore::open(folder.path() + "/in_the_way/below/x.sqlite", 10);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, "history.folder");
    EXPECT_THAT(failed.error().text(), HasSubstr("in_the_way"));
}

// Killed again and again while it writes: never torn, and what a write had returned for is there.
TEST(HistoryStore, AKillInTheMiddleOfAWriteLosesNothingThatWasWritten) {
    const HistoryFolder folder;
    std::int64_t written = 0;
    for (int round = 0; round < 8; ++round) {
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        const pid_t child = ::fork();
        if (child == 0) {
            ::alarm(60);
            const auto opened_by_child = HistoryStore::open(folder.file(), 100'000);
            if (!opened_by_child || !opened_by_child->moved_aside.empty()) ::_exit(1);
            for (std::uint64_t key = 1;; key += 5) {
                Changes changes;
                for (std::uint64_t i = 0; i < 5; ++i) changes.push_back(raised(key + i, 1));
                if (!opened_by_child->store->write(changes)) ::_exit(2);
                if (::write(ends[1], "w", 1) != 1) ::_exit(3);
            }
        }
        ::close(ends[1]);
        char said = 0;
        for (int i = 0; i < 3 + round; ++i) {
            if (::read(ends[0], &said, 1) != 1) break;
            ++written;
        }
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status)) << "round " << round << ", exit code " << WEXITSTATUS(status);
        while (::read(ends[0], &said, 1) == 1) ++written;
        ::close(ends[0]);
    }
    ASSERT_GT(written, 0);
    auto after = HistoryStore::open(folder.file(), 100'000);
    ASSERT_TRUE(after) << after.error().text();
    EXPECT_EQ(after->moved_aside, "");
    std::int64_t rows = 0;
    HistoryQuery query;
    query.limit = most_rows;
    for (;;) {
        const auto page = after->store->read(query);
        ASSERT_TRUE(page) << page.error().text();
        rows += static_cast<std::int64_t>(page->rows.size());
        if (!page->more) break;
        query.before = page->rows.back().id;
    }
    EXPECT_GE(rows, written * 5);
    EXPECT_LE(rows, (written + 8) * 5) << "at most one write a kill that had not returned yet";
    EXPECT_EQ(rows % 5, 0) << "a write is whole or not at all";
}

}  // namespace
}  // namespace taktwerk::hmi
