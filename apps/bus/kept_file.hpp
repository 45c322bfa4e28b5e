#pragma once
// Bytes between the disk and a slave: read as a whole before anything begins, and never written over.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

/// All of a file, at most `largest` bytes. Error `code`: not there, a folder, too large, or the disk cannot be read.
[[nodiscard]] Result<std::vector<std::byte>> read_whole_file(const std::string& path, std::size_t largest, const char* code);

/// Whether nothing is at this place, so that nobody reads a slave for minutes in vain. Error `code`: a folder. Error `exists`: a file.
[[nodiscard]] Result<void> expect_no_file(const std::string& path, const char* code, const char* exists);

/// A new file, on the disk when it returns. Error `code`: it cannot be written, and then it is not there. Error `exists`: there is one already.
[[nodiscard]] Result<void> write_new_file(const std::string& path, std::span<const std::byte> bytes, const char* code, const char* exists);

}  // namespace taktwerk::apps
