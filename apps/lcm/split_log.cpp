#include "apps/lcm/split_log.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::apps {

Result<SplitLog> SplitLog::create(std::string path, Bounds bounds) {
    SplitLog log(std::move(path), bounds);
    if (auto ok = log.begin_file(); !ok) return ok.error();
    return log;
}

Result<void> SplitLog::begin_file() {
    if (writer_) {
        if (auto ok = writer_->flush(); !ok) return ok;
        bytes_ += writer_->bytes();
    }
    ++made_;
    auto made = LogWriter::create(bounds_.keep > 0 ? fmt::format("{}.{:04}", path_, made_) : path_);
    if (!made) return made.error();
    writer_.emplace(std::move(*made));
    if (bounds_.keep == 0) return {};
    kept_.push_back(writer_->path());
    while (kept_.size() > static_cast<std::size_t>(bounds_.keep)) {
        std::error_code ignored;
        std::filesystem::remove(kept_.front(), ignored);
        kept_.pop_front();
    }
    return {};
}

Result<SplitLog::Wrote> SplitLog::write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data) {
    const auto size = log_header + channel.size() + data.size();
    if (writer_->bytes() > 0 && writer_->bytes() + size > bounds_.file_bytes) {
        if (bounds_.keep == 0) return Wrote::full;
        if (auto ok = begin_file(); !ok) return ok.error();
    }
    if (auto ok = writer_->write(utime, channel, data); !ok) return ok.error();
    return Wrote::taken;
}

}  // namespace taktwerk::apps
