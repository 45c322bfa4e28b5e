#pragma once
// What a process gives up once it has what it needs: of root's rights those that it does not use, and the system calls that no controller makes. It
// bounds what a mistake in a parser, or a program loaded as a shared object, can reach from here; it does not make native code harmless, which may do
// whatever this process still may (docs/security.md). Before other threads begin: rights belong to a thread. Not real-time.
// Sources: capabilities(7), seccomp(2), PR_SET_NO_NEW_PRIVS in prctl(2).

#include <span>

#include "core/result.hpp"

namespace taktwerk {

/// Of the rights that this process has, only `capabilities` (numbers of <linux/capability.h>) stay, here and in whatever it starts; it gains none that
/// it had not. A file that is executed later brings none either (no_new_privs). Errors: fence.rights.
[[nodiscard]] Result<void> keep_capabilities(std::span<const int> capabilities);

/// Refused from now on with EPERM, for all threads and for good, also for whatever this process starts: looking into other processes, loading kernel
/// modules and kernels, mounting, swapping, other namespaces, keys, profiling, io_uring, ports of the hardware, setting clocks and host names, user faults; calls of
/// other architectures than this process'. What it costs: `./dev bench fence`. Under a sanitizer ptrace stays: its leak check needs it. Sets no_new_privs.
/// Errors: fence.system_calls (a kernel without seccomp filters).
[[nodiscard]] Result<void> refuse_foreign_system_calls();

/// What refuse_foreign_system_calls() refuses, by number.
[[nodiscard]] std::span<const long> foreign_system_calls() noexcept;

}  // namespace taktwerk
