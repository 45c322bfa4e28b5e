// The memory of the scope: what was written comes out, whole and in order, and who is too late is told.
#include "runtime/recording/signal_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "core/guard/allocation_guard.hpp"
#include "runtime/recording/row_cursor.hpp"
#include "tests/patience.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;

/// Row c holds c, 10 c.
void write(SignalRing& ring, std::uint64_t cycle) {
    auto row = ring.begin(cycle);
    row.put(cycle);
    row.put(10 * cycle);
    ring.commit();
}

TEST(SignalRing, IsEmptyBeforeTheFirstRow) {
    const SignalRing ring{{}, 2, 4, 1ms};
    EXPECT_TRUE(ring.span().empty());
    std::array<std::uint64_t, 2> row{};
    EXPECT_FALSE(ring.read_row(1, row));
}

TEST(SignalRing, KeepsTheNewestRowsOfItsDepth) {
    SignalRing ring{{}, 2, 4, 1ms};
    for (std::uint64_t c = 1; c <= 3; ++c) write(ring, c);
    EXPECT_EQ(ring.span().first, 1u);
    EXPECT_EQ(ring.span().last, 3u);

    for (std::uint64_t c = 4; c <= 11; ++c) write(ring, c);

    EXPECT_EQ(ring.span().first, 8u);
    EXPECT_EQ(ring.span().last, 11u);
    const std::array<std::uint16_t, 2> words{1, 0};
    std::array<std::uint64_t, 8> out{};
    EXPECT_EQ(ring.read(8, 12, words, out), 8u) << "all right";
    EXPECT_EQ(out, (std::array<std::uint64_t, 8>{80, 90, 100, 110, 8, 9, 10, 11}));
}

// A machine's cycles need not begin at 1.
TEST(SignalRing, BeginsAtAnyCycle) {
    SignalRing ring{{}, 2, 4, 1ms};
    write(ring, 1000);
    write(ring, 1001);
    EXPECT_EQ(ring.span().first, 1000u);
    std::array<std::uint64_t, 2> row{};
    ASSERT_TRUE(ring.read_row(1001, row));
    EXPECT_EQ(row[1], 10010u);
    EXPECT_FALSE(ring.read_row(999, row));
    EXPECT_FALSE(ring.read_row(1002, row));
}

// The row that is being written stands where the one before the oldest stood: `depth` rows can be read even then.
TEST(SignalRing, ReadsItsWholeDepthWhileARowIsBeingWritten) {
    SignalRing ring{{}, 2, 4, 1ms};
    for (std::uint64_t c = 1; c <= 6; ++c) write(ring, c);
    auto half = ring.begin(7);
    half.put(std::uint64_t{7});

    const std::array<std::uint16_t, 1> words{1};
    std::array<std::uint64_t, 4> out{};
    EXPECT_EQ(ring.read(3, 7, words, out), 3u);
    EXPECT_EQ(out, (std::array<std::uint64_t, 4>{30, 40, 50, 60}));
    // With the next one begun, row 3 may be half overwritten: that is told.
    half.put(std::uint64_t{70});
    ring.commit();
    (void)ring.begin(8);
    EXPECT_EQ(ring.read(3, 7, words, out), 4u);
    for (std::uint64_t c = 8; c <= 30; ++c) write(ring, c);
    EXPECT_EQ(ring.read(3, 7, words, out), 7u) << "nothing of it is left";
}

TEST(SignalRing, ACursorGetsEachRowOnceAndCountsWhatItMissed) {
    SignalRing ring{{}, 2, 4, 1ms};
    RowCursor cursor{ring};
    EXPECT_TRUE(cursor.next().empty());
    write(ring, 1);
    write(ring, 2);
    EXPECT_EQ(cursor.next()[0], 1u);
    EXPECT_EQ(cursor.next()[0], 2u);
    EXPECT_TRUE(cursor.next().empty());

    for (std::uint64_t c = 3; c <= 9; ++c) write(ring, c);

    EXPECT_EQ(cursor.next()[0], 6u) << "3, 4 and 5 were overwritten";
    EXPECT_EQ(ring.lost(), 3u);
}

TEST(SignalRing, WritingUsesNoHeap) {
    SignalRing ring{{}, 2, 100, 1ms};
    ring.touch();
    const NoAllocationScope scope;
    for (std::uint64_t c = 1; c <= 250; ++c) write(ring, c);
    EXPECT_EQ(scope.used().total(), 0u) << scope.used().text();
}

// A small ring and a writer that never waits: readers are overrun again and again, and what they are told is right is right.
TEST(SignalRing, AReaderBesideTheWriterIsNeverLiedTo) {
    constexpr std::size_t words = 24, depth = 50;
    SignalRing ring{{}, words, depth, 1ms};
    std::atomic<bool> ended{false};
    std::thread writer{[&] {
        for (std::uint64_t c = 1; !ended.load(std::memory_order_relaxed); ++c) {
            auto row = ring.begin(c);
            for (std::uint64_t w = 0; w < words; ++w) row.put(c * 1000 + w);
            ring.commit();
        }
    }};
    const std::vector<std::uint16_t> all{0, 5, 11, 23};
    std::vector<std::uint64_t> out(all.size() * depth), row(words);
    std::uint64_t good = 0, late = 0, wrong = 0;
    for (auto patience = Patience::of_threads(); patience.lasts(good < 20000 || late < 20);) {
        const auto there = ring.span();
        if (there.empty()) continue;
        const auto count = there.last + 1 - there.first;
        const auto right = ring.read(there.first, there.last + 1, all, out);
        late += right - there.first;
        for (auto c = right; c <= there.last; ++c, ++good)
            for (std::size_t w = 0; w < all.size(); ++w) wrong += out[w * count + (c - there.first)] != c * 1000 + all[w];
        if (ring.read_row(there.last, row))
            for (std::uint64_t w = 0; w < words; ++w) wrong += row[w] != there.last * 1000 + w;
    }
    ended = true;
    writer.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_GE(good, 20000u);
    EXPECT_GE(late, 20u) << "nobody was ever overrun: this test has shown nothing";
}

TEST(SignalCell, ReadsNumbersOutOfAWord) {
    using Coding = SignalCell::Coding;
    const std::uint64_t word = 0xFFFF'FF9C'0000'A5F1;  // upper half: -100
    EXPECT_EQ((SignalCell{0, 0, 4, Coding::natural, 1}.value_of(word)), 1.0);
    EXPECT_EQ((SignalCell{0, 4, 8, Coding::natural, 1}.value_of(word)), 0x5F);
    EXPECT_EQ((SignalCell{0, 15, 1, Coding::natural, 1}.value_of(word)), 1.0);
    EXPECT_EQ((SignalCell{0, 32, 32, Coding::integer, 1e3}.value_of(word)), -0.1);
    EXPECT_EQ((SignalCell{0, 0, 64, Coding::integer, 1e9}.value_of(1'500'000'000)), 1.5);
    EXPECT_EQ((SignalCell{0, 0, 64, Coding::real, 1}.value_of(std::bit_cast<std::uint64_t>(-2.25))), -2.25);
}

}  // namespace
}  // namespace taktwerk::runtime
