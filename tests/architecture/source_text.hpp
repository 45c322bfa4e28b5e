#pragma once
// Reads C++ source just far enough for the wall tests: code without its comments, and the include lines in it.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::architecture {

/// A file of the tree. `path` is relative to the repository root, with forward slashes.
struct SourceFile {
    std::string path;
    std::string text;
};

enum class Literals { keep, blank };

/// The text with comments (and, where asked, the inside of literals) replaced by blanks; line numbers stay.
[[nodiscard]] std::string code_of(std::string_view text, Literals literals);

struct IncludeLine {
    std::size_t line = 0;  ///< 1-based
    std::string path;
    bool quoted = false;  ///< "..." rather than <...>
};

[[nodiscard]] std::vector<IncludeLine> include_lines(std::string_view text);

/// The folder of a path, "" at the root.
[[nodiscard]] std::string folder_of(std::string_view path);
/// The first part of a path: its floor, if it has one.
[[nodiscard]] std::string floor_of(std::string_view path);
/// Whether `path` is `folder` itself or lies in it.
[[nodiscard]] bool lies_in(std::string_view path, std::string_view folder);

/// Every .hpp and .cpp below `root`/`folder`, in path order; nothing where the folder does not exist.
[[nodiscard]] std::vector<SourceFile> read_sources(const std::string& root, const std::string& folder);

}  // namespace taktwerk::architecture
