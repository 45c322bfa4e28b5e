#pragma once
// The planner: from what the slaves are and what they map to sync managers, FMMUs, logical addresses, datagrams and expected
// working counters. A pure function, no I/O; run once per bring-up, outside the cycle. Which frame of a cycle carries a
// datagram: frame_schedule.hpp.
//
// A sync unit is a set of slaves whose process data is valid or not together: exchanged every `divisor` cycles, in datagrams of
// its own. By default each slave is its own unit, so that a silent slave takes nobody along. In the logical address space
// stand first the outputs of its slaves, then their inputs, each slave byte-aligned:
//
//     logical   | out A | out B | in A | in B |      expected WKC: per slave 2 for outputs + 1 for inputs
//     images    outputs: A B C ...   inputs: A B C ...   (one contiguous copy per datagram and direction)
//
// One LRW covers both. Where a slave of the unit does not execute LRW, an LWR covers the outputs and an LRD the inputs (1 each
// per slave). A unit larger than a frame gets several such blocks, cut between slaves; a slave larger than a frame is cut into
// windows of its block, which must leave in order (its sync managers open with the first byte and close with the last):
//
//     | out A ................ | in A ............... |
//     |   LRW, 1486 bytes   | continues, 1486 |  rest  |
//
// Behind the process data, apart by more than the 3 bytes that controllers want between an FMMU of bits and others of its
// direction, lies one bit per slave with a mailbox: "its answer mailbox is full", read each cycle by one small LRD.
//
// Source: ETG.1000.4 (FMMU, working counter); ET1100 data sheet, FMMU restrictions.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/process_image.hpp"
#include "core/result.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/layout/slave_mapping.hpp"
#include "ecat/wire/commands.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

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
    std::optional<std::size_t> unit;           ///< none: the slave has no process data
    std::optional<std::uint32_t> mailbox_bit;  ///< in the data of MailboxStatusPlan's datagram; none: not mapped, ask the slave
};

struct DatagramPlan {
    Command command = Command::LRW;  ///< or LWR, LRD
    std::uint32_t logical = 0;
    ImageRange outputs, inputs;  ///< in the datagram: outputs at 0, inputs behind them
    std::uint16_t expected_wkc = 0;
    std::size_t unit = 0;
    bool continues = false;  ///< not in an earlier frame than the datagram ahead of it
    std::vector<std::size_t> slaves;
    [[nodiscard]] std::size_t size() const noexcept { return std::size_t{outputs.size} + inputs.size; }
};

struct UnitPlan {
    std::string name;                      ///< empty: of one slave that names none
    std::uint16_t divisor = 1, phase = 0;  ///< exchanged in cycles n with n % divisor == phase
    std::size_t first = 0, count = 0;      ///< of its datagrams
    std::vector<std::size_t> slaves;       ///< ascending
    [[nodiscard]] bool due(std::uint64_t cycle) const noexcept { return cycles_until(cycle) == 0; }
    /// Cycles from `cycle` to the first one in which it is due; 0 .. divisor - 1.
    [[nodiscard]] std::uint16_t cycles_until(std::uint64_t cycle) const noexcept {
        return divisor == 1 ? std::uint16_t{0} : static_cast<std::uint16_t>((divisor + phase - cycle % divisor) % divisor);
    }
};

/// The bits "answer mailbox full" of all slaves that have it mapped.
struct MailboxStatusPlan {
    static constexpr std::size_t max_size = 256;
    std::uint32_t logical = 0;
    std::uint16_t size = 0;  ///< bytes, at most max_size; 0: no slave has it mapped, no datagram
    std::uint16_t expected_wkc = 0;
};

struct ProcessDataPlan {
    std::vector<SlavePlan> slaves;        ///< as in the argument
    std::vector<UnitPlan> units;          ///< in the order of their first slaves
    std::vector<DatagramPlan> datagrams;  ///< unit by unit
    MailboxStatusPlan mailbox;
    std::size_t frames = 0;  ///< the most that a cycle can need; at least 1: clock and AL status travel also without process data
    std::size_t output_bytes = 0, input_bytes = 0;
};

/// Errors: bus.plan.* (too many sync managers or FMMUs, sizes that do not fit, buffers that overlap, too many frames).
[[nodiscard]] Result<ProcessDataPlan> plan_process_data(std::span<const PlanSlave> slaves, std::span<const SyncUnitConfig> units = {});

}  // namespace taktwerk::ecat
