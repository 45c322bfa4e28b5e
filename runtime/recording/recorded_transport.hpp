#pragma once
// The transport of a machine, with a record of everything that it says: frames, departures, whether there is a link, how the ring stands. Without
// a recorder it only hands on. Cycle thread, real-time safe.
//
// link_up() and ring() say what was so at the last receive(): so what the cycle took is what was recorded, whenever it changes.

#include "core/recorder.hpp"
#include "ecat/ring/ring_view.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::runtime {

class RecordedTransport final : public ecat::Transport {
public:
    /// `inner` outlives this.
    explicit RecordedTransport(ecat::Transport& inner) : inner_(inner), ring_(inner.ring()), link_up_(inner.link_up()) {}

    /// Before the first frame. `recorder` outlives this.
    void record(Recorder& recorder) noexcept { recorder_ = &recorder; }

    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    [[nodiscard]] Instant departure(Instant now) const noexcept override;
    std::optional<ecat::ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] ecat::MacAddress mac() const noexcept override { return inner_.mac(); }
    [[nodiscard]] bool link_up() const noexcept override { return link_up_; }
    [[nodiscard]] std::optional<Error> link_trouble() const override { return inner_.link_trouble(); }
    [[nodiscard]] ecat::RingView* ring() noexcept override { return ring_; }

private:
    void note_line(Instant now) noexcept;

    ecat::Transport& inner_;
    ecat::RingView* ring_;
    Recorder* recorder_ = nullptr;
    bool link_up_;
    bool recorded_link_ = true;
    ecat::RingState recorded_ring_{.shape = ecat::RingShape::unknown};
    std::uint64_t last_hash_ = 0;  // of the frame that send() took last
};

}  // namespace taktwerk::runtime
