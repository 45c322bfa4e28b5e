#pragma once
// The pictures of a view: a PNG, JPEG or SVG file, small, and without anything that runs or is fetched from elsewhere. Not real-time.

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi {

inline constexpr std::size_t largest_image = std::size_t{1} << 20;

struct ImageFile {
    std::string type;  ///< "image/png", "image/jpeg", "image/svg+xml"
    std::string bytes;
};

/// Errors: view.no_image (no such file, no regular file, unreadable), view.image_size, view.image_type, view.image_active. `subject` of each is
/// empty: who asks knows the place.
[[nodiscard]] Result<ImageFile> read_image(const std::string& path);
/// The same of bytes that somebody has.
[[nodiscard]] Result<ImageFile> judge_image(std::string bytes);

}  // namespace taktwerk::hmi
