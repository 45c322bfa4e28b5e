#pragma once
// An archive that every tool opens: POSIX ustar (IEEE Std 1003.1, pax), uncompressed. Not real-time.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::apps {

/// One file as it stands in the archive: header, bytes, padding. `path`: relative, up to 255 bytes with its last part up to 100; what is longer is cut
/// at its end. `seconds`: of its change, since 1970.
[[nodiscard]] std::string tar_member(std::string_view path, std::string_view bytes, std::int64_t seconds);
/// Behind the last one.
[[nodiscard]] std::string tar_end();

}  // namespace taktwerk::apps
