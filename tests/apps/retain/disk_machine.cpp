// A disk that is full, one that takes nothing more, and bits that flip on it, under a runtime that counts: an alarm, the machine runs on, the old values
// stay, and when the disk is well again everything goes on. The disk is a small one in memory that nobody but this process sees.

#include <sched.h>
#include <sys/mount.h>

#include <fstream>
#include <iterator>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/clock.hpp"
#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/retain/counted_machine.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Time = CountedMachine::Time;

/// What this process mounts from here on, nobody else sees. False: this system lets nobody do that.
bool own_mounts() {
    static const bool possible = [] {
        const auto user = ::getuid();
        const auto group = ::getgid();
        if (::unshare(CLONE_NEWNS) != 0) {
            if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
            std::ofstream{"/proc/self/setgroups"} << "deny";
            std::ofstream{"/proc/self/uid_map"} << "0 " << user << " 1";
            std::ofstream{"/proc/self/gid_map"} << "0 " << group << " 1";
        }
        return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
    }();
    return possible;
}

class Disk : public ::testing::Test {
protected:
    bool until(const std::function<bool()>& condition, Duration patience = 30s) {
        const auto end = clock.now() + patience;
        while (!condition()) {
            if (clock.now() > end) return false;
            clock.sleep_until(clock.now() + 5ms);
        }
        return true;
    }
    /// The program has started, and counts.
    void start() {
        const auto starts = machine.told().starts.load();
        machine.switch_on(Time::real);
        ASSERT_TRUE(until([&] { return machine.told().starts > starts; }, 60s)) << machine.process().text();
        expect_counting();
    }
    void expect_counting() {
        const auto counted = machine.told().count.load();
        EXPECT_TRUE(until([&] { return machine.told().count > counted + 100; })) << "the machine runs on\n" << machine.process().text();
    }
    [[nodiscard]] bool alarm(const std::string& name) const {
        auto client = hmi::Client::connect(machine.at("socket"));
        if (!client) return false;
        const auto state = client->request({{"cmd", "state"}}, 10s);
        return state && state->dump().find('"' + name + '"') != std::string::npos;
    }
    [[nodiscard]] std::int64_t on_disk() const {
        const auto found = machine.read_kept();
        EXPECT_TRUE(found.damage.empty());
        EXPECT_FALSE(found.torn);
        return found.count;
    }
    void flip_a_bit(const char* slot) {
        std::fstream file(machine.kept() / slot, std::ios::in | std::ios::out | std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        ASSERT_FALSE(text.empty());
        const auto place = random() % text.size();
        file.clear();
        file.seekp(static_cast<std::streamoff>(place));
        file.put(static_cast<char>(text[place] ^ (1 << random() % 8)));
    }

    SystemClock clock;
    CountedMachine machine;
    std::mt19937_64 random{7};
};

class MountedDisk : public Disk {
protected:
    void SetUp() override {
        if (!own_mounts()) GTEST_SKIP() << "this system lets nobody make mount namespaces";
        fs::create_directories(machine.kept());
        ASSERT_EQ(::mount("taktwerk", machine.kept().c_str(), "tmpfs", 0, "size=64k"), 0) << std::strerror(errno);
    }
    void TearDown() override {
        while (::umount2(machine.kept().c_str(), MNT_DETACH) == 0) {}
    }
    /// As a disk that the kernel has taken writing from, also for who has a file open there (the lock): the same disk once more over itself, read-only.
    void take_nothing() {
        const auto place = machine.kept();
        ASSERT_EQ(::mount(place.c_str(), place.c_str(), nullptr, MS_BIND, nullptr), 0) << std::strerror(errno);
        ASSERT_EQ(::mount(nullptr, place.c_str(), nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr), 0) << std::strerror(errno);
        ASSERT_EQ(::open((place / "none").c_str(), O_WRONLY | O_CREAT, 0600), -1);
        ASSERT_EQ(errno, EROFS);
    }
    /// The last one that was written stands there, as long as the disk does not take another one; then newer ones come.
    void expect_old_values_while(const std::function<void()>& spoil, const std::function<void()>& mend) {
        ASSERT_TRUE(until([&] { return on_disk() > 100; }));
        EXPECT_FALSE(alarm("retain_not_written"));
        spoil();
        ASSERT_TRUE(until([&] { return alarm("retain_not_written"); })) << machine.process().text();
        const auto old = on_disk();
        EXPECT_GT(old, 100);
        expect_counting();
        expect_counting();
        EXPECT_EQ(on_disk(), old) << "the old values stay";
        EXPECT_TRUE(alarm("retain_not_written"));
        mend();
        EXPECT_TRUE(until([&] { return !alarm("retain_not_written"); }));
        EXPECT_TRUE(until([&] { return on_disk() > old; })) << "it is written again";
        expect_counting();
    }
};

TEST_F(MountedDisk, IsFullTheOldValuesStayAndTheMachineRunsOn) {
    start();
    const auto rest = machine.kept() / "somebody_elses";
    expect_old_values_while(
        [&] {
            std::ofstream file(rest, std::ios::binary);
            while (file.put('x')) {}
        },
        [&] { fs::remove(rest); });
}

TEST_F(MountedDisk, TakesNothingMoreTheOldValuesStayAndTheMachineRunsOn) {
    start();
    expect_old_values_while([&] { take_nothing(); }, [&] { ASSERT_EQ(::umount2(machine.kept().c_str(), MNT_DETACH), 0); });
}

// Power fails while the disk is spoilt: what is found is the last that was written, whole.
TEST_F(MountedDisk, IsFullWhenThePowerFailsTheLastThatWasWrittenIsFound) {
    start();
    ASSERT_TRUE(until([&] { return on_disk() > 100; }));
    {
        std::ofstream file(machine.kept() / "somebody_elses", std::ios::binary);
        while (file.put('x')) {}
    }
    ASSERT_TRUE(until([&] { return alarm("retain_not_written"); }));
    expect_counting();
    const auto old = on_disk();
    (void)machine.cut_power();
    EXPECT_EQ(on_disk(), old);
    start();
    for (const auto& found : machine.told().found) EXPECT_EQ(found.load(), old);
    EXPECT_TRUE(until([&] { return alarm("retain_not_written"); })) << "known before anything depends on it";
}

TEST_F(Disk, ABitOfTheNewerFileFlipsTheOlderOneIsUsed) {
    for (int i = 0; i < 3; ++i) {
        start();
        ASSERT_TRUE(until([&] { return machine.read_kept().count > 100 && fs::exists(machine.kept() / "retain.1"); }));
        (void)machine.cut_power();
        const auto whole = machine.read_kept();
        ASSERT_TRUE(whole.damage.empty());
        const auto newest = [&] {
            for (const auto* slot : {"retain.0", "retain.1"}) {
                const auto other = machine.kept() / (slot == std::string("retain.0") ? "retain.1" : "retain.0");
                const auto aside = machine.at("aside");
                fs::rename(other, aside);
                const bool newer = machine.read_kept().count == whole.count;
                fs::rename(aside, other);
                if (newer) return slot;
            }
            return "";
        }();
        flip_a_bit(newest);
        const auto left = machine.read_kept();
        ASSERT_EQ(left.damage.size(), 1u);
        EXPECT_FALSE(left.lost);
        EXPECT_LT(left.count, whole.count);
        EXPECT_GT(left.count, 0);
        start();
        for (const auto& found : machine.told().found) EXPECT_EQ(found.load(), left.count);
        EXPECT_TRUE(machine.process().says("torn or altered", 10s)) << machine.process().text();
        EXPECT_FALSE(alarm("values_lost")) << "nothing older than one interval is gone";
        (void)machine.cut_power();
    }
}

TEST_F(Disk, BitsOfBothFilesFlipEverythingBeginsAnewWithAnAlarm) {
    start();
    ASSERT_TRUE(until([&] { return machine.read_kept().count > 100 && fs::exists(machine.kept() / "retain.1"); }));
    (void)machine.cut_power();
    flip_a_bit("retain.0");
    flip_a_bit("retain.1");
    EXPECT_TRUE(machine.read_kept().lost);
    machine.told().count = 0;
    start();
    for (const auto& found : machine.told().found) EXPECT_EQ(found.load(), 0);
    EXPECT_TRUE(alarm("values_lost"));
    EXPECT_TRUE(until([&] { return machine.read_kept().count > 100; })) << "and it is kept again";
    // While the runtime is up a flipped bit is written over.
    flip_a_bit("retain.0");
    flip_a_bit("retain.1");
    EXPECT_TRUE(until([&] { return machine.read_kept().damage.empty(); }));
    expect_counting();
    EXPECT_GT(on_disk(), 0);
}

}  // namespace
}  // namespace taktwerk::apps
