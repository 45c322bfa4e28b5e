#pragma once
// How much memory this computer has. Not real-time.

#include <unistd.h>

#include <cstddef>

namespace taktwerk {

/// Bytes; 0: not known.
[[nodiscard]] inline std::size_t installed_memory() noexcept {
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page) : 0;
}

}  // namespace taktwerk
