#pragma once
// A file that changes as a whole: whatever happens meanwhile, a power cut too, there is the old text or the new one. Not real-time.

#include <filesystem>
#include <string_view>

#include <sys/types.h>

namespace taktwerk {

/// Writes NAME.new beside it, to the disk, moves it to its place and puts the folder on the disk. A file that is there keeps its mode and its owner (where root
/// does it), a new one gets `mode` less the umask. A link at NAME.new is not followed. 0, or the errno of what failed:
/// then the old text stands there, but for a folder that could not be put on the disk.
[[nodiscard]] int replace_file(const std::filesystem::path& path, std::string_view text, mode_t mode = 0644) noexcept;

/// What was made, removed or renamed in it is on the disk. 0, or errno.
[[nodiscard]] int sync_folder_of(const std::filesystem::path& path) noexcept;

}  // namespace taktwerk
