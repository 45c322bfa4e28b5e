#pragma once
// Keeps the cycle thread to the three system calls it may make: wait, send, receive (and reading the clock where the
// kernel has no fast path). The other half of the proof, that nothing is allocated, is core/guard/.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/result.hpp"

namespace taktwerk {

enum class SystemCallMode : std::uint8_t {
    record,       ///< for tests: the call is not made (it returns ENOSYS) and is noted for this thread
    log,          ///< for machines in the field: the call is made and the kernel logs it (audit, or dmesg)
    kill_thread,  ///< the call ends the thread: the bus falls silent and the drives' watchdogs react
};

/// For the calling thread only, and for whatever it starts later. It cannot be undone, not even by root: only for a test's
/// own thread, or when the operator asks for it. Allowed: clock_nanosleep, clock_gettime, gettimeofday, send*, recv*, exit*,
/// rt_sigreturn, and `also_allowed` (numbers as in <sys/syscall.h>, at most 16). Sets no_new_privs.
///
/// With `record` a thread should leave by a flag and let others read the record: a call that glibc cannot do without (futex) may
/// end the process, and thread exit itself makes calls that are noted too, so read the record before the thread ends.
/// Errors: realtime.system_calls. Not real-time safe.
[[nodiscard]] Result<void> restrict_cycle_thread_system_calls(SystemCallMode mode, std::span<const int> also_allowed = {});

/// What the calling thread tried in mode `record`.
struct ForbiddenSystemCalls {
    std::uint64_t count = 0;
    int first = -1;                     ///< number of the first one
    std::array<void*, 24> backtrace{};  ///< of the first one
    std::size_t backtrace_depth = 0;

    /// For a test's message: number, name of the common ones, and the backtrace. Allocates: not on a restricted thread.
    [[nodiscard]] std::string text() const;
};

/// Real-time safe.
[[nodiscard]] ForbiddenSystemCalls forbidden_system_calls() noexcept;

}  // namespace taktwerk
