#pragma once
// Which files a configuration was read from, and what they said then: for whoever has to know later that they are others.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::config {

/// While one lives, whatever this thread reads for a configuration is noted in it. The innermost counts.
class FilesRead {
public:
    struct File {
        std::string path;
        std::uint32_t crc = 0;  ///< CRC-32 of its text
        std::size_t size = 0;   ///< bytes
    };
    FilesRead();
    ~FilesRead();
    FilesRead(const FilesRead&) = delete;
    FilesRead& operator=(const FilesRead&) = delete;

    /// Each once, in the order in which they were read first.
    [[nodiscard]] const std::vector<File>& files() const noexcept { return files_; }
    /// By whoever reads one.
    static void note(const std::string& path, std::string_view text);

private:
    std::vector<File> files_;
    FilesRead* outer_;
};

}  // namespace taktwerk::config
