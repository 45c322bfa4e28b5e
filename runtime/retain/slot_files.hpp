#pragma once
// Two files of one folder that are written in turn: while one is written the other stays whole. A file is written beside its place, synchronised
// to the disk and then moved there, and the folder is synchronised too, so that a power cut leaves the old one or the new one. What stands in
// them is the business of whoever has them. One process at a time has the folder: retain.lock. Not real-time.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::runtime {

class SlotFiles {
public:
    static constexpr unsigned count = 2;
    static constexpr std::size_t largest = std::size_t{64} << 20;  ///< bytes of a file; of a longer one the beginning is read

    explicit SlotFiles(std::filesystem::path directory) : directory_(std::move(directory)) {}
    ~SlotFiles();
    SlotFiles(const SlotFiles&) = delete;
    SlotFiles& operator=(const SlotFiles&) = delete;

    /// Makes the folder and keeps everybody else out of it for as long as this lives. Nothing where it cannot be written: write() says
    /// that. Errors: retain.in_use, with the process that has it; retain.lock: the folder could be written, and its lock is somebody else's, so
    /// that nobody could say whether it is in use.
    [[nodiscard]] std::optional<Error> lock();
    [[nodiscard]] std::filesystem::path place(unsigned slot) const;
    /// Nothing where there is no such file. Errors: retain.unreadable, with the reason of the system: something is there, whatever it says.
    [[nodiscard]] static Result<std::optional<std::string>> read(const std::filesystem::path& file);
    /// Keeps a file that cannot be read, as NAME.unread (NAME.unread.2, ... where that is taken), so that the next write() does not replace it. Nothing where it cannot be moved either.
    static void set_aside(const std::filesystem::path& file) noexcept;
    /// Errors: retain.cannot_write, with the reason of the system; the other slot is as it was, and this one is the old or the new one.
    [[nodiscard]] Result<void> write(unsigned slot, std::string_view text);
    /// Removes a file, or empties it where the folder lets nothing go. False: neither was possible, and it says what it said.
    [[nodiscard]] bool take_back(const std::filesystem::path& file);

    [[nodiscard]] const std::filesystem::path& directory() const noexcept { return directory_; }

private:
    std::filesystem::path directory_;
    int lock_ = -1;
};

}  // namespace taktwerk::runtime
