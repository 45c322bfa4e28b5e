#include "ecat/script/script.hpp"
#include "ecat/script/waits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

Instant at(Duration t) { return Instant{} + t; }

Script<int> twice_after(Duration d, int value) {
    co_await pause(d);
    co_return 2 * value;
}

Script<void> sum(std::vector<int>& log) {
    const int a = co_await twice_after(1ms, 1);
    const int b = co_await twice_after(2ms, 10);
    log.push_back(a + b);
}

TEST(Script, WaitsInMachineTimeAndReturnsValuesThroughNestedScripts) {
    std::vector<int> log;
    Runner runner{sum(log)};

    runner.step(at(0ms));  // first pause starts
    runner.step(at(1ms));  // it ends, the second starts: ends at 3 ms
    runner.step(at(2ms));
    EXPECT_FALSE(runner.done());
    EXPECT_TRUE(log.empty());

    runner.step(at(3ms));
    EXPECT_TRUE(runner.done());
    EXPECT_EQ(log, std::vector<int>{22});
}

Script<void> write_after(Duration d, int value, std::vector<int>& log) {
    co_await pause(d);
    log.push_back(value);
}

Script<void> side_by_side(std::vector<int>& log) {
    std::vector<Script<void>> parts;
    parts.push_back(write_after(3ms, 3, log));
    parts.push_back(write_after(1ms, 1, log));
    co_await all(std::move(parts));
    log.push_back(99);
}

TEST(Script, AllRunsScriptsSideBySideAndEndsWithTheLast) {
    std::vector<int> log;
    Runner runner{side_by_side(log)};

    for (auto t = 0ms; t <= 2ms; t += 1ms) runner.step(at(t));
    EXPECT_EQ(log, std::vector<int>{1});
    runner.step(at(3ms));
    EXPECT_EQ(log, (std::vector<int>{1, 3, 99}));
    EXPECT_TRUE(runner.done());
}

Script<void> talk(ScriptLock& lock, std::string& log, std::string words, Duration each) {
    co_await lock.acquire();
    const ScriptLockGuard guard{lock};
    for (const char c : words) {
        log += c;
        co_await pause(each);
    }
}

TEST(Script, LockKeepsConversationsApart) {
    ScriptLock lock;
    std::string log;
    Runner first{talk(lock, log, "abc", 1ms)};
    Runner second{talk(lock, log, "xyz", 1ms)};
    for (auto t = 0ms; t < 10ms; t += 1ms) {
        first.step(at(t));
        second.step(at(t));
    }
    EXPECT_EQ(log, "abcxyz");
}

TEST(Script, DestroyedHalfWayReleasesWhatItHolds) {
    ScriptLock lock;
    std::string log;
    {
        Runner first{talk(lock, log, "abc", 1ms)};
        first.step(at(0ms));
    }
    Runner second{talk(lock, log, "x", 1ms)};
    second.step(at(0ms));
    EXPECT_EQ(log, "ax");
}

Script<int> immediate(int n) { co_return n; }
Script<void> many(long& total) {
    for (int i = 0; i < 200000; ++i) {
        const int n = co_await immediate(1);
        total += n;
    }
}

TEST(Script, LongChainsWithoutAWaitDoNotGrowTheStack) {
    long total = 0;
    Runner runner{many(total)};
    runner.step(at(0ms));
    EXPECT_EQ(total, 200000);
}

Script<void> count_running(int& running, int& most, int& ended) {
    most = std::max(most, ++running);
    co_await pause(2ms);
    --running;
    ++ended;
}

Script<void> in_threes(int& running, int& most, int& ended) {
    std::vector<Script<void>> parts;
    for (int i = 0; i < 10; ++i) parts.push_back(count_running(running, most, ended));
    co_await all(std::move(parts), 3);
}

TEST(Script, OfManySideBySideOnlySoManyRunAtOnceAndAllOfThemEnd) {
    int running = 0, most = 0, ended = 0;
    Runner runner{in_threes(running, most, ended)};
    Duration now{};
    for (; !runner.done() && now < 100ms; now += 1ms) runner.step(at(now));
    EXPECT_TRUE(runner.done());
    EXPECT_EQ(most, 3);
    EXPECT_EQ(ended, 10);
    EXPECT_LE(now, 10ms) << "the next starts when one ends: four rounds of 2 ms";
}

}  // namespace
}  // namespace taktwerk::ecat
