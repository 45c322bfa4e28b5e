#include "apps/bus/kept_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace taktwerk::apps {

namespace {

Error kept_file_error(const std::string& path, const char* code, const char* doing) {
    return {code, path, fmt::format("the file cannot be {}: {}", doing, std::strerror(errno)), "check the path, and that you may use it"};
}

/// Until it is on the disk: what it was read out of may be gone with the next power cut.
bool write_through(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto some = ::write(file, bytes.data(), bytes.size());
        if (some < 0 && errno == EINTR) continue;
        if (some <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(some));
    }
    return ::fsync(file) == 0;
}

class OpenFile {
public:
    explicit OpenFile(int number) noexcept : number_(number) {}
    ~OpenFile() {
        if (number_ >= 0) ::close(number_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    [[nodiscard]] int number() const noexcept { return number_; }

private:
    int number_;
};

}  // namespace

Result<std::vector<std::byte>> read_whole_file(const std::string& path, std::size_t largest, const char* code) {
    const OpenFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.number() < 0) return kept_file_error(path, code, "read");
    struct stat facts {};
    if (::fstat(file.number(), &facts) == 0 && S_ISDIR(facts.st_mode)) return Error{code, path, "is a folder", "give the file in it"};
    std::vector<std::byte> bytes;
    std::array<std::byte, 16384> part{};
    for (;;) {
        const auto some = ::read(file.number(), part.data(), part.size());
        if (some < 0 && errno == EINTR) continue;
        if (some < 0) return kept_file_error(path, code, "read");
        if (some == 0) return bytes;
        if (static_cast<std::size_t>(some) > largest - bytes.size())
            return Error{code, path, fmt::format("is larger than {} KiB", largest / 1024), "check that it is the file you mean"};
        bytes.insert(bytes.end(), part.begin(), part.begin() + some);
    }
}

Result<void> expect_no_file(const std::string& path, const char* code, const char* exists) {
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0) return {};  // what else is wrong with the place, writing says
    if (S_ISDIR(facts.st_mode)) return Error{code, path, "is a folder", "give the name of the file in it, too"};
    return Error{exists, path, "there is such a file already", "choose another name: nothing is written over"};
}

Result<void> write_new_file(const std::string& path, std::span<const std::byte> bytes, const char* code, const char* exists) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0 && errno == EEXIST) {
        const auto there = expect_no_file(path, code, exists);
        return there ? Error{exists, path, "there was such a file a moment ago", "give the command again"} : there.error();
    }
    if (file < 0) return kept_file_error(path, code, "written");
    const bool written = write_through(file, bytes);
    Error error = written ? Error{} : kept_file_error(path, code, "written");
    const bool closed = ::close(file) == 0;
    if (written && closed) return {};
    if (written) error = kept_file_error(path, code, "written");
    ::unlink(path.c_str());
    return error;
}

}  // namespace taktwerk::apps
