#pragma once
// Which system calls are this architecture's, for filters of seccomp(2): the number alone does not tell.

#include <linux/audit.h>

#include <cstdint>

namespace taktwerk {

#if defined(__x86_64__)
inline constexpr std::uint32_t seccomp_architecture = AUDIT_ARCH_X86_64;
inline constexpr std::uint32_t seccomp_first_of_another = 0x40000000;  ///< x32: the same architecture by name, with numbers from here on
#elif defined(__aarch64__)
inline constexpr std::uint32_t seccomp_architecture = AUDIT_ARCH_AARCH64;
inline constexpr std::uint32_t seccomp_first_of_another = 0x80000000;
#else
#error "which AUDIT_ARCH is this CPU?"
#endif

}  // namespace taktwerk
