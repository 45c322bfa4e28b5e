#include "core/latest_value.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/patience.hpp"

namespace taktwerk {
namespace {

TEST(LatestValue, BeforeTheFirstPublishTheReaderSeesThePrototype) {
    LatestValue<int> latest{7};
    latest.back() = 8;  // not published

    const auto got = latest.read();

    EXPECT_EQ(*got.value, 7);
    EXPECT_FALSE(got.is_new);
}

TEST(LatestValue, TheReaderGetsTheNewestAndIsToldOnceThatItIsNew) {
    LatestValue<int> latest{0};
    for (int i = 1; i <= 3; ++i) {
        latest.back() = i;
        latest.publish();
    }

    const auto first = latest.read();
    EXPECT_EQ(*first.value, 3);
    EXPECT_TRUE(first.is_new);
    const auto second = latest.read();
    EXPECT_EQ(*second.value, 3);
    EXPECT_FALSE(second.is_new);
}

TEST(LatestValue, WhatTheReaderHoldsIsNotTouchedByTheWriter) {
    LatestValue<int> latest{0};
    latest.back() = 1;
    latest.publish();
    const auto held = latest.read();

    for (int i = 2; i < 10; ++i) {
        latest.back() = i;
        latest.publish();
        ASSERT_EQ(*held.value, 1);
    }

    EXPECT_EQ(*latest.read().value, 9);
}

TEST(LatestValue, TwoThreadsNeverSeeAMixtureNorGoBack) {
    constexpr std::uint64_t count = 30'000;
    LatestValue<std::vector<std::uint64_t>> latest{std::vector<std::uint64_t>(16)};
    std::thread writer{[&] {
        for (std::uint64_t i = 1; i <= count; ++i) {
            for (auto& word : latest.back()) word = i;
            latest.publish();
        }
    }};

    std::uint64_t last = 0, mixed = 0, backwards = 0;
    for (auto patience = Patience::of_threads(); patience.lasts(last < count);) {
        const auto got = latest.read();
        for (const auto word : *got.value) mixed += word != got.value->front();
        backwards += got.value->front() < last;
        if (got.is_new == (got.value->front() == last)) ++mixed;  // "new" exactly when another value came
        last = got.value->front();
        if (!got.is_new) std::this_thread::yield();
    }
    writer.join();

    EXPECT_EQ(mixed, 0u);
    EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace taktwerk
