#pragma once
// A wire for benchmarks: send() puts the frame on it, the slaves work when deliver() is called, receive() takes what came back.
// So the figures of receive() and send() are the controller's alone, as on a real wire.

#include <array>
#include <cstring>
#include <vector>

#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::bench {

class BetweenCycles final : public ecat::Transport {
public:
    explicit BetweenCycles(ecat::sim::SimNetwork& network) : network_(network), frames_(64) {}
    bool send(std::span<const std::byte> frame, Instant now) noexcept override {
        if (count_ == frames_.size()) return false;
        auto& f = frames_[count_++];
        std::memcpy(f.bytes.data(), frame.data(), frame.size());
        f.size = frame.size();
        f.at = now;
        return true;
    }
    std::optional<ecat::ReceivedFrame> receive(std::span<std::byte> buffer, Instant) noexcept override {
        if (taken_ == done_) return std::nullopt;
        const auto& f = frames_[taken_++];
        std::memcpy(buffer.data(), f.bytes.data(), f.size);
        return ecat::ReceivedFrame{f.size, f.at};
    }
    ecat::MacAddress mac() const noexcept override { return {0x00, 0x54, 0x57, 0, 0, 1}; }
    bool link_up() const noexcept override { return true; }

    /// After receive() has taken all: the slots are free for the next send().
    void deliver(Instant now) {
        std::size_t kept = 0;
        frames_sent_ = count_;
        wire_bytes_ = 0;
        for (std::size_t i = done_ = taken_ = 0; i < count_; ++i) {
            wire_bytes_ += frames_[i].size + preamble_checksum_gap;
            if (network_.process({frames_[i].bytes.data(), frames_[i].size}, frames_[i].at)) {
                if (kept != i) frames_[kept] = frames_[i];
                ++kept;
            }
        }
        done_ = kept;
        count_ = 0;
        network_.advance(now);
    }
    /// Of the last cycle.
    [[nodiscard]] std::size_t frames_sent() const noexcept { return frames_sent_; }
    /// As the cable carries them, with preamble, checksum and gap.
    [[nodiscard]] std::size_t wire_bytes() const noexcept { return wire_bytes_; }

private:
    static constexpr std::size_t preamble_checksum_gap = 8 + 4 + 12;
    struct Frame {
        std::array<std::byte, ecat::max_frame_size> bytes;
        std::size_t size = 0;
        Instant at{};
    };
    ecat::sim::SimNetwork& network_;
    std::vector<Frame> frames_;
    std::size_t count_ = 0, done_ = 0, taken_ = 0, frames_sent_ = 0, wire_bytes_ = 0;
};

}  // namespace taktwerk::bench
