#pragma once
// A cable that lies: between the transport and the simulated slaves it changes what the faults of a transport cannot: working
// counters, the reference time, single bits of requests and answers whose checksum is right, the order of answers.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "core/bytes.hpp"
#include "ecat/transport/loopback.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::test {

class TamperedCable final : public FrameSink {
public:
    explicit TamperedCable(FrameSink& slaves) : slaves_(slaves) {}

    /// Added to the working counter of every LRW while not 0.
    int working_counter_offset = 0;
    /// System times that are read stay what the first one was when this was set.
    bool freeze_reference_time = false;
    /// So many of the next frames have one bit flipped on the way out (or back), behind the Ethernet header.
    std::uint32_t flip_requests = 0, flip_answers = 0;
    std::uint32_t flip_bit = 0;  ///< which, modulo the frame; moves on with each frame
    /// So many of the next answers come later than the one behind them.
    std::uint32_t reorder = 0;
    Duration reorder_by{};

    void advance(Instant now) noexcept override { slaves_.advance(now); }
    [[nodiscard]] bool came_out_elsewhere() const noexcept override { return slaves_.came_out_elsewhere(); }
    std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept override {
        if (flip_requests > 0) {
            --flip_requests;
            flip(frame);
        }
        auto flight = slaves_.process(frame, now);
        if (!freeze_reference_time) frozen_.reset();
        if (!flight) return flight;
        if (working_counter_offset != 0 || freeze_reference_time) change_answer(frame);
        if (flip_answers > 0) {
            --flip_answers;
            flip(frame);
        }
        if (reorder > 0 && reorder-- % 2 == 1) *flight += reorder_by;
        return flight;
    }

private:
    void flip(std::span<std::byte> frame) noexcept {
        if (frame.size() <= ethernet_header_size) return;
        const std::size_t bits = (frame.size() - ethernet_header_size) * 8;
        const std::size_t bit = ethernet_header_size * 8 + flip_bit % bits;
        frame[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        flip_bit += 7919;  // a prime: another place in the next frame
    }
    void change_answer(std::span<std::byte> frame) noexcept {
        FrameReader reader{frame};
        std::size_t at = ethernet_header_size + ecat_header_size;
        while (const auto datagram = reader.next()) {
            const std::size_t data = at + datagram_header_size, counter = data + datagram->data.size();
            if (datagram->command == Command::LRW)
                store_le(frame, counter, static_cast<std::uint16_t>(load_le<std::uint16_t>(frame, counter) + working_counter_offset));
            const bool reads_time = (datagram->command == Command::FRMW || datagram->command == Command::FPRD) &&
                                    datagram->address.ado() == reg::dc_system_time && datagram->data.size() == 8;
            if (reads_time && freeze_reference_time) {
                if (!frozen_) frozen_ = load_le<std::uint64_t>(frame, data);
                store_le(frame, data, *frozen_);
            }
            at = counter + 2;
        }
    }

    FrameSink& slaves_;
    std::optional<std::uint64_t> frozen_;
};

}  // namespace taktwerk::ecat::test
