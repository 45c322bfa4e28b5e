#include "apps/lcm/log_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

constexpr std::uint32_t sync_word = 0xEDA1DA01;

void put(std::byte* at, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) at[i] = static_cast<std::byte>(value >> (8 * (size - 1 - i)));
}

std::uint64_t get(const std::byte* at, int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | std::to_integer<std::uint64_t>(at[i]);
    return value;
}

}  // namespace

Result<LogReader> LogReader::open(const std::string& path) {
    OpenFile file(std::fopen(path.c_str(), "rbe"));
    struct stat info {};
    if (!file || ::fstat(::fileno(file.get()), &info) != 0 || !S_ISREG(info.st_mode))
        return Error{"lcm.log_open", path, fmt::format("the log cannot be read: {}", file ? "it is no file" : std::strerror(errno)),
                     "Give a file that `taktwerk lcm record` or lcm-logger has written."};
    return LogReader(std::move(file), static_cast<std::uint64_t>(info.st_size));
}

void LogReader::rewind() {
    std::rewind(file_.get());
    skipped_ = 0;
}

std::optional<LoggedMessage> LogReader::next() {
    std::array<std::byte, log_header> header;
    for (;;) {
        const auto begin = std::ftell(file_.get());
        const auto got = begin < 0 ? 0 : std::fread(header.data(), 1, header.size(), file_.get());
        if (got < header.size()) {
            skipped_ += got;
            return std::nullopt;
        }
        const auto channel_size = get(&header[20], 4), data_size = get(&header[24], 4);
        const auto behind = size_ - std::min<std::uint64_t>(size_, static_cast<std::uint64_t>(begin) + log_header);
        const bool sound = get(&header[0], 4) == sync_word && channel_size >= 1 && channel_size <= longest_channel &&
                           data_size <= longest_logged_message && channel_size + data_size <= behind;
        if (!sound) {
            // From the next byte that may begin one.
            const void* found = std::memchr(header.data() + 1, 0xED, header.size() - 1);
            const auto step = found == nullptr ? static_cast<long>(header.size())
                                               : static_cast<long>(static_cast<const std::byte*>(found) - header.data());
            skipped_ += static_cast<std::uint64_t>(step);
            if (std::fseek(file_.get(), begin + step, SEEK_SET) != 0) return std::nullopt;
            continue;
        }
        LoggedMessage message;
        message.number = static_cast<std::int64_t>(get(&header[4], 8));
        message.utime = static_cast<std::int64_t>(get(&header[12], 8));
        message.channel.resize(channel_size);
        message.data.resize(data_size);
        if (std::fread(message.channel.data(), 1, channel_size, file_.get()) != channel_size) return std::nullopt;
        if (data_size > 0 && std::fread(message.data.data(), 1, data_size, file_.get()) != data_size) return std::nullopt;
        return message;
    }
}

Result<LogWriter> LogWriter::create(const std::string& path) {
    const int made = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (made < 0 && errno == EEXIST) return Error{"lcm.log_exists", path, "the file is there already", "Give another name, or remove it."};
    OpenFile file(made < 0 ? nullptr : ::fdopen(made, "wb"));
    if (!file)
        return Error{"lcm.log_open", path, fmt::format("the log cannot be made: {}", std::strerror(errno)),
                     "Give a folder that may be written."};
    return LogWriter(std::move(file), path);
}

Error LogWriter::failed() const {
    return {"lcm.log_write", path_, fmt::format("the log cannot be written: {}", std::strerror(errno)),
            "Make room on that disk. What stands in the file can be read."};
}

Result<void> LogWriter::write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data) {
    std::array<std::byte, log_header> header;
    put(&header[0], sync_word, 4);
    put(&header[4], static_cast<std::uint64_t>(next_number_++), 8);
    put(&header[12], static_cast<std::uint64_t>(utime), 8);
    put(&header[20], channel.size(), 4);
    put(&header[24], data.size(), 4);
    const bool written = std::fwrite(header.data(), 1, header.size(), file_.get()) == header.size() &&
                         std::fwrite(channel.data(), 1, channel.size(), file_.get()) == channel.size() &&
                         std::fwrite(data.data(), 1, data.size(), file_.get()) == data.size();
    if (!written) return failed();
    bytes_ += header.size() + channel.size() + data.size();
    return {};
}

Result<void> LogWriter::flush() {
    if (std::fflush(file_.get()) != 0) return failed();
    return {};
}

}  // namespace taktwerk::apps
