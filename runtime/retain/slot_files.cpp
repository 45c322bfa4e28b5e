#include "runtime/retain/slot_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "core/replaced_file.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

/// A file or folder whose changes shall be on the disk.
class Descriptor {
public:
    Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] bool sync() const { return fd_ >= 0 && ::fsync(fd_) == 0; }

private:
    int fd_;
};

Error cannot_write(const fs::path& where, const std::string& why) {
    return {"retain.cannot_write", where.string(), "what is to be kept over a time without power cannot be written: " + why,
            "give `retain` a directory on a disk with room that the runtime may write"};
}

}  // namespace

SlotFiles::~SlotFiles() {
    if (lock_ >= 0) ::close(lock_);
}

fs::path SlotFiles::place(unsigned slot) const { return directory_ / fmt::format("retain.{}", slot); }

std::optional<Error> SlotFiles::lock() {
    std::error_code failed;
    // That there is such a folder has to be on the disk as well.
    if (fs::create_directories(directory_, failed) && directory_.has_parent_path())
        (void)Descriptor(directory_.parent_path(), O_RDONLY | O_DIRECTORY).sync();
    const auto path = directory_ / "retain.lock";
    // For the owner alone: whoever can open it could hold it.
    const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (lock < 0) {
        const int why = errno;
        const bool its_fault = why == EACCES || why == EPERM || why == ELOOP || why == EISDIR;  // and not the folder's or the disk's
        if (!its_fault || ::faccessat(AT_FDCWD, directory_.c_str(), W_OK | X_OK, AT_EACCESS) != 0) return std::nullopt;
        return Error{
            "retain.lock", path.string(),
            fmt::format("nobody can say whether another process keeps its values there: {}", std::strerror(why)),
            fmt::format("give it to the user that the machine runs as (chown), or delete it once nothing uses {}", directory_.string())};
    }
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        char pid[32] = {};
        const auto length = ::pread(lock, pid, sizeof pid - 1, 0);
        ::close(lock);
        return Error{"retain.in_use", directory_.string(),
                     fmt::format("process {} keeps its machine's values there already", length > 0 ? pid : "unknown"),
                     "Stop it first, or give this machine a directory of its own as `retain` (or --retain)."};
    }
    const auto pid = std::to_string(::getpid());
    if (::ftruncate(lock, 0) != 0 || ::pwrite(lock, pid.data(), pid.size(), 0) < 0) {
        // Only the message for a second runtime would be poorer.
    }
    lock_ = lock;
    return std::nullopt;
}

Result<std::optional<std::string>> SlotFiles::read(const fs::path& path) {
    const auto unreadable = [&](const std::string& why) {
        return Error{"retain.unreadable", path.string(), "it is there and cannot be read: " + why,
                     "let the user that the machine runs as read it, or look at that disk"};
    };
    // Not waiting: whatever has that name, a machine starts.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 && (errno == ENOENT || errno == ENOTDIR)) return std::optional<std::string>{};
    if (fd < 0) return unreadable(std::strerror(errno));
    struct stat info {};
    std::string text;
    int failed = ::fstat(fd, &info) != 0 ? errno : 0;
    const bool is_file = S_ISREG(info.st_mode);
    std::array<char, 65536> part;
    while (is_file && failed == 0 && text.size() < largest) {
        const auto got = ::read(fd, part.data(), std::min(part.size(), largest - text.size()));
        if (got < 0 && errno != EINTR) failed = errno;
        if (got == 0) break;
        if (got > 0) text.append(part.data(), static_cast<std::size_t>(got));
    }
    ::close(fd);
    if (failed != 0) return unreadable(std::strerror(failed));
    if (!is_file) return unreadable("it is no file");
    return std::optional(std::move(text));
}

void SlotFiles::set_aside(const fs::path& file) noexcept {
    // What was set aside before is the older part of the story: it stays, and the new one is numbered.
    constexpr int most = 100;
    for (int number = 1; number <= most; ++number) {
        const auto aside = number == 1 ? file.string() + ".unread" : fmt::format("{}.unread.{}", file.string(), number);
        if (::renameat2(AT_FDCWD, file.c_str(), AT_FDCWD, aside.c_str(), RENAME_NOREPLACE) == 0 || errno != EEXIST) return;
    }
}

Result<void> SlotFiles::write(unsigned slot, std::string_view text) {
    std::error_code failed;
    fs::create_directories(directory_, failed);
    if (failed) return cannot_write(directory_, failed.message());
    const auto path = place(slot);
    const int why = replace_file(path, text);
    return why == 0 ? Result<void>{} : cannot_write(path, std::strerror(why));
}

// A folder that takes no new file may let go of an old one, and one that does neither may hold files that can be emptied.
bool SlotFiles::take_back(const fs::path& file) {
    std::error_code failed;
    fs::remove(file, failed);
    if (failed) return Descriptor(file, O_WRONLY | O_TRUNC | O_NOFOLLOW).sync();
    (void)Descriptor(directory_, O_RDONLY | O_DIRECTORY).sync();
    return true;
}

}  // namespace taktwerk::runtime
