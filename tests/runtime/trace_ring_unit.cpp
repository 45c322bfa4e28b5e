#include "runtime/recording/trace_ring.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/patience.hpp"

namespace taktwerk::runtime {
namespace {

TEST(TraceRing, RowsComeOutInOrderAndWhole) {
    TraceRing ring{{"a", "b"}, 4};
    for (int i = 0; i < 3; ++i) {
        auto row = ring.begin();
        ASSERT_EQ(row.size(), 2u);
        row[0] = i;
        row[1] = 10 * i;
        ring.commit();
    }
    for (int i = 0; i < 3; ++i) {
        const auto row = ring.front();
        ASSERT_EQ(row.size(), 2u);
        EXPECT_EQ(row[0], i);
        EXPECT_EQ(row[1], 10 * i);
        ring.release();
    }
    EXPECT_TRUE(ring.front().empty());
}

TEST(TraceRing, ARowWithoutRoomIsDroppedAndCountedAndTheOldOnesStay) {
    TraceRing ring{{"a"}, 3};  // rounded up to 4
    for (int i = 0; i < 6; ++i) {
        auto row = ring.begin();
        if (row.empty()) continue;
        row[0] = i;
        ring.commit();
    }
    EXPECT_EQ(ring.dropped(), 2u);
    EXPECT_EQ(ring.front()[0], 0.0);
    ring.release();
    EXPECT_FALSE(ring.begin().empty()) << "one was read: there is room for one";
}

TEST(TraceRing, AReaderBesideTheWriterSeesEveryRowOnce) {
    TraceRing ring{{"a", "b"}, 8};
    constexpr int rows = 20000;
    std::thread writer{[&] {
        auto patience = Patience::of_threads();
        for (int i = 0; i < rows;) {
            auto row = ring.begin();
            if (row.empty()) {
                if (!patience.lasts(true)) return;
                std::this_thread::yield();
                continue;
            }
            row[0] = row[1] = i++;
            ring.commit();
        }
    }};
    int expected = 0, wrong = 0;
    for (auto patience = Patience::of_threads(); patience.lasts(expected < rows);) {
        const auto row = ring.front();
        if (row.empty()) {
            std::this_thread::yield();
            continue;
        }
        wrong += row[0] != expected || row[1] != expected;
        ring.release();
        ++expected;
    }
    writer.join();

    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(expected, rows);
}

}  // namespace
}  // namespace taktwerk::runtime
