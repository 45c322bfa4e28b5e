#pragma once
// Which units are exchanged in which cycle, and which frame carries which datagram.
//
// The first frame carries [FRMW clock] ... [BRD AL status] [LRD mailbox status]; the rest of its room and further frames are
// filled with the datagrams of the units that are due, each in the first frame that has room for it. Units with a divisor are
// spread over the cycles so that the fullest cycle is as empty as can be; the same plan gives the same spread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ecat/layout/process_data_plan.hpp"

namespace taktwerk::ecat {

/// Bytes of an Ethernet frame that datagrams may fill: 1514 - 14 - 2.
inline constexpr std::size_t frame_capacity = max_frame_size - ethernet_header_size - ecat_header_size;
/// Cyclic frames at the same time. The exchange has slots for these and for the acyclic ones.
inline constexpr std::size_t max_cyclic_frames = 28;

/// Fills the frames of one cycle. Real-time safe.
class FramePacker {
public:
    explicit FramePacker(const MailboxStatusPlan& mailbox) noexcept;
    /// The frame for a datagram: the first from `from` on that has room. Nothing when that would be one too many.
    [[nodiscard]] std::optional<std::size_t> place(std::size_t data_size, std::size_t from = 0) noexcept;
    [[nodiscard]] std::size_t frames() const noexcept { return frames_; }

    /// Data that a datagram in the first frame can carry beside the others that are always there.
    [[nodiscard]] static std::size_t room_in_first(const MailboxStatusPlan& mailbox) noexcept;

private:
    std::array<std::uint16_t, max_cyclic_frames> room_;
    std::size_t frames_ = 1;
    std::size_t open_ = 0;  ///< frames before it have no room for any datagram
};

/// Sets `phase` of each unit.
void stagger(ProcessDataPlan& plan);

/// Frames that leave in a cycle.
[[nodiscard]] std::size_t frames_in_cycle(const ProcessDataPlan& plan, std::uint64_t cycle) noexcept;

/// What one cycle puts on the wire.
struct CycleLoad {
    std::size_t bytes = 0;  ///< of frames with their headers, without preamble, FCS and gap
    std::size_t frames = 0;
    Duration wire{};  ///< so long the line is busy with them, at 100 Mbit/s
};
/// Of the cycle in which most is due. For a plan that is staggered; not for the cycle itself.
[[nodiscard]] CycleLoad fullest_cycle(const ProcessDataPlan& plan);

/// Frames when all units are due at once; nothing when there would be too many.
[[nodiscard]] std::optional<std::size_t> frames_at_most(const ProcessDataPlan& plan) noexcept;

}  // namespace taktwerk::ecat
