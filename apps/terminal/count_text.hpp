#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace taktwerk::apps {

/// "8 slaves", "1 slave".
[[nodiscard]] inline std::string count_text(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace taktwerk::apps
