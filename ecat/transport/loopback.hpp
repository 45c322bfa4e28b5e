#pragma once
// In-process transport: frames go to a FrameSink (the simulated bus) and come back after its flight time. Virtual time
// only: everything happens in send() and receive(), in the caller's thread, and is repeatable to the nanosecond.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::ecat {

/// The far end of a cable: whoever plays the slaves.
class FrameSink {
public:
    virtual ~FrameSink() = default;
    /// Time has passed up to `now` (never backwards). Called before frames are delivered or handed out.
    virtual void advance(Instant now) noexcept = 0;
    /// The frame leaves the master at `now` and runs through all slaves, which change it in place; its length stays.
    /// Returns the time until it is back at the master; nothing when it is lost on the way. Allocation-free.
    virtual std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept = 0;
    /// The frame that was processed last comes out at the other end of a ring, not where it went in.
    [[nodiscard]] virtual bool came_out_elsewhere() const noexcept { return false; }
};

/// Disturbances a test switches on. Each counter counts down with the frames it hits; 0 = off.
struct FaultPlan {
    std::uint32_t drop_requests = 0;  ///< lost before the slaves saw them
    std::uint32_t drop_answers = 0;   ///< the slaves acted, the answer is lost
    std::uint32_t delay_answers = 0;  ///< the next answers arrive `delay` later
    Duration delay{};
    std::uint32_t duplicate_answers = 0;
    std::uint32_t reorder_answers = 0;  ///< each waits until the answer that follows it has arrived
    std::uint32_t corrupt_answers = 0;  ///< one bit flips: number `corrupt_bit` of the frame, modulo its size
    std::uint32_t corrupt_bit = 0;
    bool link_down = false;  ///< send() refuses, nothing arrives
};

class LoopbackTransport final : public Transport {
public:
    /// Allocates all slots here. A frame sent when all slots are waiting is refused (send() returns false).
    explicit LoopbackTransport(FrameSink& sink, std::size_t slots = 64, const MacAddress& mac = {0x00, 0x54, 0x57, 0x00, 0x00, 0x01});

    bool send(std::span<const std::byte> frame, Instant now) noexcept override;
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override;
    [[nodiscard]] MacAddress mac() const noexcept override { return mac_; }
    [[nodiscard]] bool link_up() const noexcept override { return !faults.link_down; }

    /// From now on frames go to `sink` (which outlives the transport): a test puts something between cable and slaves.
    void plug_into(FrameSink& sink) noexcept { sink_ = &sink; }
    /// Where frames arrive that come out at the other end of a ring; outlives the transport. Once, for each of the two.
    void set_other_end(LoopbackTransport& other) noexcept { other_end_ = &other; }
    /// A cable breaks at `now`: what is on its way to here is lost.
    void lose_under_way(Instant now) noexcept;
    /// A frame that this master did not send arrives: somebody else is on the cable. Dropped when all slots are waiting.
    void inject(std::span<const std::byte> frame, Instant arrival) noexcept;
    /// When the next frame will arrive; nothing is on its way: nullopt. For tests that step to the event.
    [[nodiscard]] std::optional<Instant> next_arrival() const noexcept;

    FaultPlan faults;

private:
    struct Slot {
        std::array<std::byte, max_frame_size> bytes;
        std::size_t size = 0;  ///< 0 = free
        Instant arrival{};
        std::uint64_t order = 0;
        bool overtaken = false;  ///< reordered: arrives right after the next one
    };
    [[nodiscard]] Slot* free_slot() noexcept;
    [[nodiscard]] Slot* earliest() noexcept;

    void take_over(Slot& sent) noexcept;

    FrameSink* sink_;
    LoopbackTransport* other_end_ = nullptr;
    std::vector<Slot> slots_;
    MacAddress mac_;
    std::uint64_t order_ = 0;
};

}  // namespace taktwerk::ecat
