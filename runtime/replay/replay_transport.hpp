#pragma once
// A cable that exists in a recording alone: it hands out the frames of a cycle in their order, and says of those that are sent what was said then.
// What is sent goes nowhere; whether it is what was sent then is for whoever records this machine and compares.

#include <cstddef>
#include <deque>

#include "core/recorder.hpp"
#include "ecat/ring/ring_view.hpp"
#include "ecat/transport/transport.hpp"
#include "runtime/recording/inbox_reader.hpp"

namespace taktwerk::runtime {

class ReplayTransport final : public ecat::Transport, public ecat::RingView {
public:
    explicit ReplayTransport(const WireRecord& wire) : mac_(wire.mac), is_ring_(wire.ring) {}

    /// Whether the channel is one of the cable's.
    [[nodiscard]] static bool is_mine(RecordChannel channel) noexcept;
    /// What the next cycle gets, in the order of the recording; the bytes have to stay. False: malformed.
    [[nodiscard]] bool put(const RecordView& record);
    /// The cycle is over: what it has not taken is gone.
    void clear() noexcept;

    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    [[nodiscard]] Instant departure(Instant now) const noexcept override;
    std::optional<ecat::ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] ecat::MacAddress mac() const noexcept override { return mac_; }
    [[nodiscard]] bool link_up() const noexcept override { return link_up_; }
    [[nodiscard]] RingView* ring() noexcept override { return is_ring_ ? this : nullptr; }

    [[nodiscard]] const ecat::RingState& state() const noexcept override { return state_; }
    [[nodiscard]] bool link_up(std::size_t) const noexcept override { return link_up_; }
    void set_clocks(const ecat::RingClocks&) noexcept override {}

private:
    struct Sent {
        Instant at;
        bool refused;
    };
    ecat::MacAddress mac_;
    bool is_ring_;
    bool link_up_ = true;
    ecat::RingState state_{.shape = ecat::RingShape::unknown};
    std::deque<RecordView> arriving_;  ///< frames, and how the line stood when they came
    std::deque<Sent> leaving_;
    std::optional<Instant> left_;  ///< the frame that send() took last
};

}  // namespace taktwerk::runtime
