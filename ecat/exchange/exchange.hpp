#pragma once
// Sends frames over one transport and matches what comes back. Fixed slots, explicit states, no allocation after
// construction; everything here is real-time safe and belongs to one thread (the cycle, or whoever pumps).
//
//     auto slot = exchange.begin(FrameKind::cyclic);
//     auto lrw = exchange.add(*slot, Command::LRW, Address::logical(0), size);   // fill lrw->data
//     exchange.send(*slot, now);
//     ...
//     exchange.receive(now);
//     if (exchange.state(*slot) == SlotState::answered) use(exchange.data(*slot, lrw->number), exchange.wkc(*slot, lrw->number));
//     exchange.release(*slot);                                                   // unanswered: now lost
//
// An answer counts only if it has exactly the datagrams that were sent: command, index, address, length and order. (Slaves
// increment ADP of AP and B commands; there only the offset is compared.) Each frame has a generation; its bytes are spread
// over the datagrams' 8-bit indices, so that a frame of two datagrams is told from the 65535 before it. The index of a frame
// that got lost is not used again for a full round.
//
// A frame whose source address is not ours (slave controllers set the locally-administered bit, which does not count) was sent
// by another master on the cable. It is counted as foreign and never looked at again.
// Source: reference/ethercat-masters.md 2.4, F1 (a master that matched by index alone mistook late frames for fresh ones).

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/time.hpp"
#include "ecat/transport/transport.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {

enum class FrameKind : std::uint8_t { cyclic, acyclic };
enum class SlotState : std::uint8_t { free, building, sent, answered, lost };

/// A frame under way. Ids of released slots stay harmless: they read as `free`.
struct SlotId {
    std::uint8_t slot = 0;
    std::uint32_t generation = 0;  ///< 0 = no frame
    friend bool operator==(SlotId, SlotId) = default;
};

/// A datagram of a frame under construction.
struct DatagramRef {
    std::size_t number = 0;     ///< 0-based inside its frame
    std::span<std::byte> data;  ///< zeroed; valid until send()
};

/// Counters since construction.
struct ExchangeStatistics {
    std::uint64_t sent = 0;
    std::uint64_t received = 0;     ///< answers that matched
    std::uint64_t lost = 0;         ///< expired or released without an answer
    std::uint64_t late = 0;         ///< answers to frames already given up
    std::uint64_t duplicate = 0;    ///< answers to frames already answered
    std::uint64_t rejected = 0;     ///< not EtherCAT, mangled, or never sent by us
    std::uint64_t foreign = 0;      ///< sound EtherCAT frames of another source address: another master on the cable
    MacAddress foreign_source{};    ///< of the last of them
    std::uint64_t echoes = 0;       ///< our own frame, not touched by any slave
    std::uint64_t send_errors = 0;  ///< the link did not take a frame
};

class Exchange {
public:
    static constexpr std::size_t slot_count = 32;
    static constexpr std::size_t max_datagrams = 124;  ///< of 12 bytes each in one frame

    /// `transport` outlives the exchange. Allocates the frame buffers here.
    explicit Exchange(Transport& transport);
    ~Exchange();
    Exchange(const Exchange&) = delete;
    Exchange& operator=(const Exchange&) = delete;

    /// A free slot, now building; nothing when all are taken.
    [[nodiscard]] std::optional<SlotId> begin(FrameKind kind) noexcept;
    /// Room for one more datagram with this much data?
    [[nodiscard]] bool fits(SlotId id, std::size_t data_size) const noexcept;
    /// Appends a datagram; nothing when it does not fit or the slot is not building.
    std::optional<DatagramRef> add(SlotId id, Command command, Address address, std::size_t data_size) noexcept;
    /// Sends the frame. False: the link did not take it, or it has no datagram; the slot is then lost (release it).
    bool send(SlotId id, Instant now) noexcept;

