#include "core/process_fence.hpp"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sched.h>
#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>

namespace taktwerk {
namespace {

/// A fence is for good: each is put up in a process of its own. What `work` wrote comes back.
std::string in_a_child(const std::function<std::string()>& work) {
    std::array<int, 2> pipe{};
    EXPECT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(pipe[0]);
        const auto said = work();
        const bool told = ::write(pipe[1], said.data(), said.size()) == static_cast<ssize_t>(said.size());
        ::_exit(told ? 0 : 1);
    }
    ::close(pipe[1]);
    std::string said;
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = ::read(pipe[0], part.data(), part.size())) > 0;) said.append(part.data(), static_cast<std::size_t>(got));
    ::close(pipe[0]);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    return said;
}

std::string field(std::istream&& from, const std::string& name) {
    for (std::string line; std::getline(from, line);)
        if (line.rfind(name, 0) == 0) return line.substr(line.find_last_of(" \t") + 1);
    return "";
}

std::string of_this_process(const std::string& name) { return field(std::ifstream("/proc/self/status"), name); }

/// Bits of capabilities as the kernel writes them.
std::string bits(std::initializer_list<int> capabilities) {
    unsigned long long all = 0;
    for (const int each : capabilities) all |= 1ULL << each;
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", all);
    return text.data();
}

TEST(ProcessFence, EveryForeignCallIsRefusedOnEveryThread) {
    ASSERT_GT(foreign_system_calls().size(), 30u);
    const auto said = in_a_child([] {
        std::string wrong;
        // The control: without the fence these two are anybody's.
        if (::syscall(SYS_unshare, 0) != 0) wrong += "unshare was refused before;";
        if (::syscall(SYS_personality, 0xffffffff) < 0) wrong += "personality was refused before;";
        bool up = false, ended = false;
        std::string of_another;
        std::thread before{[&] {  // begun before the fence: it is for all
            while (!__atomic_load_n(&up, __ATOMIC_ACQUIRE)) std::this_thread::yield();
            if (::syscall(SYS_unshare, 0) != -1 || errno != EPERM) of_another = "unshare on another thread;";
            __atomic_store_n(&ended, true, __ATOMIC_RELEASE);
        }};
        if (auto ok = refuse_foreign_system_calls(); !ok) wrong += ok.error().text();
        __atomic_store_n(&up, true, __ATOMIC_RELEASE);
        before.join();
        wrong += of_another;
        if (!wrong.empty()) return wrong;  // no call of the list is made where nothing refuses it
        for (const long number : foreign_system_calls()) {
            errno = 0;
            // Arguments that no call takes, were it made after all.
            if (::syscall(number, -1, -1, -1, -1, -1, -1) != -1 || errno != EPERM) wrong += std::to_string(number) + " was not refused;";
        }
        return wrong;
    });
    EXPECT_EQ(said, "");
}

TEST(ProcessFence, WhatAControllerDoesGoesOn) {
    const auto said = in_a_child([] {
        std::string wrong;
        if (!refuse_foreign_system_calls()) wrong += "no fence;";
        const int file = ::socket(AF_INET, SOCK_DGRAM, 0);
        if (file < 0) wrong += "socket;";
        ::close(file);
        int seen = 0;
        std::thread{[&] { seen = 1; }}.join();
        if (seen != 1) wrong += "thread;";
        if (of_this_process("Name:").empty()) wrong += "file;";
        const pid_t child = ::fork();
        if (child == 0) {
            ::execl("/bin/true", "true", nullptr);
            ::_exit(9);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) wrong += "exec;";
        return wrong;
    });
    EXPECT_EQ(said, "");
}

TEST(ProcessFence, OfRootsRightsThoseThatAreNamedStayAlsoBehindAnExec) {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root: an ordinary process has no rights to lose";
    if (of_this_process("CapPrm:") == bits({CAP_SYS_NICE})) GTEST_SKIP() << "root has no rights here";
    const auto said = in_a_child([] {
        const std::array kept{CAP_SYS_NICE, CAP_NET_RAW};
        if (auto ok = keep_capabilities(kept); !ok) return ok.error().text();
        auto now = of_this_process("CapPrm:") + " " + of_this_process("CapEff:") + " " + of_this_process("NoNewPrivs:");
        FILE* other = ::popen("grep CapEff: /proc/self/status", "r");
        std::array<char, 64> line{};
        if (std::fgets(line.data(), line.size(), other) != nullptr) now += " then " + field(std::istringstream(line.data()), "CapEff:");
        ::pclose(other);
        return now;
    });
    const auto two = bits({CAP_SYS_NICE, CAP_NET_RAW});
    EXPECT_EQ(said, two + " " + two + " 1 then " + two);
}

TEST(ProcessFence, ARightThatWasNotThereIsNotGained) {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root: rights are taken away first";
    const auto said = in_a_child([] {
        if (!keep_capabilities(std::array{CAP_NET_RAW})) return std::string("first");
        if (!keep_capabilities(std::array{CAP_NET_RAW, CAP_SYS_ADMIN})) return std::string("second");
        return of_this_process("CapEff:");
    });
    EXPECT_EQ(said, bits({CAP_NET_RAW}));
}

}  // namespace
}  // namespace taktwerk
