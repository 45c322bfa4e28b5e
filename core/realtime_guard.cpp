#include "core/realtime_guard.hpp"

#include <execinfo.h>
#include <fmt/format.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "core/seccomp_architecture.hpp"

namespace taktwerk {
namespace {

constinit thread_local ForbiddenSystemCalls forbidden_here{};

constexpr std::array allowed_always{
    SYS_clock_nanosleep, SYS_clock_gettime, SYS_gettimeofday, SYS_sendto, SYS_sendmsg,    SYS_sendmmsg,
    SYS_recvfrom,        SYS_recvmsg,       SYS_recvmmsg,     SYS_exit,   SYS_exit_group, SYS_rt_sigreturn,
};

constexpr std::size_t most_further = 16;

/// What the trapped call returns: the kernel leaves that to the handler.
void answer_not_implemented(ucontext_t& context) {
#if defined(__x86_64__)
    context.uc_mcontext.gregs[REG_RAX] = -ENOSYS;
#else
    context.uc_mcontext.regs[0] = static_cast<unsigned long long>(-ENOSYS);
#endif
}

/// SIGSYS arrives on the thread that made the call, in the middle of it.
void note_system_call(int, siginfo_t* info, void* context) {
    const int saved = errno;
    ForbiddenSystemCalls& here = forbidden_here;
    if (here.count++ == 0) {
        here.first = info->si_syscall;
        here.backtrace_depth = static_cast<std::size_t>(::backtrace(here.backtrace.data(), static_cast<int>(here.backtrace.size())));
    }
    answer_not_implemented(*static_cast<ucontext_t*>(context));
    errno = saved;
}

Error failure(std::string_view what) {
    return Error{"realtime.system_calls", "", fmt::format("{}: {}", what, std::strerror(errno)),
                 "It needs a kernel with seccomp filters (CONFIG_SECCOMP_FILTER)"};
}

std::string_view name_of(int number) {
    switch (number) {
        case SYS_read: return "read";
        case SYS_write: return "write";
        case SYS_openat: return "openat";
        case SYS_close: return "close";
        case SYS_futex: return "futex";
        case SYS_mmap: return "mmap";
        case SYS_munmap: return "munmap";
        case SYS_madvise: return "madvise";
        case SYS_brk: return "brk";
        case SYS_ioctl: return "ioctl";
        case SYS_rt_sigprocmask: return "rt_sigprocmask";
        case SYS_sched_yield: return "sched_yield";
        case SYS_ppoll: return "ppoll";
        default: return "see <sys/syscall.h>";
    }
}

}  // namespace

Result<void> restrict_cycle_thread_system_calls(SystemCallMode mode, std::span<const int> also_allowed) {
    if (also_allowed.size() > most_further)
        return Error{"realtime.system_calls", "", "more than 16 further system calls are not a restriction", ""};

    std::uint32_t otherwise = SECCOMP_RET_LOG;
    if (mode == SystemCallMode::kill_thread) otherwise = SECCOMP_RET_KILL_THREAD;
    if (mode == SystemCallMode::record) {
        otherwise = SECCOMP_RET_TRAP;
        void* warm_up[2];
        (void)::backtrace(warm_up, 2);  // its first call loads a library
        struct sigaction action {};
        action.sa_sigaction = note_system_call;
        action.sa_flags = SA_SIGINFO;
        if (::sigaction(SIGSYS, &action, nullptr) != 0) return failure("no SIGSYS handler");
        forbidden_here = {};
    }

    // Load the architecture: a foreign one counts as forbidden. Load the number, compare with each allowed one.
    // On the stack: freeing memory after the filter is in force might be a forbidden call itself.
    std::array<sock_filter, 5 + 2 * (allowed_always.size() + most_further)> program;
    unsigned short length = 0;
    const auto add = [&](sock_filter instruction) { program[length++] = instruction; };
    const auto allow = [&](long number) {
        add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, 1));
        add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    };
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)));
    add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, seccomp_architecture, 1, 0));
    add(BPF_STMT(BPF_RET | BPF_K, otherwise));
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
    for (const long number : allowed_always) allow(number);
    for (const int number : also_allowed) allow(number);
    add(BPF_STMT(BPF_RET | BPF_K, otherwise));

    const sock_fprog filter{length, program.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failure("no_new_privs refused");
    if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0) != 0) return failure("the filter was refused");
    return {};
}

ForbiddenSystemCalls forbidden_system_calls() noexcept { return forbidden_here; }

std::string ForbiddenSystemCalls::text() const {
    if (count == 0) return "no forbidden system call";
    std::string out = fmt::format("{} forbidden system calls, the first is {} ({})", count, first, name_of(first));
    if (char** lines = ::backtrace_symbols(backtrace.data(), static_cast<int>(backtrace_depth)); lines != nullptr) {
        for (std::size_t i = 0; i < backtrace_depth; ++i) out += fmt::format("\n    {}", lines[i]);
        std::free(lines);  // one block for all, as backtrace_symbols(3) says
    }
    return out;
}

}  // namespace taktwerk
