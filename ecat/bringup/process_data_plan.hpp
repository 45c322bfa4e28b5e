#pragma once
// The planner: from what the slaves are and what they map to sync managers, FMMUs, logical addresses, datagrams, frames and
// expected working counters. A pure function, no I/O; run once per bring-up, outside the cycle.
//
// Layout. A sync unit is a set of slaves whose process data is valid or not together: one LRW datagram with one working
// counter (more when it would not fit a frame). By default each slave is its own unit, so that a silent slave takes nobody
// along. In a datagram stand first the outputs of its slaves, then their inputs, each slave byte-aligned:
//
//     logical   | out A | out B | in A | in B |      expected WKC: per slave 2 for outputs + 1 for inputs
//     images    outputs: A B C ...   inputs: A B C ...   (one contiguous copy per datagram and direction)
//
// A frame carries [FRMW clock] LRW.. [BRD AL status] (the first) or LRW.. (the others).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/process_image.hpp"
#include "core/result.hpp"
#include "ecat/device_description.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

/// What the planner is told of one slave.
struct PlanSlave {
    std::string subject;    ///< for messages
    std::string sync_unit;  ///< empty: a unit of its own
    std::vector<SyncManagerDescription> sync_managers;
    std::vector<PdoDescription> rx, tx;  ///< as the slave maps them now, in the order of assignment
    bool coe = true;                     ///< all PDOs of a direction belong to its first sync manager; else they fill the managers in order
    std::uint8_t fmmus = 8, sync_manager_count = 8;  ///< what its controller has
    bool lrw = true;                                 ///< its controller executes LRW
};

struct PlannedSyncManager {
    std::uint8_t number = 0;
    SyncManager registers;
    friend bool operator==(const PlannedSyncManager&, const PlannedSyncManager&) = default;
};

/// An object in a process image. Bit offset from the start of the image.
struct MappedEntry {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint8_t bits = 0;
    std::uint32_t bit_offset = 0;
    friend bool operator==(const MappedEntry&, const MappedEntry&) = default;
};

/// Bytes of a process image.
struct ImageRange {
    std::uint32_t offset = 0, size = 0;
    friend bool operator==(const ImageRange&, const ImageRange&) = default;
};

struct SlavePlan {
    std::vector<PlannedSyncManager> sync_managers;  ///< process data only
    std::vector<Fmmu> fmmus;                        ///< unit n at n
    ImageRange outputs, inputs;
    std::vector<MappedEntry> mapped_outputs, mapped_inputs;
    std::optional<std::size_t> datagram;  ///< none: the slave has no process data
};

struct DatagramPlan {
    std::uint32_t logical = 0;
    ImageRange outputs, inputs;  ///< in the datagram: outputs at 0, inputs behind them
    std::uint16_t expected_wkc = 0;
    std::size_t frame = 0;
    std::vector<std::size_t> slaves;
    [[nodiscard]] std::size_t size() const noexcept { return outputs.size + inputs.size; }
};

struct ProcessDataPlan {
    std::vector<SlavePlan> slaves;        ///< as in the argument
    std::vector<DatagramPlan> datagrams;  ///< ascending by frame
    std::size_t frames = 0;               ///< at least 1: clock and AL status travel also without process data
    std::size_t output_bytes = 0, input_bytes = 0;
};

/// Bytes of an Ethernet frame that datagrams may fill: 1514 - 14 - 2.
inline constexpr std::size_t frame_capacity = 1498;

/// Errors: bus.plan.* (too many sync managers or FMMUs, sizes that do not fit, buffers that overlap, no LRW).
[[nodiscard]] Result<ProcessDataPlan> plan_process_data(std::span<const PlanSlave> slaves);

/// Bits that the PDOs map.
[[nodiscard]] std::size_t mapped_bits(std::span<const PdoDescription> pdos) noexcept;

}  // namespace taktwerk::ecat
