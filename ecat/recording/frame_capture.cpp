#include "ecat/recording/frame_capture.hpp"

namespace taktwerk::ecat {

FrameCapture::FrameCapture(std::unique_ptr<PcapngFile> file) : file_(std::move(file)), ring_(ring_bytes, Recorder::Policy::drop_newest) {}

Result<std::unique_ptr<FrameCapture>> FrameCapture::create(const std::string& path, const PcapngFile::Head& head) {
    auto file = PcapngFile::create(path, head);
    if (!file) return file.error();
    return std::unique_ptr<FrameCapture>{new FrameCapture{std::move(*file)}};
}

void FrameCapture::tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept {
    static_cast<FrameCapture*>(context)->ring_.append(outgoing ? sent_frames : received_frames, at, frame);
}

Result<void> FrameCapture::drain() {
    Result<void> written;
    ring_.drain([&](const RecordView& record) {
        if (!broken_ && written) written = file_->packet(record.bytes, record.time, record.channel == sent_frames);
    });
    broken_ = broken_ || !written;
    return written;
}

Result<void> FrameCapture::finish() {
    (void)drain().ok();
    return file_->finish();
}

}  // namespace taktwerk::ecat
