#pragma once
// Files and folders whose changes are on the disk before anybody builds on them, and whose places change by one rename each. Not real-time.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// A descriptor that is closed in any case.
class OwnedFd {
public:
    explicit OwnedFd(int fd = -1) noexcept : fd_(fd) {}
    OwnedFd(OwnedFd&& other) noexcept;
    OwnedFd& operator=(OwnedFd&& other) noexcept;
    OwnedFd(const OwnedFd&) = delete;
    OwnedFd& operator=(const OwnedFd&) = delete;
    ~OwnedFd();
    [[nodiscard]] int get() const noexcept { return fd_; }
    explicit operator bool() const noexcept { return fd_ >= 0; }

private:
    int fd_;
};

/// Of root: this process becomes the owner of the folder, for good, where that is another one: what it makes there is that one's, and whoever that is cannot
/// lead root elsewhere by a link. Nothing where there is no such folder. One thread so far. Errors: bundle.folder.
[[nodiscard]] Result<void> act_as_owner(const std::filesystem::path& folder);

/// Nobody else may change these folders while it lives; it waits for whoever does. It goes with the process, however that ends.
/// Errors: bundle.folder.
[[nodiscard]] Result<OwnedFd> lock_folder(const std::filesystem::path& folder);
/// Held as long as something of this folder is in use; others ask with in_use(). Nothing where it cannot be held.
[[nodiscard]] OwnedFd hold_folder(const std::filesystem::path& folder);
[[nodiscard]] bool in_use(const std::filesystem::path& folder);

/// The whole of a regular file (no link) of at most `most` bytes. Errors: bundle.unreadable.
[[nodiscard]] Result<std::string> read_small_file(const std::filesystem::path& path, std::size_t most);

/// Folders with all above them. Errors: bundle.folder.
[[nodiscard]] Result<void> make_folders(const std::filesystem::path& folder);
/// A new file with this text, on the disk; its folder is not synchronised. Errors: bundle.not_written.
[[nodiscard]] Result<void> write_new_file(const std::filesystem::path& path, std::string_view text);
/// The old text or the new one, whatever happens. Errors: bundle.not_written.
[[nodiscard]] Result<void> replace_file(const std::filesystem::path& path, std::string_view text);
/// A line more, on the disk. Errors: bundle.not_written.
[[nodiscard]] Result<void> append_line(const std::filesystem::path& path, std::string_view line);
[[nodiscard]] Result<void> make_link(const std::filesystem::path& link, const std::string& to);
/// The old place or the new one, whatever happens. Errors: bundle.not_written.
[[nodiscard]] Result<void> replace_link(const std::filesystem::path& link, const std::string& to);
/// A folder to its place, where nothing may be yet. Errors: bundle.not_written.
[[nodiscard]] Result<void> move_into_place(const std::filesystem::path& from, const std::filesystem::path& to);
[[nodiscard]] Result<void> sync_folder(const std::filesystem::path& folder);
/// Of the folder and all below it.
[[nodiscard]] Result<void> sync_folders(const std::filesystem::path& folder);
/// A link's text; nothing where there is no link.
[[nodiscard]] std::optional<std::string> link_text(const std::filesystem::path& link);

/// A folder that is put together aside and goes with this, unless it was moved. One that a killed process has left is swept up later.
class AsideFolder {
public:
    /// In `parent`. Errors: bundle.not_written.
    [[nodiscard]] static Result<AsideFolder> make(const std::filesystem::path& parent);
    AsideFolder(AsideFolder&&) noexcept = default;
    AsideFolder& operator=(AsideFolder&&) = delete;
    AsideFolder(const AsideFolder&) = delete;
    AsideFolder& operator=(const AsideFolder&) = delete;
    ~AsideFolder();
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Removes what other processes have left in `parent`.
    static void sweep(const std::filesystem::path& parent);

private:
    AsideFolder(std::filesystem::path path, OwnedFd held) : path_(std::move(path)), held_(std::move(held)) {}
    std::filesystem::path path_;
    OwnedFd held_;
};

}  // namespace taktwerk::runtime
