#pragma once
// One idea a room: no class with more than 25 data members, no header above 250 lines. Both are counted from the source text, so that they hold
// for what is compiled nowhere as well.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/source_text.hpp"
#include "tests/architecture/walls.hpp"

namespace taktwerk::architecture {

inline constexpr std::size_t most_members = 25;
inline constexpr std::size_t most_header_lines = 250;

/// A class or struct of a file, with the data members of its own: those of its bases and of classes inside it are not counted, nor are static
/// ones.
struct ClassRoom {
    std::string name;  ///< "" where it has none
    std::size_t line = 0;
    std::size_t members = 0;
};
[[nodiscard]] std::vector<ClassRoom> class_rooms(std::string_view text);

/// Leave to be larger, with the reason. A class or header that does not need it any more has to go from the list.
struct Leave {
    std::string path, name;  ///< name "": the header's length
    std::size_t most = 0;
    std::string reason;
};

[[nodiscard]] Violations check_class_sizes(const std::vector<SourceFile>& files, const std::vector<Leave>& leaves);
[[nodiscard]] Violations check_header_lengths(const std::vector<SourceFile>& files, const std::vector<Leave>& leaves);

}  // namespace taktwerk::architecture
