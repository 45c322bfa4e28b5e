// Killed at any instant: what is on the disk changes in system calls alone, so a process that is killed as it enters each of them in turn was killed at every
// instant there is. What is left must be the old state or the new one, must start, and must take the same command again.

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/bundle/active_bundle.hpp"
#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;

constexpr unsigned many_calls = 5000;  ///< more than any command here makes: a command that never ends fails

enum class End { killed, by_itself };

/// `work` in a process of its own, killed as it enters its system call number `call`, from 1.
End killed_at(unsigned call, const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
        ::raise(SIGSTOP);
        work();
        ::_exit(0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSTOPPED(status));
    EXPECT_EQ(::ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL), 0);
    for (unsigned entered = 0;;) {
        if (::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) != 0 || ::waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) break;
        if (WSTOPSIG(status) != (SIGTRAP | 0x80)) continue;
        __ptrace_syscall_info info{};
        EXPECT_GT(::ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info), 0);
        if (info.op != PTRACE_SYSCALL_INFO_ENTRY || ++entered < call) continue;
        ::kill(child, SIGKILL);
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return End::killed;
    }
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return End::by_itself;
}

struct Killed : ::testing::Test {
    TemporaryFolder folder;
    BundleStore store{folder.path() / "root"};
    std::string old_file = folder.write("1.0.twb", small_bundle(small_manifest("1.0")));
    std::string new_file = folder.write("1.1.twb", small_bundle(small_manifest("1.1")));

    Killed() {
        EXPECT_TRUE(store.install(old_file, nobody(), small_host()));
        EXPECT_TRUE(activate(store, "cell", "1.0", nobody(), small_host(), joe));
    }
    [[nodiscard]] std::string active() const {
        const auto chain = activations_of(store, "cell");
        return chain.empty() ? "none" : chain.front().version;
    }
    /// The version that a machine would start with now.
    [[nodiscard]] std::string boots() const {
        const auto begun = begin_start(store, "cell", 1'000'000, small_host(), joe);
        if (!begun) return begun.error().text();
        if (!begun->remarks.empty()) return begun->remarks.front().text();
        EXPECT_TRUE(verify(begun->bundle));
        return begun->bundle.manifest.version;
    }
    /// Nothing but versions, activations and the link: what a killed command has left beside them is gone once another one was here.
    void expect_clean() const {
        for (const auto& entry : fs::directory_iterator(store.bundles())) EXPECT_EQ(entry.path().filename(), "cell") << entry.path();
    }
};

TEST_F(Killed, WhileItActivatesTheOldOneOrTheNewOneIsActive) {
    ASSERT_TRUE(store.install(new_file, nobody(), small_host()));
    unsigned kills = 0, with_new = 0;
    for (unsigned call = 1; call < many_calls; ++call) {
        const auto end = killed_at(call, [&] { (void)activate(store, "cell", "1.1", nobody(), small_host(), joe).ok(); });
        const auto now = active();
        ASSERT_THAT(now, AnyOf("1.0", "1.1")) << "call " << call;
        ASSERT_EQ(boots(), now) << "call " << call;
        expect_clean();
        if (end == End::by_itself) {
            EXPECT_EQ(now, "1.1");
            break;
        }
        ++kills;
        with_new += now == "1.1" ? 1 : 0;
        const auto back = activate(store, "cell", "1.0", nobody(), small_host(), joe);
        ASSERT_TRUE(back) << back.error().text();
    }
    RecordProperty("kills", static_cast<int>(kills));
    EXPECT_GT(kills, 50u);
    EXPECT_GT(with_new, 0u) << "some kills come behind the rename";
    EXPECT_LT(with_new, kills) << "and some before";
}

TEST_F(Killed, WhileItRollsBackTheOldOneOrTheNewOneIsActive) {
    ASSERT_TRUE(store.install(new_file, nobody(), small_host()));
    unsigned kills = 0, with_old = 0;
    for (unsigned call = 1; call < many_calls; ++call) {
        const auto ready = activate(store, "cell", "1.1", nobody(), small_host(), joe);
        ASSERT_TRUE(ready) << ready.error().text();
        ASSERT_EQ(ready->next_back, "1.0");
        const auto end = killed_at(call, [&] { (void)roll_back(store, "cell", small_host(), joe).ok(); });
        const auto now = active();
        ASSERT_THAT(now, AnyOf("1.0", "1.1")) << "call " << call;
        ASSERT_EQ(boots(), now) << "call " << call;
        expect_clean();
        if (end == End::by_itself) {
            EXPECT_EQ(now, "1.0");
            break;
        }
        ++kills;
        with_old += now == "1.0" ? 1 : 0;
    }
    RecordProperty("kills", static_cast<int>(kills));
    EXPECT_GT(kills, 30u);
    EXPECT_GT(with_old, 0u);
    EXPECT_LT(with_old, kills);
}

TEST_F(Killed, WhileItInstallsAVersionIsWholeOrNotThere) {
    unsigned kills = 0, with_new = 0;
    for (unsigned call = 1; call < many_calls; ++call) {
        const auto end = killed_at(call, [&] { (void)store.install(new_file, nobody(), small_host()).ok(); });
        ASSERT_EQ(boots(), "1.0") << "call " << call;
        expect_clean();
        const auto versions = store.versions("cell");
        if (versions.size() == 2) {
            const auto there = store.find("cell", "1.1");
            ASSERT_TRUE(there) << there.error().text();
            ASSERT_TRUE(verify(*there)) << "call " << call;
        }
        if (end == End::by_itself) {
            EXPECT_EQ(versions.size(), 2u);
            break;
        }
        ++kills;
        with_new += versions.size() == 2 ? 1 : 0;
        if (versions.size() == 2) {
            ASSERT_TRUE(store.remove("cell", "1.1"));
        }
    }
    RecordProperty("kills", static_cast<int>(kills));
    EXPECT_GT(kills, 80u);
    EXPECT_GT(with_new, 0u);
    EXPECT_LT(with_new, kills);
}

TEST_F(Killed, WhileItFallsBackItStartsTheNextTime) {
    ASSERT_TRUE(store.install(new_file, nobody(), small_host()));
    {
        const auto good = begin_start(store, "cell", 1, small_host(), joe);
        ASSERT_TRUE(good && start_succeeded(good->activation)) << "1.0 is one that works, and has ended";
    }
    unsigned kills = 0;
    for (unsigned call = 1; call < many_calls; ++call) {
        ASSERT_TRUE(activate(store, "cell", "1.1", nobody(), small_host(), joe));
        ASSERT_TRUE(begin_start(store, "cell", 1, small_host(), joe)) << "one start that fails";
        const auto end = killed_at(call, [&] { (void)begin_start(store, "cell", 1, small_host(), joe).ok(); });
        ASSERT_THAT(active(), AnyOf("1.0", "1.1")) << "call " << call;
        ASSERT_EQ(boots(), active()) << "call " << call;
        expect_clean();
        if (end == End::by_itself) {
            EXPECT_EQ(active(), "1.0");
            break;
        }
        ++kills;
    }
    RecordProperty("kills", static_cast<int>(kills));
    EXPECT_GT(kills, 30u);
}

}  // namespace
}  // namespace taktwerk::runtime
