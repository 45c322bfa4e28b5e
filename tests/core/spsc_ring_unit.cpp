#include "core/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/patience.hpp"

namespace taktwerk {
namespace {

TEST(SpscRing, ValuesComeOutInTheOrderTheyWentIn) {
    SpscRing<int> ring{4};
    int out = -1;
    EXPECT_FALSE(ring.try_pop(out));
    EXPECT_EQ(out, -1);

    for (int round = 0; round < 5; ++round) {  // several times round the storage
        for (int i = 0; i < 3; ++i) ASSERT_TRUE(ring.try_push(10 * round + i));
        EXPECT_EQ(ring.size(), 3u);
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(ring.try_pop(out));
            EXPECT_EQ(out, 10 * round + i);
        }
    }
    EXPECT_EQ(ring.size(), 0u);
}

TEST(SpscRing, WhatDoesNotFitIsRefusedAndCounted) {
    SpscRing<int> ring{2};
    EXPECT_TRUE(ring.try_push(1));
    EXPECT_TRUE(ring.try_push(2));

    EXPECT_FALSE(ring.try_push(3));
    EXPECT_FALSE(ring.try_push(4));

    EXPECT_EQ(ring.dropped(), 2u);
    int out = 0;
    EXPECT_TRUE(ring.try_pop(out));
    EXPECT_EQ(out, 1);  // the old ones stay
    EXPECT_TRUE(ring.try_push(5));
}

TEST(SpscRing, CapacityIsRoundedUpToAPowerOfTwo) {
    EXPECT_EQ(SpscRing<int>{0}.capacity(), 1u);
    EXPECT_EQ(SpscRing<int>{5}.capacity(), 8u);
    EXPECT_EQ(SpscRing<int>{8}.capacity(), 8u);
}

struct Wide {
    std::uint64_t a = 0, b = 0, c = 0;
};

TEST(SpscRing, TwoThreadsLoseNothingAndTearNothing) {
    constexpr std::uint64_t count = 50'000;
    SpscRing<Wide> ring{8};
    std::thread producer{[&] {
        auto patience = Patience::of_threads();
        for (std::uint64_t i = 1; i <= count; ++i)
            while (patience.lasts(!ring.try_push({i, ~i, i * 3}))) std::this_thread::yield();
    }};

    std::uint64_t wrong = 0;
    auto patience = Patience::of_threads();
    for (std::uint64_t i = 1; i <= count; ++i) {
        Wide got;
        while (patience.lasts(!ring.try_pop(got))) std::this_thread::yield();
        if (got.a != i || got.b != ~i || got.c != i * 3) ++wrong;
    }
    producer.join();

    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(ring.size(), 0u);
}

}  // namespace
}  // namespace taktwerk
