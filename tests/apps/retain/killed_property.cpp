// kill -9 of a whole runtime whose program counts, at random instants of its life: what the next start finds is never torn, never ahead of what was counted,
// and never older than the stated interval and the time that the disk takes for one writing (docs/retain.md). In real time, and in
// virtual time, where writing takes no machine time: there the interval holds to the cycle. 50 kills; TAKTWERK_SOAK_FACTOR=20, as at night: 1,000.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "core/clock.hpp"
#include "tests/apps/retain/counted_machine.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

/// What the disk takes for what a writing of the store does, beside it and at the same time.
class DiskBeside {
public:
    explicit DiskBeside(std::filesystem::path folder) : folder_(std::move(folder)) {}
    void write_once() {
        const auto began = clock_.now();
        const auto beside = folder_ / "beside.new", place = folder_ / "beside";
        const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        const std::string text(4096, 'x');
        EXPECT_EQ(::write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
        EXPECT_EQ(::fsync(file), 0);
        ::close(file);
        std::filesystem::rename(beside, place);
        const int directory = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        EXPECT_EQ(::fsync(directory), 0);
        ::close(directory);
        longest_ = std::max(longest_, clock_.now() - began);
    }
    [[nodiscard]] Duration longest() const { return longest_; }

private:
    std::filesystem::path folder_;
    SystemClock clock_;
    Duration longest_{};
};

struct Lost {
    Duration most{}, slowest{};
    int in_bring_up = 0, with_a_rest = 0, late = 0;
};

class KilledRuntime : public ::testing::TestWithParam<CountedMachine::Time> {
protected:
    using Time = CountedMachine::Time;

    bool until(const std::function<bool()>& condition, Duration patience) {
        const auto end = clock.now() + patience;
        while (!condition()) {
            if (clock.now() > end) return false;
            clock.sleep_until(clock.now() + 1ms);
        }
        return true;
    }
    void wait_beside(Duration time, DiskBeside& disk) {
        const auto end = clock.now() + time;
        do {
            disk.write_once();
            clock.sleep_until(std::min(end, clock.now() + 10ms));
        } while (clock.now() < end);
    }
    Duration drawn(Duration most) { return Duration{static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most.count()))}; }
    void expect_found() {
        auto& told = machine.told();
        for (const auto& found : told.found) ASSERT_EQ(found.load(), kept) << "the program found something else than stands on the disk";
        ASSERT_EQ(told.found_block.load(), (kept + 1) / 2) << "the counter's block is of another scan than the variables";
    }
    /// Machine time from the first scan that is not kept to the last one that was made.
    Duration gone(std::int64_t counted) {
        const auto since = [&](std::int64_t count) {
            return machine.told().since[static_cast<std::size_t>(count) % ToldCount::remembered].load();
        };
        return counted > kept ? Duration{since(counted) - since(kept + 1)} : Duration{};
    }
    void judge(std::int64_t counted, const DiskBeside& disk, bool waited) {
        const auto found = machine.read_kept();
        ASSERT_TRUE(found.damage.empty()) << found.damage.front().text();
        ASSERT_FALSE(found.torn);
        ASSERT_GE(found.count, kept) << "what was kept once is gone";
        ASSERT_LE(found.count, counted) << "more than was ever counted";
        kept = found.count;
        lost.most = std::max(lost.most, gone(counted));
        lost.slowest = std::max(lost.slowest, disk.longest());
        // In real time a writing, the rest of one that was under way, and what a busy computer lets the thread wait that does it.
        const bool of_disk = GetParam() == Time::real;
        const Duration allowed =
            of_disk ? CountedMachine::every + 2 * disk.longest() + 300ms : CountedMachine::every + CountedMachine::cycle;
        if (waited || !of_disk) {
            ASSERT_LE(gone(counted), allowed) << gone(counted) / 1ms << " ms are lost; the disk took " << disk.longest() / 1ms << " ms";
        }
        if (gone(counted) > CountedMachine::every + disk.longest()) ++lost.late;
    }
    void kill_once(int number) {
        auto& told = machine.told();
        DiskBeside disk{machine.at("")};
        const auto starts = told.starts.load();
        machine.switch_on(GetParam());
        // One of five anywhere on its way up, the others in what it does for ever.
        const bool waited = number % 5 != 0;
        if (waited) {
            ASSERT_TRUE(until([&] { return told.starts > starts && told.count > kept; }, 60s)) << machine.process().text();
            wait_beside(drawn(250ms), disk);
        } else clock.sleep_until(clock.now() + drawn(GetParam() == Time::real ? 700ms : 150ms));
        const auto said = machine.cut_power();
        SCOPED_TRACE(said);
        if (told.starts == starts) ++lost.in_bring_up;
        else {
            ASSERT_NO_FATAL_FAILURE(expect_found());
        }
        for (const auto* beside : {"retain.0.new", "retain.1.new"})
            lost.with_a_rest += std::filesystem::exists(machine.kept() / beside) ? 1 : 0;
        ASSERT_NO_FATAL_FAILURE(judge(told.count, disk, waited));
        told.count = kept;  // what is counted next goes on from there
    }

    SystemClock clock;
    CountedMachine machine;
    std::mt19937_64 random{16};
    std::int64_t kept = 0;
    Lost lost;
};

TEST_P(KilledRuntime, AtRandomInstantsNothingIsTornAndNoMoreIsLostThanIsStated) {
    const auto kills = static_cast<int>(property_cases(GetParam() == Time::real ? 15 : 35));
    for (int i = 0; i < kills; ++i) {
        SCOPED_TRACE("kill " + std::to_string(i));
        ASSERT_NO_FATAL_FAILURE(kill_once(i));
    }
    std::printf(
        "%d kills, %d of them on the way up, %d within a writing; %lld scans kept; at most %lld ms lost, the disk took %lld ms at most; %d "
        "over "
        "the interval and that\n",
        kills, lost.in_bring_up, lost.with_a_rest, static_cast<long long>(kept), static_cast<long long>(lost.most / 1ms),
        static_cast<long long>(lost.slowest / 1ms), lost.late);
    EXPECT_GT(kept, kills) << "it counts";
    EXPECT_GT(lost.most, Duration{}) << "no kill lost anything: it was not looked at";
}

INSTANTIATE_TEST_SUITE_P(Time, KilledRuntime, ::testing::Values(CountedMachine::Time::real, CountedMachine::Time::as_fast_as_it_goes),
                         [](const auto& time) { return time.param == CountedMachine::Time::real ? "Real" : "AsFastAsItGoes"; });

}  // namespace
}  // namespace taktwerk::apps
