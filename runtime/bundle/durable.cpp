#include "runtime/bundle/durable.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/replaced_file.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view aside_name = ".aside-";

Error not_written(const fs::path& path, int number) {
    const char* remedy = "look at that disk";
    if (number == ENOSPC || number == EDQUOT) remedy = "make room on that disk";
    if (number == EACCES || number == EPERM) remedy = "do it as the user that the folder belongs to, or with sudo";
    if (number == ENOENT || number == ENOTDIR) remedy = "name a folder that is there";
    return {"bundle.not_written", path.string(), fmt::format("it cannot be written: {}", std::strerror(number)), remedy};
}

Error no_folder(const fs::path& path, int number) {
    return {"bundle.folder", path.string(), fmt::format("the folder cannot be used: {}", std::strerror(number)),
            number == EACCES || number == EPERM
                ? "do it as the user that the folder belongs to, or with sudo; or name another folder with --root"
                : "name another folder with --root"};
}

OwnedFd open_folder(const fs::path& folder) { return OwnedFd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW)); }

Result<void> write_all(int fd, std::string_view text, const fs::path& path) {
    while (!text.empty()) {
        const auto done = ::write(fd, text.data(), text.size());
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return not_written(path, done < 0 ? errno : ENOSPC);
        text.remove_prefix(static_cast<std::size_t>(done));
    }
    if (::fsync(fd) != 0) return not_written(path, errno);
    return {};
}

fs::path beside(const fs::path& path) { return path.string() + ".new"; }

}  // namespace

OwnedFd::OwnedFd(OwnedFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
OwnedFd& OwnedFd::operator=(OwnedFd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
}
OwnedFd::~OwnedFd() {
    if (fd_ >= 0) ::close(fd_);
}

Result<void> act_as_owner(const fs::path& folder) {
    struct stat info {};
    if (::geteuid() != 0 || ::stat(folder.c_str(), &info) != 0 || info.st_uid == 0) return {};
    // Groups first: afterwards there is no right to change them.
    if (::setgroups(0, nullptr) != 0 || ::setresgid(info.st_gid, info.st_gid, info.st_gid) != 0 ||
        ::setresuid(info.st_uid, info.st_uid, info.st_uid) != 0)
        return no_folder(folder, errno);
    return {};
}

Result<OwnedFd> lock_folder(const fs::path& folder) {
    auto fd = open_folder(folder);
    if (!fd) return no_folder(folder, errno);
    while (::flock(fd.get(), LOCK_EX) != 0)
        if (errno != EINTR) return no_folder(folder, errno);
    return fd;
}

OwnedFd hold_folder(const fs::path& folder) {
    auto fd = open_folder(folder);
    if (fd && ::flock(fd.get(), LOCK_SH) != 0) return OwnedFd{};
    return fd;
}

bool in_use(const fs::path& folder) {
    const auto fd = open_folder(folder);
    return fd && ::flock(fd.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

Result<std::string> read_small_file(const fs::path& path, std::size_t most) {
    const auto unreadable = [&](std::string what) {
        return Error{"bundle.unreadable", path.string(), std::move(what), "look at the file and its permissions"};
    };
    const OwnedFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
    if (!fd) return unreadable(fmt::format("it cannot be read: {}", std::strerror(errno)));
    struct stat info {};
    if (::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode)) return unreadable("it is no file");
    std::string text;
    std::array<char, 65536> part;
    for (ssize_t got = 0; (got = ::read(fd.get(), part.data(), part.size())) != 0;) {
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return unreadable(fmt::format("it cannot be read: {}", std::strerror(errno)));
        text.append(part.data(), static_cast<std::size_t>(got));
        if (text.size() > most) return unreadable(fmt::format("it has more than {} bytes", most));
    }
    return text;
}

Result<void> make_folders(const fs::path& folder) {
    struct stat info {};
    if (::stat(folder.c_str(), &info) == 0) return S_ISDIR(info.st_mode) ? Result<void>{} : no_folder(folder, ENOTDIR);
    if (folder.has_parent_path() && folder.parent_path() != folder)
        if (auto ok = make_folders(folder.parent_path()); !ok) return ok;
    if (::mkdir(folder.c_str(), 0755) != 0 && errno != EEXIST) return no_folder(folder, errno);
    return sync_folder(folder.parent_path());
}

Result<void> write_new_file(const fs::path& path, std::string_view text) {
    const OwnedFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (!fd) return not_written(path, errno);
    return write_all(fd.get(), text, path);
}

Result<void> replace_file(const fs::path& path, std::string_view text) {
    const int failed = taktwerk::replace_file(path, text);
    return failed == 0 ? Result<void>{} : not_written(path, failed);
}

Result<void> append_line(const fs::path& path, std::string_view line) {
    const OwnedFd fd(::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (!fd) return not_written(path, errno);
    return write_all(fd.get(), std::string(line) + "\n", path);
}

Result<void> make_link(const fs::path& link, const std::string& to) {
    if (::symlink(to.c_str(), link.c_str()) != 0) return not_written(link, errno);
    return {};
}

Result<void> replace_link(const fs::path& link, const std::string& to) {
    const auto aside = beside(link);
    ::unlink(aside.c_str());
    if (auto ok = make_link(aside, to); !ok) return ok;
    if (::rename(aside.c_str(), link.c_str()) != 0) return not_written(link, errno);
    return sync_folder(link.parent_path());
}

Result<void> move_into_place(const fs::path& from, const fs::path& to) {
    // Where a folder with something in it is, rename() takes no other one.
    if (::rename(from.c_str(), to.c_str()) != 0) return not_written(to, errno);
    return sync_folder(to.parent_path());
}

Result<void> sync_folder(const fs::path& folder) {
    const OwnedFd fd(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd || ::fsync(fd.get()) != 0) return not_written(folder, errno);
    return {};
}

Result<void> sync_folders(const fs::path& folder) {
    std::error_code failed;
    for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
        if (entry->is_directory(failed) && !entry->is_symlink(failed))
            if (auto ok = sync_folder(entry->path()); !ok) return ok;
    if (failed) return not_written(folder, failed.value());
    return sync_folder(folder);
}

std::optional<std::string> link_text(const fs::path& link) {
    std::array<char, PATH_MAX> text;
    const auto size = ::readlink(link.c_str(), text.data(), text.size());
    if (size <= 0 || static_cast<std::size_t>(size) >= text.size()) return std::nullopt;
    return std::string(text.data(), static_cast<std::size_t>(size));
}

Result<AsideFolder> AsideFolder::make(const fs::path& parent) {
    auto pattern = (parent / (std::string(aside_name) + "XXXXXX")).string();
    if (::mkdtemp(pattern.data()) == nullptr) return not_written(parent, errno);
    auto held = hold_folder(pattern);
    if (!held || ::fchmod(held.get(), 0755) != 0) return not_written(pattern, errno);
    return AsideFolder(pattern, std::move(held));
}

AsideFolder::~AsideFolder() {
    if (!held_) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void AsideFolder::sweep(const fs::path& parent) {
    std::error_code failed;
    std::vector<fs::path> left;
    for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end; entry.increment(failed))
        if (entry->path().filename().string().starts_with(aside_name) && !in_use(entry->path())) left.push_back(entry->path());
    for (const auto& folder : left) fs::remove_all(folder, failed);
}

}  // namespace taktwerk::runtime
