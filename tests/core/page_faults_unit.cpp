#include "core/page_faults.hpp"
#include "core/realtime.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

namespace taktwerk {
namespace {

// proc_pid_stat(5): (10) minflt, (12) majflt.
TEST(PageFaults, TheTenthAndTheTwelfthFieldOfTheKernelsLine) {
    const auto faults = page_faults_in("4242 (taktwerk) S 1 4242 4242 0 -1 4194368 1234 5 67 8 100 200 0 0 20 0 9 0 12345 0 0");
    ASSERT_TRUE(faults);
    EXPECT_EQ(faults->minor, 1234u);
    EXPECT_EQ(faults->major, 67u);
}

TEST(PageFaults, AThreadMayBeCalledAnything) {
    const auto faults = page_faults_in("1 (a) S 9 9 9) R 1 1 1 0 -1 0 7 0 3 0\n");
    ASSERT_TRUE(faults);
    EXPECT_EQ(*faults, (PageFaults{7, 3}));
}

TEST(PageFaults, WhatIsNoSuchLineIsNothing) {
    for (const auto* text : {"", "1 taktwerk S 1 1 1 0 -1 0 7 0 3 0", "1 (t) S 1 1 1 0 -1 0 7 0", "1 (t) S 1 1 1 0 -1 0 x 0 3 0",
                             "1 (t) S 1 1 1 0 -1 0 -7 0 3 0", "1 (t) S 1 1 1 0 -1 0 7 0 3x"})
        EXPECT_FALSE(page_faults_in(text)) << text;
}

// A new private page each: one minor fault each, no more than a few of the test's own besides.
TEST(PageFaults, CountsThoseOfThisThread) {
    constexpr std::size_t pages = 64, page = 4096;
    auto* memory = static_cast<volatile char*>(::mmap(nullptr, pages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(memory, MAP_FAILED);
    ::madvise(const_cast<char*>(memory), pages * page, MADV_NOHUGEPAGE);
    const ThreadPageFaults mine{this_thread_number()};
    (void)mine.read();  // its own first way
    const auto before = mine.read();
    for (std::size_t i = 0; i < pages; ++i) memory[i * page] = 1;
    const auto after = mine.read();
    ::munmap(const_cast<char*>(memory), pages * page);
    ASSERT_TRUE(before && after);
    EXPECT_GE(after->minor - before->minor, pages);
}

TEST(PageFaults, AThreadThatIsNotThereHasNone) { EXPECT_FALSE(ThreadPageFaults{-1}.read()); }

}  // namespace
}  // namespace taktwerk
