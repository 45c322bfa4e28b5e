// A window of signals: every value, or the smallest and the largest of each k cycles, looked for in every sample.
#include "runtime/recording/thinned_read.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/recording/signal_ring.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using Coding = SignalCell::Coding;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::vector<RecordedSignal> time_and_two() {
    return {{"time_s", "s", SignalKind::real, SignalGroup::machine, "", "", "", {0, 0, 64, Coding::integer, 1e9}},
            {"x.a", "mm", SignalKind::real, SignalGroup::axis, "x", "", "", {1, 0, 64, Coding::real, 1}},
            {"x.b", "", SignalKind::bit, SignalGroup::axis, "x", "", "", {2, 3, 1, Coding::natural, 1}}};
}

void write(SignalRing& ring, std::uint64_t cycle, double a, bool b = false) {
    auto row = ring.begin(cycle);
    row.put(Duration{cycle * 1'000'000});
    row.put(a);
    row.put(std::uint64_t{b ? 8u : 0u});
    ring.commit();
}

ThinnedRead read_all(const SignalRows& rows, const std::vector<std::string>& names, ThinnedRead::Window window,
                     std::size_t a_step = 1'000'000) {
    std::vector<const RecordedSignal*> signals;
    for (const auto& name : names) signals.push_back(rows.find(name));
    ThinnedRead read{rows, signals, window};
    for (int steps = 0; steps < 100000; ++steps)
        if (auto cells = a_step; read.step(cells)) return read;
    ADD_FAILURE() << "does not end";
    return read;
}

TEST(ThinnedRead, GivesEachValueWhereOneCycleIsWanted) {
    SignalRing ring{time_and_two(), 3, 10, 1ms};
    for (std::uint64_t c = 1; c <= 5; ++c) write(ring, c, 0.5 * static_cast<double>(c), c == 4);

    const auto read = read_all(ring, {"x.b", "x.a"}, {2, 6, 1});

    EXPECT_EQ(read.from(), 2u);
    EXPECT_EQ(read.to(), 6u);
    EXPECT_EQ(read.missing(), 0u);
    EXPECT_EQ(read.time(), Instant{2ms});
    EXPECT_EQ(read.values()[0], (std::vector<double>{0, 0, 1, 0}));
    EXPECT_EQ(read.values()[1], (std::vector<double>{1, 1.5, 2, 2.5}));
}

TEST(ThinnedRead, GivesPairsAndTheLastOneOfWhatIsLeft) {
    SignalRing ring{time_and_two(), 3, 10, 1ms};
    for (const auto& [c, a] : {std::pair{1, 3.0}, {2, -7.0}, {3, 1.0}, {4, 2.0}, {5, 9.0}}) write(ring, static_cast<std::uint64_t>(c), a);

    const auto read = read_all(ring, {"x.a"}, {1, 6, 2});

    EXPECT_EQ(read.values()[0], (std::vector<double>{-7, 3, 1, 2, 9, 9}));
}

// "NaN: nothing was there": beside numbers it does not count, alone it stays.
TEST(ThinnedRead, ANaNNeverHidesAnExtreme) {
    SignalRing ring{time_and_two(), 3, 10, 1ms};
    const double endless = std::numeric_limits<double>::infinity();
    const std::vector<double> values{nothing, 5, nothing, nothing, -endless, endless};
    for (std::size_t i = 0; i < values.size(); ++i) write(ring, i + 1, values[i]);

    const auto read = read_all(ring, {"x.a"}, {1, 7, 2});

    EXPECT_EQ(read.values()[0][0], 5);
    EXPECT_EQ(read.values()[0][1], 5);
    EXPECT_TRUE(std::isnan(read.values()[0][2]) && std::isnan(read.values()[0][3]));
    EXPECT_EQ(read.values()[0][4], -endless);
    EXPECT_EQ(read.values()[0][5], endless);
}

