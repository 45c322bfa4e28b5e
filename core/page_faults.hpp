#pragma once
// How often the kernel had to fetch memory for a thread: a page fault holds it up by a microsecond (the page was there, its entry was not) to
// milliseconds (it comes from a disk). Asked from outside the thread, for asking is a system call. Source: proc_pid_stat(5). Not real-time.

#include <cstdint>
#include <optional>
#include <string_view>

namespace taktwerk {

struct PageFaults {
    std::uint64_t minor = 0;  ///< without a disk
    std::uint64_t major = 0;  ///< with one
    friend bool operator==(const PageFaults&, const PageFaults&) = default;
};

/// Of one thread of this process.
class ThreadPageFaults {
public:
    explicit ThreadPageFaults(int thread_id);
    ~ThreadPageFaults();
    ThreadPageFaults(const ThreadPageFaults&) = delete;
    ThreadPageFaults& operator=(const ThreadPageFaults&) = delete;
    /// Since that thread began; nothing where it cannot be read. Any thread.
    [[nodiscard]] std::optional<PageFaults> read() const;

private:
    int file_;
};

/// Of a line of /proc/PID/task/TID/stat; nothing where it is none.
[[nodiscard]] std::optional<PageFaults> page_faults_in(std::string_view stat);

}  // namespace taktwerk