    /// Takes everything that has arrived by `now` and matches it. Returns how many frames were answered.
    std::size_t receive(Instant now) noexcept;
    /// Frames sent at `now - timeout` or earlier and still unanswered become lost. One that came back untouched by any slave
    /// (an echo, or a cable without slaves) is then answered as it is, with working counters 0.
    void expire(Instant now, Duration timeout) noexcept;
    /// The same for one frame, whatever its age.
    void expire(SlotId id) noexcept;

    [[nodiscard]] SlotState state(SlotId id) const noexcept;
    [[nodiscard]] FrameKind kind(SlotId id) const noexcept;
    [[nodiscard]] std::size_t datagrams(SlotId id) const noexcept;
    /// Data of a datagram: after the answer, what the slaves made of it. Empty unless answered.
    [[nodiscard]] std::span<const std::byte> data(SlotId id, std::size_t number) const noexcept;
    /// 0 unless answered.
    [[nodiscard]] std::uint16_t wkc(SlotId id, std::size_t number) const noexcept;
    /// Bits of the IRQ field (reg::ecat_event_request of all slaves, ORed). 0 unless answered.
    [[nodiscard]] std::uint16_t irq(SlotId id, std::size_t number) const noexcept;
    /// How far ADP of an AP or B command was incremented: the number of slaves that the datagram passed. 0 unless answered.
    [[nodiscard]] std::uint16_t slaves_passed(SlotId id, std::size_t number) const noexcept;
    [[nodiscard]] Instant sent_at(SlotId id) const noexcept;
    /// When the frame really left, as the transport measured it; sent_at() where it does not.
    [[nodiscard]] Instant departed_at(SlotId id) const noexcept;
    /// Bytes of the finished frame, without FCS; 0 before send().
    [[nodiscard]] std::size_t frame_size(SlotId id) const noexcept;
    /// The answer is of one half of a broken ring alone (ReceivedFrame::half): a counter that is too low says nothing.
    [[nodiscard]] bool half(SlotId id) const noexcept;
    /// From send() to arrival; 0 unless answered.
    [[nodiscard]] Duration round_trip(SlotId id) const noexcept;
    /// Frees the slot. A frame that was sent and not answered counts as lost; its answer will count as late.
    void release(SlotId id) noexcept;

    [[nodiscard]] const ExchangeStatistics& statistics() const noexcept { return statistics_; }

    using Tap = void (*)(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept;
    /// Sees each frame as it goes out (`at`: its departure) and each as it came in, rejected ones too. May be null.
    void set_tap(Tap tap, void* context) noexcept;

private:
    using Buffer = std::array<std::byte, max_frame_size>;
    /// What became of the last frame that carried an index, to tell late answers from those never asked for.
    enum class Past : std::uint8_t { never, in_flight, answered, lost, quarantined };
    struct Slot;
    [[nodiscard]] Slot* find(SlotId id) const noexcept;
    bool match(std::span<const std::byte> frame, const ReceivedFrame& received) noexcept;
    void count_stray(Past& past) noexcept;
    [[nodiscard]] bool is_ours(std::span<const std::byte> frame) const noexcept;
    /// The slot that carries this index now.
    [[nodiscard]] Slot* carrier(std::uint8_t index) const noexcept;
    void give_up(Slot& slot) noexcept;
    void expire(Slot& slot) noexcept;
    void next_generation() noexcept;

    static constexpr std::size_t frames_per_receive = 64;  ///< bounds the cycle when the wire is flooded

    Transport& transport_;
    MacAddress source_;  ///< the transport's, without the locally-administered bit that slave controllers set
    std::unique_ptr<std::array<Slot, slot_count>> slots_;
    std::unique_ptr<Buffer> scratch_;
    std::array<Past, 256> past_{};
    std::array<std::uint8_t, 256> slot_of_{};  ///< by first index; meaningful while a slot carries that index
    std::uint32_t generation_ = 0;
    ExchangeStatistics statistics_;
    Tap tap_ = nullptr;
    void* tap_context_ = nullptr;
};

}  // namespace taktwerk::ecat
