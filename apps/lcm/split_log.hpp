#pragma once
// A log in one file up to a size, or in several of which the newest are kept.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "apps/lcm/log_file.hpp"

namespace taktwerk::apps {

class SplitLog {
public:
    struct Bounds {
        std::uint64_t file_bytes = 0;  ///< of one file; the next begins, or the log is full
        int keep = 0;                  ///< files FILE.0001, FILE.0002, ... of which so many are kept, the newest; 0: FILE alone
    };
    /// Errors: those of LogWriter::create().
    [[nodiscard]] static Result<SplitLog> create(std::string path, Bounds bounds);

    enum class Wrote : std::uint8_t { taken, full };
    /// `full`: it does not fit any more, and was not written. Errors: lcm.log_write, and those of create().
    [[nodiscard]] Result<Wrote> write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data);
    [[nodiscard]] Result<void> flush() { return writer_->flush(); }

    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_ + writer_->bytes(); }  ///< written, over all files
    [[nodiscard]] const std::string& last_file() const noexcept { return writer_->path(); }
    [[nodiscard]] int files() const noexcept { return made_; }

private:
    SplitLog(std::string path, Bounds bounds) : path_(std::move(path)), bounds_(bounds) {}
    [[nodiscard]] Result<void> begin_file();

    std::string path_;
    Bounds bounds_;
    std::optional<LogWriter> writer_;
    std::deque<std::string> kept_;
    std::uint64_t bytes_ = 0;
    int made_ = 0;
};

}  // namespace taktwerk::apps
