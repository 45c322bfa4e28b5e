#include "core/guard/allocation_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "core/histogram.hpp"
#include "core/latest_value.hpp"
#include "core/recorder.hpp"
#include "core/spsc_ring.hpp"
#include "core/stopwatch.hpp"
#include "tests/patience.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MALLOC_IS_THE_SANITIZERS 1
#endif

namespace taktwerk {
namespace {

// The compiler may remove a matching new and delete: it must not see the pointer's end.
void* volatile sink;

TEST(NoAllocation, NewAndDeleteInTheScopeAreDetected) {
    NoAllocationScope scope;
    auto* memory = new int{1};
    sink = memory;
    const HeapUse after_new = scope.used();
    delete memory;
    const HeapUse after_delete = scope.used();

    EXPECT_EQ(after_new.allocations, 1u);
    EXPECT_EQ(after_new.first_size, sizeof(int));
    EXPECT_GT(after_new.backtrace_depth, 2u);
    EXPECT_EQ(after_delete.frees, 1u);
}

TEST(NoAllocation, AThreadThatAllocatesInItsScopeIsDetected) {
    HeapUse use;
    std::thread{[&] {
        NoAllocationScope scope;
        std::vector<int> grows;
        grows.push_back(1);
        sink = grows.data();
        use = scope.used();
    }}.join();
    EXPECT_EQ(use.allocations, 1u);
}

TEST(NoAllocation, MallocAndItsFamilyAreDetected) {
#if defined(MALLOC_IS_THE_SANITIZERS)
    GTEST_SKIP() << "sanitizers bring their own malloc; here only new and delete are counted";
#else
    NoAllocationScope scope;
    void* a = std::malloc(10);
    a = std::realloc(a, 100'000);
    void* b = std::calloc(3, 3);
    void* c = std::aligned_alloc(64, 128);
    void* d = nullptr;
    const int refused = posix_memalign(&d, 32, 100);
    for (void* memory : {a, b, c, d}) {
        sink = memory;
        std::free(memory);
    }
    const HeapUse use = scope.used();

    EXPECT_EQ(refused, 0);
    EXPECT_EQ(use.allocations, 5u);
    EXPECT_EQ(use.frees, 4u);
    EXPECT_EQ(use.first_size, 10u);
#endif
}

TEST(NoAllocation, OutsideOfTheScopeAndOnOtherThreadsNothingCounts) {
    sink = new int{1};
    delete static_cast<int*>(sink);
    std::atomic<int> phase{0};
    std::thread other{[&] {
        for (auto patience = Patience::of_threads(); patience.lasts(phase != 1);) std::this_thread::yield();
        sink = new int{2};
        delete static_cast<int*>(sink);
        phase = 2;
    }};

    HeapUse use;
    {
        NoAllocationScope scope;
        phase = 1;
        for (auto patience = Patience::of_threads(); patience.lasts(phase != 2);) std::this_thread::yield();
        use = scope.used();
    }
    other.join();

    EXPECT_EQ(use.total(), 0u) << use.text();
}

TEST(NoAllocation, AnInnerScopeCountsItsOwnAndTheOuterOneAll) {
    NoAllocationScope outer;
    sink = new int{1};
    std::uint64_t inner_count = 0;
    {
        NoAllocationScope inner;
        delete static_cast<int*>(sink);
        inner_count = inner.used().total();
    }
    const HeapUse use = outer.used();
    EXPECT_EQ(inner_count, 1u);
    EXPECT_EQ(use.total(), 2u);
}

TEST(NoAllocation, TheReportNamesNumberSizeAndPlace) {
    NoAllocationScope scope;
    sink = new std::array<char, 321>;
    delete static_cast<std::array<char, 321>*>(sink);
    const HeapUse use = scope.used();
    EXPECT_THAT(use.text(), testing::HasSubstr("1 allocations and 1 frees, the first of 321 bytes\n"));
}

TEST(NoAllocationDeathTest, AbortModeEndsTheProcessAtTheCulprit) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_DEATH(
        {
            NoAllocationScope scope{NoAllocationScope::On::allocation_abort};
            sink = new int{1};
        },
        "heap used within a NoAllocationScope");
}

// What core offers for the cycle path keeps its promise.
TEST(NoAllocation, RingsHistogramsRecorderAndSnapshotsDoNotTouchTheHeap) {
    SpscRing<int> ring{4};
    LatestValue<std::vector<int>> latest{std::vector<int>(100)};
    Recorder recorder{1024, Recorder::Policy::overwrite_oldest};
    auto statistics = std::make_unique<StepStatistics<2>>(std::array<std::string_view, 2>{"a", "b"});
    const std::array<std::byte, 100> bytes{};

    NoAllocationScope scope;
    for (int i = 0; i < 50; ++i) {
        statistics->begin();
        ring.try_push(i);
        int out = 0;
        if (i % 2 == 0) ring.try_pop(out);
        statistics->done(0);
        for (int& x : latest.back()) x = i;
        latest.publish();
        (void)latest.read();
        recorder.append(0, Instant{}, bytes);
        statistics->done(1);
        statistics->end();
    }
    const HeapUse use = scope.used();

    EXPECT_EQ(use.total(), 0u) << use.text();
}

}  // namespace
}  // namespace taktwerk
