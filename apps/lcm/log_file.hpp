#pragma once
// LCM's log format, as lcm-logger writes and lcm-logplayer reads it: per message a header of 28 bytes (EDA1DA01h, number, us since 1970, length of the channel,
// length of the message; big-endian), the channel, the message. A file is read with bounds: it may be torn or no log. Not real-time.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

inline constexpr std::size_t log_header = 28;
inline constexpr std::size_t longest_channel = 63;                           ///< LCM's own bound
inline constexpr std::size_t longest_logged_message = std::size_t{1} << 28;  ///< likewise

struct LoggedMessage {
    std::int64_t number = 0, utime = 0;  ///< utime: when it was received
    std::string channel;
    std::vector<std::byte> data;
};

struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

class LogReader {
public:
    /// Errors: lcm.log_open.
    [[nodiscard]] static Result<LogReader> open(const std::string& path);
    /// Nothing: the end. What is no message is passed over until one begins again.
    [[nodiscard]] std::optional<LoggedMessage> next();
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }  ///< bytes that were no message
    void rewind();

private:
    LogReader(OpenFile file, std::uint64_t size) : file_(std::move(file)), size_(size) {}
    OpenFile file_;
    std::uint64_t size_, skipped_ = 0;
};

class LogWriter {
public:
    /// A file that is there already is not written over. Errors: lcm.log_exists, lcm.log_open.
    [[nodiscard]] static Result<LogWriter> create(const std::string& path);
    /// The number counts by itself. Errors: lcm.log_write.
    [[nodiscard]] Result<void> write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data);
    /// What is in memory goes to the file. Errors: lcm.log_write.
    [[nodiscard]] Result<void> flush();
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    LogWriter(OpenFile file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}
    [[nodiscard]] Error failed() const;
    OpenFile file_;
    std::string path_;
    std::int64_t next_number_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace taktwerk::apps
