#include "runtime/retain/slot_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

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
    [[nodiscard]] bool write(std::string_view text) const {
        while (fd_ >= 0 && !text.empty()) {
            const auto done = ::write(fd_, text.data(), text.size());
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(done));
        }
        return fd_ >= 0;
    }
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
    fs::create_directories(directory_, failed);
    const auto path = directory_ / "retain.lock";
    // For the owner alone: whoever can open it could hold it.
    const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (lock < 0) return std::nullopt;
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

std::optional<std::string> SlotFiles::read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return std::nullopt;
    const auto size = static_cast<std::streamoff>(file.tellg());
    std::string text(size > 0 ? std::min(static_cast<std::size_t>(size), largest) : 0, '\0');
    file.seekg(0);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

Result<void> SlotFiles::write(unsigned slot, std::string_view text) {
    std::error_code failed;
    fs::create_directories(directory_, failed);
    if (failed) return cannot_write(directory_, failed.message());
    const auto path = place(slot);
    const auto beside = fs::path(path.string() + ".new");
    {
        const Descriptor file(beside, O_WRONLY | O_CREAT | O_TRUNC);
        if (!file.write(text) || !file.sync()) return cannot_write(beside, std::strerror(errno));
    }
    fs::rename(beside, path, failed);
    if (failed) return cannot_write(path, failed.message());
    if (!Descriptor(directory_, O_RDONLY | O_DIRECTORY).sync()) return cannot_write(directory_, std::strerror(errno));
    return {};
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
