#include "core/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

static_assert(std::is_trivially_copyable_v<Histogram>);

TEST(Histogram, BucketsFollowEachOtherWithoutGapsAndAreAtMostASixteenthWide) {
    for (std::size_t i = 0; i < Histogram::bucket_count; ++i) {
        const auto first = Histogram::bucket_first(i), last = Histogram::bucket_last(i);
        ASSERT_LE(first, last);
        ASSERT_LE(16 * (last - first), first);
        ASSERT_EQ(Histogram::bucket_of(first), i);
        ASSERT_EQ(Histogram::bucket_of(last), i);
    }
    EXPECT_GT(Histogram::bucket_last(Histogram::bucket_count - 1), Duration{100s}.count());
}

TEST(Histogram, PercentilesMatchTheSortedSamplesWithinABucket) {
    std::mt19937_64 random{7};
    std::lognormal_distribution<double> spread{10.0, 2.0};  // 22 us typical, a long tail
    Histogram histogram;
    std::vector<std::int64_t> samples;
    for (int i = 0; i < 20'000; ++i) {
        samples.push_back(static_cast<std::int64_t>(spread(random)));
        histogram.record(Duration{samples.back()});
    }
    std::sort(samples.begin(), samples.end());

    for (const double percent : {0.0, 1.0, 25.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
        const auto rank = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(percent / 100 * double(samples.size()))));
        const std::int64_t exact = samples[rank - 1];
        EXPECT_GE(histogram.percentile(percent).count(), exact) << percent;
        EXPECT_LE(histogram.percentile(percent).count(), exact + exact / 16) << percent;
    }
    EXPECT_EQ(histogram.percentile(100), histogram.max());
}

TEST(Histogram, CountMeanMinAndMaxAreExact) {
    Histogram histogram;
    EXPECT_EQ(histogram.percentile(50), 0ns);
    EXPECT_EQ(histogram.mean(), 0ns);

    for (const auto d : {Duration{100us}, Duration{300us}, Duration{201us}, Duration{203us}}) histogram.record(d);

    EXPECT_EQ(histogram.count(), 4u);
    EXPECT_EQ(histogram.min(), 100us);
    EXPECT_EQ(histogram.max(), 300us);
    EXPECT_EQ(histogram.mean(), 201us);
}

TEST(Histogram, ValuesBeyondItsRangeKeepTheirMaximumAndNegativeOnesCountAsZero) {
    Histogram histogram;
    histogram.record(-5ns);
    EXPECT_EQ(histogram.max(), 0ns);
    histogram.record(1h);

    EXPECT_EQ(histogram.count(), 2u);
    EXPECT_EQ(histogram.min(), 0ns);
    EXPECT_EQ(histogram.max(), 1h);
    EXPECT_EQ(histogram.percentile(100), 1h);
}

TEST(Histogram, MergingIsRecordingEverythingInOne) {
    Histogram a, b, both, empty;
    for (int i = 1; i < 100; ++i) {
        const Duration d{i * i * 1000};
        (i % 3 == 0 ? a : b).record(d);
        both.record(d);
    }

    a.merge(b);
    a.merge(empty);
    empty.merge(both);

    for (const Histogram* merged : {&a, &empty}) {
        EXPECT_EQ(merged->count(), both.count());
        EXPECT_EQ(merged->min(), both.min());
        EXPECT_EQ(merged->max(), both.max());
        EXPECT_EQ(merged->mean(), both.mean());
        for (std::size_t i = 0; i < Histogram::bucket_count; ++i) ASSERT_EQ(merged->bucket(i), both.bucket(i));
    }
}

TEST(Histogram, ResetForgetsEverything) {
    Histogram histogram;
    histogram.record(1ms);
    histogram.reset();
    EXPECT_EQ(histogram.count(), 0u);
    EXPECT_EQ(histogram.max(), 0ns);
    histogram.record(5ms);
    EXPECT_EQ(histogram.min(), 5ms);
}

}  // namespace
}  // namespace taktwerk
