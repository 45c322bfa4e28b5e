#include "ecat/diagnosis/frame_capture.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint32_t nanosecond_magic = 0xA1B23C4D, longest_frame = 65535, ethernet = 1;
constexpr RecordChannel sent = 0, received = 1;

}  // namespace

FrameCapture::FrameCapture(std::string path, std::FILE* file, Duration epoch)
    : path_(std::move(path)), file_(file), epoch_(epoch), ring_(ring_bytes, Recorder::Policy::drop_newest) {}

Error FrameCapture::failure() const {
    return Error{"capture.write", path_, fmt::format("the frames cannot be written: {}", std::strerror(errno)),
                 "choose another place for the capture"};
}

Result<std::unique_ptr<FrameCapture>> FrameCapture::create(const std::string& path, Duration epoch) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    std::unique_ptr<FrameCapture> capture{new FrameCapture{path, file, epoch}};
    if (file == nullptr) return capture->failure();
    std::array<std::byte, 24> head{};
    store_le(std::span{head}, 0, nanosecond_magic);
    store_le(std::span{head}, 4, std::uint16_t{2});
    store_le(std::span{head}, 6, std::uint16_t{4});
    store_le(std::span{head}, 16, longest_frame);
    store_le(std::span{head}, 20, ethernet);
    if (std::fwrite(head.data(), head.size(), 1, file) != 1) return capture->failure();
    return capture;
}

void FrameCapture::tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept {
    static_cast<FrameCapture*>(context)->ring_.append(outgoing ? sent : received, at, frame);
}

Result<void> FrameCapture::drain() {
    const bool was_broken = broken_.has_value();
    ring_.drain([&](const RecordView& record) {
        if (broken_) return;
        const auto at = static_cast<std::uint64_t>((record.time.time_since_epoch() + epoch_).count());
        std::array<std::byte, 16> head{};
        store_le(std::span{head}, 0, static_cast<std::uint32_t>(at / 1'000'000'000u));
        store_le(std::span{head}, 4, static_cast<std::uint32_t>(at % 1'000'000'000u));
        store_le(std::span{head}, 8, static_cast<std::uint32_t>(record.bytes.size()));
        store_le(std::span{head}, 12, static_cast<std::uint32_t>(record.bytes.size()));
        const bool written = std::fwrite(head.data(), head.size(), 1, file_.get()) == 1 &&
                             std::fwrite(record.bytes.data(), record.bytes.size(), 1, file_.get()) == 1;
        if (written) ++frames_;
        else broken_ = failure();
    });
    if (broken_ && !was_broken) return *broken_;
    return {};
}

Result<void> FrameCapture::finish() {
    (void)drain().ok();
    if (!broken_ && std::fflush(file_.get()) != 0) broken_ = failure();
    if (broken_) return *broken_;
    return {};
}

}  // namespace taktwerk::ecat
