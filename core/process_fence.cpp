#include "core/process_fence.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/seccomp_architecture.hpp"

namespace taktwerk {
namespace {

constexpr auto foreign = std::to_array<long>({
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    SYS_ptrace,
#endif
        SYS_process_vm_readv, SYS_process_vm_writev, SYS_process_madvise, SYS_pidfd_getfd, SYS_kcmp, SYS_kexec_load,
#if defined(SYS_kexec_file_load)
        SYS_kexec_file_load,
#endif
        SYS_init_module, SYS_finit_module, SYS_delete_module, SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_move_mount,
        SYS_open_tree, SYS_fsopen, SYS_fsconfig, SYS_fsmount, SYS_fspick, SYS_mount_setattr, SYS_swapon, SYS_swapoff, SYS_reboot,
        SYS_sethostname, SYS_setdomainname, SYS_setns, SYS_unshare, SYS_add_key, SYS_request_key, SYS_keyctl, SYS_perf_event_open,
        SYS_userfaultfd, SYS_acct, SYS_quotactl, SYS_syslog, SYS_vhangup, SYS_personality, SYS_open_by_handle_at, SYS_clock_settime,
        SYS_settimeofday, SYS_io_uring_setup,
#if defined(__x86_64__)
        SYS_iopl, SYS_ioperm, SYS_modify_ldt,
#endif
});

Error refused(const char* code, const char* what, const char* remedy) {
    return Error{code, "this process", fmt::format("{}: {}", what, std::strerror(errno)), remedy};
}

bool no_new_rights() noexcept { return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0; }

}  // namespace

Result<void> keep_capabilities(std::span<const int> capabilities) {
    constexpr int bits = 32;
    std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> mask{};
    for (const int each : capabilities) mask[static_cast<std::size_t>(each / bits)].permitted |= 1U << (each % bits);
    const auto kept = [&](int each) { return (mask[static_cast<std::size_t>(each / bits)].permitted >> (each % bits) & 1U) != 0; };
    const auto fail = [] {
        return refused("fence.rights", "rights cannot be given up",
                       "the process keeps what it has; a service bounds it from outside (docs/service.md)");
    };

    if (!no_new_rights()) return fail();
    // The bounding set needs a right itself; without it there is nothing that a later exec could bring, because of no_new_privs.
    for (int each = 0; ::prctl(PR_CAPBSET_READ, each, 0, 0, 0) >= 0; ++each) {
        if (kept(each)) continue;
        (void)::prctl(PR_CAPBSET_DROP, each, 0, 0, 0);
        if (::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_IS_SET, each, 0, 0) == 1 &&
            ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_LOWER, each, 0, 0) != 0)
            return fail();
    }
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> now{};
    if (::syscall(SYS_capget, &header, now.data()) != 0) return fail();
    for (std::size_t i = 0; i < now.size(); ++i) {
        now[i].permitted &= mask[i].permitted;
        now[i].effective &= mask[i].permitted;
        now[i].inheritable &= mask[i].permitted;
    }
    if (::syscall(SYS_capset, &header, now.data()) != 0) return fail();
    return {};
}

Result<void> refuse_foreign_system_calls() {
    std::array<sock_filter, 8 + 2 * foreign.size()> program;
    unsigned short length = 0;
    const auto add = [&](sock_filter instruction) { program[length++] = instruction; };
    constexpr std::uint32_t refuse = SECCOMP_RET_ERRNO | EPERM;
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)));
    add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, seccomp_architecture, 1, 0));
    add(BPF_STMT(BPF_RET | BPF_K, refuse));
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
    add(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, seccomp_first_of_another, 0, 1));
    add(BPF_STMT(BPF_RET | BPF_K, refuse));
    for (const long number : foreign) {
        add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, 1));
        add(BPF_STMT(BPF_RET | BPF_K, refuse));
    }
    add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));

    const auto fail = [] {
        return refused("fence.system_calls", "the filter of system calls was refused",
                       "it needs a kernel with CONFIG_SECCOMP_FILTER; the machine runs without it");
    };
    if (!no_new_rights()) return fail();
    const sock_fprog filter{length, program.data()};
    if (::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &filter) != 0) return fail();
    return {};
}

std::span<const long> foreign_system_calls() noexcept { return foreign; }

}  // namespace taktwerk
