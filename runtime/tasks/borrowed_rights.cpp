#include "runtime/tasks/borrowed_rights.hpp"

#include <linux/capability.h>
#include <sys/auxv.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

using Capabilities = std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3>;

__user_cap_header_struct this_thread() noexcept { return {_LINUX_CAPABILITY_VERSION_3, 0}; }

}  // namespace

bool rights_are_borrowed() noexcept {
    // The kernel says at exec whether the file gave more than the caller had (capabilities(7), AT_SECURE in getauxval(3)).
    if (::getauxval(AT_SECURE) == 0) return false;
    if (::geteuid() != ::getuid() || ::getegid() != ::getgid()) return true;
    auto header = this_thread();
    Capabilities now{};
    if (::syscall(SYS_capget, &header, now.data()) != 0) return true;
    for (const auto& part : now)
        if (part.permitted != 0 || part.effective != 0) return true;
    return false;
}

Result<void> give_back_rights() {
    if (!rights_are_borrowed()) return {};
    const auto user = ::getuid();
    const auto group = ::getgid();
    auto header = this_thread();
    const Capabilities none{};
    const bool given = ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::setresgid(group, group, group) == 0 &&
                       ::setresuid(user, user, user) == 0 && ::syscall(SYS_capset, &header, none.data()) == 0;
    if (given && !rights_are_borrowed()) return {};
    return Error{"rights.kept", "this process", fmt::format("the rights of its file cannot be given up: {}", std::strerror(errno)),
                 "take them from the file (setcap -r), and run the machine as a service (docs/bus.md)"};
}

bool belongs_to_root(const std::string& path) {
    std::error_code failed;
    auto at = std::filesystem::canonical(path, failed);
    if (failed) return false;
    while (true) {
        struct stat info {};
        if (::lstat(at.c_str(), &info) != 0 || info.st_uid != 0) return false;
        // In a sticky folder nobody replaces what is root's.
        const bool others_write = (info.st_mode & (S_IWGRP | S_IWOTH)) != 0;
        if (others_write && !(S_ISDIR(info.st_mode) && (info.st_mode & S_ISVTX) != 0)) return false;
        if (at == at.root_path()) return true;
        at = at.parent_path();
    }
}

}  // namespace taktwerk::runtime
