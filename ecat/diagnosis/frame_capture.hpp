#pragma once
// Frames into a pcap file that Wireshark and tshark read: outgoing ones as they left, incoming ones as they came. The tap side
// is real-time safe and may be the cycle; drain() and finish() belong to another thread (or to the same, between cycles).
//
//     auto capture = FrameCapture::create("bus.pcap", wall_time_at_zero);
//     master.set_tap(&FrameCapture::tap, capture->get());     ...     (*capture)->drain();     ...     (*capture)->finish();
//
// Format: pcap 2.4 with nanoseconds (magic A1B23C4Dh), link type 1 (Ethernet). Source: the pcap-savefile manual page.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/recorder.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::ecat {

class FrameCapture {
public:
    /// `epoch`: calendar time (since 1970) at machine time 0; zero in virtual time. Errors: capture.write.
    [[nodiscard]] static Result<std::unique_ptr<FrameCapture>> create(const std::string& path, Duration epoch = {});

    /// For Master::set_tap() and Exchange::set_tap(); `context` is the FrameCapture. What does not fit until the next drain() is
    /// dropped and counted.
    static void tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept;

    /// Writes what has come. Error capture.write, once: then nothing more is written.
    Result<void> drain();
    /// The rest, and the end of the file. Gives the error of an earlier drain(), too.
    Result<void> finish();

    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return ring_.dropped(); }

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    FrameCapture(std::string path, std::FILE* file, Duration epoch);
    [[nodiscard]] Error failure() const;

    static constexpr std::size_t ring_bytes = std::size_t{8} << 20;  ///< half a second of full frames at 10 kHz

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    Duration epoch_;
    Recorder ring_;
    std::uint64_t frames_ = 0;
    std::optional<Error> broken_;
};

}  // namespace taktwerk::ecat
