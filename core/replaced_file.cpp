#include "core/replaced_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <string>

namespace taktwerk {

namespace {

int write_whole(int file, std::string_view text) noexcept {
    while (!text.empty()) {
        const auto done = ::write(file, text.data(), text.size());
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return done < 0 ? errno : ENOSPC;
        text.remove_prefix(static_cast<std::size_t>(done));
    }
    return 0;
}

/// Its owner first: a change of owner may take bits of the mode away.
int dress(int file, const struct stat& as) noexcept {
    // Nobody but root gives files away, and a service that only asked would be killed for it (SystemCallFilter=~@privileged).
    if (::geteuid() == 0 && ::fchown(file, as.st_uid, as.st_gid) != 0) return errno;
    return ::fchmod(file, as.st_mode & 0777) != 0 ? errno : 0;
}

}  // namespace

int sync_folder_of(const std::filesystem::path& path) noexcept {
    try {
        const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path{"."};
        const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (fd < 0) return errno;
        const int failed = ::fsync(fd) != 0 ? errno : 0;
        ::close(fd);
        return failed;
    } catch (const std::bad_alloc&) {
        return ENOMEM;
    }
}

int replace_file(const std::filesystem::path& path, std::string_view text, mode_t mode) noexcept {
    try {
        const std::string aside = path.string() + ".new";
        struct stat before {};
        const bool there = ::stat(path.c_str(), &before) == 0 && S_ISREG(before.st_mode);
        ::unlink(aside.c_str());  // of somebody who was killed
        const int file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
        if (file < 0) return errno;
        int failed = write_whole(file, text);
        if (failed == 0 && there) failed = dress(file, before);
        if (failed == 0 && ::fsync(file) != 0) failed = errno;
        ::close(file);
        if (failed == 0 && ::rename(aside.c_str(), path.c_str()) != 0) failed = errno;
        if (failed == 0) return sync_folder_of(path);
        ::unlink(aside.c_str());
        return failed;
    } catch (const std::bad_alloc&) {
        return ENOMEM;
    }
}

}  // namespace taktwerk