TEST(ThinnedRead, SaysWhatIsNoLongerThereAndBeginsWhereSomethingIs) {
    SignalRing ring{time_and_two(), 3, 4, 1ms};
    for (std::uint64_t c = 1; c <= 10; ++c) write(ring, c, static_cast<double>(c));

    const auto old = read_all(ring, {"x.a"}, {2, 9, 1});
    EXPECT_EQ(old.from(), 7u);
    EXPECT_EQ(old.to(), 9u);
    EXPECT_EQ(old.missing(), 5u);
    EXPECT_EQ(old.values()[0], (std::vector<double>{7, 8}));

    const auto future = read_all(ring, {"x.a"}, {9, 14, 1});
    EXPECT_EQ(future.to(), 11u);
    EXPECT_EQ(future.missing(), 3u);

    // Who reads on from where it has been misses nothing by asking too early.
    const auto early = read_all(ring, {"x.a"}, {11, 11, 1});
    EXPECT_EQ(early.from(), 11u);
    EXPECT_EQ(early.to(), 11u);
    EXPECT_EQ(early.missing(), 0u);

    const auto gone = read_all(ring, {"x.a"}, {1, 3, 1});
    EXPECT_EQ(gone.missing(), 2u);
    EXPECT_TRUE(gone.values()[0].empty());
}

// Overwritten between two steps: before the first value the window shrinks, behind it there are gaps.
TEST(ThinnedRead, AReaderThatIsOvertakenHasGapsAndSaysHowMany) {
    SignalRing ring{time_and_two(), 3, 4, 1ms};
    for (std::uint64_t c = 1; c <= 4; ++c) write(ring, c, static_cast<double>(c));
    ThinnedRead read{ring, {ring.find("x.a")}, {1, 5, 1}};
    std::size_t cells = 1;
    EXPECT_FALSE(read.step(cells));

    for (std::uint64_t c = 5; c <= 7; ++c) write(ring, c, static_cast<double>(c));  // 2 is gone, 3 stands where 8 will

    cells = 1000;
    EXPECT_TRUE(read.step(cells));
    EXPECT_EQ(read.from(), 1u);
    ASSERT_EQ(read.values()[0].size(), 4u);
    EXPECT_EQ(read.values()[0][0], 1);
    EXPECT_TRUE(std::isnan(read.values()[0][1]));
    EXPECT_EQ(read.values()[0][2], 3);
    EXPECT_EQ(read.values()[0][3], 4);
    EXPECT_EQ(read.missing(), 1u);
}

// Whatever is written, windowed and thinned, in whatever steps: the pairs are the extremes of what was written.
TEST(ThinnedRead, RandomWindowsAgreeWithWhatWasWritten) {
    std::mt19937_64 random{20};
    const auto draw = [&](std::uint64_t low, std::uint64_t high) {
        return std::uniform_int_distribution<std::uint64_t>{low, high}(random);
    };
    for (std::size_t round = 0; round < property_cases(300); ++round) {
        const auto depth = draw(1, 700), rows = draw(1, 1500);
        SignalRing ring{time_and_two(), 3, depth, 1ms};
        std::vector<double> written{0};  // by cycle
        double walk = 0;
        for (std::uint64_t c = 1; c <= rows; ++c) {
            walk += std::uniform_real_distribution<double>{-1, 1}(random);
            written.push_back(draw(0, 20) == 0 ? nothing : walk);
            write(ring, c, written.back(), draw(0, 1) == 1);
        }
        const auto from = draw(1, rows + 5), to = draw(from, rows + 10), per = draw(1, 40);
        const auto read = read_all(ring, {"x.a"}, {from, to, per}, draw(1, 600));

        const auto first = rows > depth ? rows - depth + 1 : 1;
        const auto begin = from > rows ? from : std::clamp(from, first, std::max(first, to)),
                   end = from > rows ? from : std::clamp(to, begin, rows + 1);
        ASSERT_EQ(read.from(), std::min(begin, std::max(end, from))) << round;
        ASSERT_EQ(read.to() - read.from() + read.missing(), to - from) << round;
        std::vector<double> expected;
        for (auto c = read.from(); c < read.to(); c += per) {
            double low = nothing, high = nothing;
            for (auto i = c; i < std::min(c + per, read.to()); ++i) low = std::fmin(low, written[i]), high = std::fmax(high, written[i]);
            expected.push_back(low);
            if (per > 1) expected.push_back(high);
        }
        ASSERT_EQ(read.values()[0].size(), expected.size()) << round;
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_TRUE(read.values()[0][i] == expected[i] || (std::isnan(read.values()[0][i]) && std::isnan(expected[i])))
                << round << " " << i;
    }
}

}  // namespace
}  // namespace taktwerk::runtime
