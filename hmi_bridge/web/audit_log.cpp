#include "hmi_bridge/web/audit_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/wall_clock.hpp"

namespace taktwerk::hmi::web {
namespace {

Error audit_error(const std::string& path, std::string what) {
    return Error{"web.audit", path, std::move(what) + ": " + std::strerror(errno),
                 "Look at the disk and at who may write there; --audit FILE names another."};
}

int open_to_append(const std::string& path) { return ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640); }

}  // namespace

Result<AuditFile> AuditFile::open(const std::string& path, std::uint64_t longest) {
    const int fd = open_to_append(path);
    if (fd < 0) return audit_error(path, "what pages command cannot be written down");
    struct stat state {};
    if (::fstat(fd, &state) != 0) state.st_size = 0;
    return AuditFile(fd, path, static_cast<std::uint64_t>(state.st_size), longest);
}

AuditFile::AuditFile(AuditFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)), size_(other.size_), longest_(other.longest_), torn_(other.torn_) {}

AuditFile& AuditFile::operator=(AuditFile&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(path_, other.path_);
    std::swap(size_, other.size_);
    std::swap(longest_, other.longest_);
    std::swap(torn_, other.torn_);
    return *this;
}

AuditFile::~AuditFile() {
    if (fd_ >= 0) ::close(fd_);
}

Result<void> AuditFile::append(const std::string& line) {
    if (size_ + line.size() + 1 > longest_ && size_ > 0) rotate();
    if (fd_ < 0 && (fd_ = open_to_append(path_)) < 0) return audit_error(path_, "what pages command cannot be written down");
    const auto whole = (torn_ ? "\n" : "") + line + "\n";
    const auto put = ::write(fd_, whole.data(), whole.size());
    if (put > 0) size_ += static_cast<std::uint64_t>(put);
    const bool all = put == static_cast<ssize_t>(whole.size());
    torn_ = !all && (torn_ || put > 0);
    if (all) return {};
    if (put >= 0) errno = ENOSPC;  // within the line; the next one must not begin inside it
    return audit_error(path_, "a line of what pages command could not be written");
}

void AuditFile::rotate() {
    const auto older = [this](int number) { return number == 0 ? path_ : fmt::format("{}.{}", path_, number); };
    for (int number = kept; number > 0; --number) ::rename(older(number - 1).c_str(), older(number).c_str());
    ::close(std::exchange(fd_, open_to_append(path_)));
    size_ = 0;
    torn_ = false;
}

AuditLog::AuditLog(AuditFile file, Say say) : file_(std::move(file)), say_(std::move(say)), thread_([this] { work(); }) {}

AuditLog::~AuditLog() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    more_.notify_one();
    thread_.join();
}

void AuditLog::put(std::string line) {
    {
        const std::lock_guard lock(mutex_);
        if (lines_.size() >= most_waiting) {
            ++missing_;
            return;
        }
        lines_.push_back(std::move(line));
    }
    more_.notify_one();
}

void AuditLog::work() {
    bool failed = false;
    std::uint64_t lost = 0;
    while (true) {
        std::deque<std::string> lines;
        {
            std::unique_lock lock(mutex_);
            more_.wait(lock, [this] { return ends_ || !lines_.empty(); });
            if (lines_.empty()) return;
            lines.swap(lines_);
            lost += std::exchange(missing_, 0);
        }
        for (const auto& line : lines) {
            if (lost > 0 && file_.append(fmt::format(R"({{"utime":{},"missing_lines":{}}})", wall_utime(), lost))) lost = 0;
            const auto done = file_.append(line);
            if (!done) {
                ++lost;
                if (!std::exchange(failed, true)) say_(done.error());
            } else failed = false;
        }
    }
}

Result<std::string> default_audit_path() {
    constexpr const char* name = "/hmi-audit.jsonl";
    const auto text = [](const char* variable) {
        const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): before any thread
        return std::string(value == nullptr ? "" : value);
    };
    if (const auto logs = text("LOGS_DIRECTORY"); !logs.empty()) return logs.substr(0, logs.find(':')) + name;
    if (::access("/var/log/taktwerk", W_OK) == 0) return std::string("/var/log/taktwerk") + name;
    auto state = text("XDG_STATE_HOME");
    if (state.empty() && !text("HOME").empty()) state = text("HOME") + "/.local/state";
    if (state.empty())
        return Error{"web.audit", "", "nowhere to write down what pages command: neither LOGS_DIRECTORY nor HOME is set",
                     "Name a file with --audit."};
    std::error_code failure;
    std::filesystem::create_directories(state + "/taktwerk", failure);
    if (failure)
        return Error{"web.audit", state + "/taktwerk", "the folder cannot be made: " + failure.message(), "Name a file with --audit."};
    return state + "/taktwerk" + name;
}

}  // namespace taktwerk::hmi::web
