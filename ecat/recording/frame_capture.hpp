#pragma once
// Every frame into a file that Wireshark and tshark read: outgoing ones as they left, incoming ones as they came. The tap side
// is real-time safe and may be the cycle; drain() and finish() belong to another thread (or to the same, between cycles).
//
//     auto capture = FrameCapture::create("bus.pcapng", {.epoch = wall_time_at_zero});
//     master.set_tap(&FrameCapture::tap, capture->get());     ...     (*capture)->drain();     ...     (*capture)->finish();

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/recorder.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/recording/pcapng_file.hpp"

namespace taktwerk::ecat {

/// Of frames in a Recorder.
inline constexpr RecordChannel sent_frames = 0, received_frames = 1;

class FrameCapture {
public:
    /// Errors: capture.write.
    [[nodiscard]] static Result<std::unique_ptr<FrameCapture>> create(const std::string& path, const PcapngFile::Head& head = {});

    /// For Master::set_tap() and Exchange::set_tap(); `context` is the FrameCapture. What does not fit until the next drain() is
    /// dropped and counted.
    static void tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept;

    /// Writes what has come. Error capture.write, once: then nothing more is written.
    Result<void> drain();
    /// The rest, and the end of the file. Gives the error of an earlier drain(), too.
    Result<void> finish();

    [[nodiscard]] std::uint64_t frames() const noexcept { return file_->packets(); }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return ring_.dropped(); }

private:
    explicit FrameCapture(std::unique_ptr<PcapngFile> file);

    static constexpr std::size_t ring_bytes = std::size_t{8} << 20;  ///< half a second of full frames at 10 kHz

    std::unique_ptr<PcapngFile> file_;
    Recorder ring_;
    bool broken_ = false;
};

}  // namespace taktwerk::ecat
