#pragma once
// What pages have commanded, one JSON object a line, only ever appended to. A thread of its own writes: a disk that is full, slow or gone is told and
// disturbs nothing. What it could not write is counted, and the count is the next line that it can.

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

/// One file and those before it: `path`, `path.1` (newer) to `path.9`. Not thread-safe.
class AuditFile {
public:
    static constexpr std::uint64_t most_bytes = 8 * 1024 * 1024;  ///< bytes of one: then it becomes path.1
    static constexpr int kept = 9;                                ///< 80 MiB at most altogether

    /// Opens with O_APPEND, mode 0640. Errors: web.audit.
    static Result<AuditFile> open(const std::string& path, std::uint64_t longest = most_bytes);
    AuditFile(AuditFile&& other) noexcept;
    AuditFile& operator=(AuditFile&& other) noexcept;
    ~AuditFile();

    /// A whole line or nothing of it. Errors: web.audit.
    Result<void> append(const std::string& line);

private:
    AuditFile(int fd, std::string path, std::uint64_t size, std::uint64_t longest)
        : fd_(fd), path_(std::move(path)), size_(size), longest_(longest) {}
    void rotate();

    int fd_;
    std::string path_;
    std::uint64_t size_, longest_;
    bool torn_ = false;  ///< the last line ends in the middle
};

class AuditLog {
public:
    static constexpr std::size_t most_waiting = 1024;  ///< lines
    using Say = std::function<void(const Error&)>;     ///< called by the log's thread: once when it fails, not again until it has worked

    AuditLog(AuditFile file, Say say);
    /// What waits is written first.
    ~AuditLog();
    AuditLog(const AuditLog&) = delete;
    AuditLog& operator=(const AuditLog&) = delete;

    /// Never waits.
    void put(std::string line);

private:
    void work();

    AuditFile file_;
    Say say_;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<std::string> lines_;
    std::uint64_t missing_ = 0;
    bool ends_ = false;
    std::thread thread_;
};

/// $LOGS_DIRECTORY (systemd), /var/log/taktwerk where this user may write, $XDG_STATE_HOME/taktwerk, ~/.local/state/taktwerk; the last two are made.
/// Errors: web.audit.
[[nodiscard]] Result<std::string> default_audit_path();

}  // namespace taktwerk::hmi::web
