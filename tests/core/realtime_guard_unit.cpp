#include "core/realtime_guard.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <thread>

#include "core/cyclic_thread.hpp"

// Sanitizers make system calls of their own on every thread.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_UNDER_SANITIZERS() GTEST_SKIP() << "sanitizers make system calls of their own"
#else
#define SKIP_UNDER_SANITIZERS() static_cast<void>(0)
#endif

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

/// Runs `work` on a thread of its own that is restricted first; what it tried is read before the thread ends.
template <class Work>
ForbiddenSystemCalls on_a_restricted_thread(Work work, std::span<const int> also_allowed = {}) {
    ForbiddenSystemCalls seen;
    bool restricted = false;
    std::thread{[&] {
        restricted = restrict_cycle_thread_system_calls(SystemCallMode::record, also_allowed).ok();
        if (!restricted) return;
        work();
        seen = forbidden_system_calls();
    }}.join();
    EXPECT_TRUE(restricted);
    return seen;
}

TEST(RealtimeGuard, AThreadThatWritesToAFileIsDetectedAndTheWriteIsNotMade) {
    SKIP_UNDER_SANITIZERS();
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe2(ends.data(), O_NONBLOCK), 0);
    ssize_t written = 0;
    int reason = 0;

    const auto seen = on_a_restricted_thread([&] {
        written = write(ends[1], "x", 1);
        reason = errno;
    });

    EXPECT_EQ(seen.count, 1u);
    EXPECT_EQ(seen.first, SYS_write);
    EXPECT_THAT(seen.text(), testing::HasSubstr("(write)"));
    EXPECT_GT(seen.backtrace_depth, 2u);
    EXPECT_EQ(written, -1);
    EXPECT_EQ(reason, ENOSYS);
    char c = 0;
    EXPECT_EQ(read(ends[0], &c, 1), -1) << "the byte arrived";
    close(ends[0]);
    close(ends[1]);
}

TEST(RealtimeGuard, WaitingSendingAndReceivingAreAllowed) {
    SKIP_UNDER_SANITIZERS();
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()), 0);
    char got = 0;

    const auto seen = on_a_restricted_thread([&] {
        SystemClock clock;
        CyclicThread thread{clock, {.period = 100us}};
        const std::atomic<bool> never{false};
        thread.run(
            [&](const CycleTiming& t) {
                send(ends[0], "y", 1, 0);
                recv(ends[1], &got, 1, 0);
                return t.cycle == 5 ? CycleVerdict::stop : CycleVerdict::carry_on;
            },
            never);
    });

    EXPECT_EQ(seen.count, 0u) << seen.text();
    EXPECT_EQ(got, 'y');
    close(ends[0]);
    close(ends[1]);
}

TEST(RealtimeGuard, FurtherCallsCanBeAllowedByNumber) {
    SKIP_UNDER_SANITIZERS();
    const std::array further{static_cast<int>(SYS_getppid)};
    long parent = 0;
    const auto seen = on_a_restricted_thread([&] { parent = getppid(); }, further);
    EXPECT_EQ(seen.count, 0u) << seen.text();
    EXPECT_EQ(parent, getppid());

    EXPECT_EQ(on_a_restricted_thread([] { getppid(); }).count, 1u);
}

TEST(RealtimeGuard, OtherThreadsStayFree) {
    SKIP_UNDER_SANITIZERS();
    on_a_restricted_thread([] {});
    EXPECT_GT(getppid(), 0);
    EXPECT_EQ(forbidden_system_calls().count, 0u);
}

TEST(RealtimeGuard, KillModeEndsTheThreadAtTheCall) {
    SKIP_UNDER_SANITIZERS();
    std::atomic<int> reached{0};
    std::thread{[&] {
        if (!restrict_cycle_thread_system_calls(SystemCallMode::kill_thread).ok()) return;
        reached = 1;
        getppid();
        reached = 2;
    }}.join();
    EXPECT_EQ(reached, 1);
}

TEST(RealtimeGuard, TooManyExceptionsAreRefused) {
    std::array<int, 17> many{};
    EXPECT_FALSE(restrict_cycle_thread_system_calls(SystemCallMode::record, many).ok());
}

}  // namespace
}  // namespace taktwerk
