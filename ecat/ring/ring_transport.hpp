#pragma once
// A ring as one transport: two interfaces, the slaves in line between them. The rest of the master sends a frame and gets one back.
//
//   closed       a frame that leaves at the first interface passes all slaves and arrives at the second one: that is the answer. Its
//                twin runs the other way, past every processing unit, and tells nothing.
//   broken       each copy comes back to where it left, processed by the half that it reached. Both together are the answer (frame_merge).
//   half silent  the copy that came back is the answer, once the other one has had its time.
//   one way      closed, but of the twins none comes back: the next break would take slaves away, and somebody has to know before.
//   exchanged    closed, but it is the twin that passes the slaves from the first one on: the plugs are in each other's place.
//
// Nobody has to notice a break for the frames behind it to be right: both copies always leave, so a break costs the frames that are just
// passing it. Each frame that is sent is given back once at most, and receive() waits for nobody.
//
// What the second copy says differently, since its slaves are counted from the break on and would believe whoever sends a time:
//   auto-increment addresses   less the slaves in front of the second half, counted from the far end: whoever is missing moves nobody;
//   reference time (FRMW 0910h)  distributed only in the half that has the reference; the other half reads, or is handed the time on.
// The twin is told by its source address: the first interface's with the last byte changed.
// Source: ETG.1000.3 (order of processing, closed ports), ETG.1000.4; docs/ring.md.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "ecat/ring/frame_merge.hpp"
#include "ecat/ring/ring_state.hpp"
#include "ecat/ring/ring_view.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::ecat {

/// Counters since construction.
struct RingStatistics {
    std::uint64_t round = 0;        ///< answers that went round the closed ring
    std::uint64_t merged = 0;       ///< put together from two halves
    std::uint64_t single = 0;       ///< of one half alone
    std::uint64_t late_copies = 0;  ///< of frames that were given back already
    std::uint64_t mangled = 0;      ///< copies that were not what was sent
    std::uint64_t unsent = 0;       ///< copies that their interface did not take
};

class RingTransport final : public Transport, public RingView {
public:
    /// Both outlive the ring. `patience`: how long a copy that is back waits for its twin, after sending; at most what lies between send()
    /// and the receive() of the next cycle. Allocates all that it needs.
    RingTransport(Transport& first, Transport& second, Duration patience);
    ~RingTransport() override;
    RingTransport(const RingTransport&) = delete;
    RingTransport& operator=(const RingTransport&) = delete;

    /// One frame on each interface. False: neither took it.
    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    [[nodiscard]] Instant departure(Instant now) const noexcept override;
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] MacAddress mac() const noexcept override { return ends_[0]->mac(); }
    /// One is enough.
    [[nodiscard]] bool link_up() const noexcept override { return ends_[0]->link_up() || ends_[1]->link_up(); }
    [[nodiscard]] std::optional<Error> link_trouble() const override;
    [[nodiscard]] RingView* ring() noexcept override { return this; }

    // --- of the cycle's thread --------------------------------------------------------------------------------------------
    [[nodiscard]] const RingState& state() const noexcept override { return state_; }
    [[nodiscard]] const RingStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] bool link_up(std::size_t end) const noexcept override { return ends_[end]->link_up(); }
    void set_clocks(const RingClocks& clocks) noexcept override { clocks_ = clocks; }

private:
    static constexpr std::size_t first = 0, second = 1, copies = 2;
    static constexpr std::size_t most_under_way = 32;
    struct Flight;
    void prepare(Flight& flight, std::span<const std::byte> frame) noexcept;
    void set_clock(Flight& flight, std::size_t at) noexcept;
    [[nodiscard]] Flight& free_flight() noexcept;
    /// Keeps the copy in `frame`, which arrived at `end`. The flight that is complete by it.
    [[nodiscard]] Flight* take(std::span<const std::byte> frame, std::size_t end, Instant at, bool& ours) noexcept;
    [[nodiscard]] std::size_t give_back(Flight& flight, std::span<std::byte> buffer) noexcept;
    void learn(const Flight& flight) noexcept;
    [[nodiscard]] Flight* overdue(Instant now) noexcept;
    /// The second half was another one than the positions in it were meant for: whoever was asked may not have been.
    [[nodiscard]] bool missed_its_aim(const Flight& flight) const noexcept;
    /// Its other copy was under way when that end was still heard: it got lost.
    [[nodiscard]] bool is_half(const Flight& flight) const noexcept;

    std::array<Transport*, copies> ends_;
    Duration patience_;
    std::array<MacAddress, copies> sources_;  ///< of the two copies
    std::unique_ptr<std::array<Flight, most_under_way>> flights_;
    RingState state_{.shape = RingShape::unknown};
    RingStatistics statistics_;
    RingClocks clocks_;
    std::size_t home_of_reference_ = first;  ///< which copy meets the reference clock
    std::size_t asked_ = 0;                  ///< the interface that receive() asks next; behind the last: singles
    unsigned silent_frames_ = 0;             ///< that did not come back of what the first interface sent, in a row
    std::array<Instant, copies> heard_{};    ///< a copy of each came back last
    unsigned twins_missed_ = 0;              ///< of frames that went round, in a row
    bool exchanged_ = false;
    bool first_took_ = true;
};

}  // namespace taktwerk::ecat
