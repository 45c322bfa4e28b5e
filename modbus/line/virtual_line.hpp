#pragma once
// A line for virtual time: when each byte arrives is computed from baud rate and format, so a run gives the same bytes at the same
// instants each time. Carries one frame at a time, as half-duplex wires do. Things can go wrong on request, by count, never by chance.
// Time passes for its stations by whoever uses it: send, receive and discard let them live on to their `now`.

#include <array>
#include <cstdint>
#include <vector>

#include "modbus/line/serial_line.hpp"
#include "modbus/line/station.hpp"

namespace taktwerk::modbus {

class VirtualLine final : public SerialLine {
public:
    explicit VirtualLine(const LineSettings& settings) noexcept : settings_(settings) {}

    /// Outlives the line.
    void connect(Station& station) { stations_.push_back(&station); }

    [[nodiscard]] const LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte> frame, Instant now) override;
    std::size_t receive(std::span<std::byte> into, Instant now) override;
    void discard(Instant now) override;
    [[nodiscard]] bool present() const noexcept override { return true; }
    /// Stations live on and hear what is due, in order of time.
    void advance(Instant now);

    /// No byte passes either way while it is cut.
    void cut(bool cut) noexcept { cut_ = cut; }
    /// The next answers do not come; the drive has heard and done what was asked.
    void lose_answers(std::uint32_t count) noexcept { lost_answers_ = count; }
    /// One bit of the next answers is turned round.
    void damage_answers(std::uint32_t count) noexcept { damaged_answers_ = count; }
    /// The last byte of the next answers is missing.
    void shorten_answers(std::uint32_t count) noexcept { short_answers_ = count; }
    /// Frames sent by the host since the beginning.
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }

private:
    void hear_request(Instant at);

    LineSettings settings_;
    std::vector<Station*> stations_;
    Frame request_;
    bool request_pending_ = false;
    Instant request_heard_at_{};
    Frame answer_;
    std::size_t answer_read_ = 0;
    Instant answer_begins_{};
    bool cut_ = false;
    std::uint32_t lost_answers_ = 0, damaged_answers_ = 0, short_answers_ = 0;
    std::uint64_t frames_ = 0;
};

}  // namespace taktwerk::modbus
