#pragma once
// One slave's process data before it has a place: which sync manager carries how many bytes of which objects. First half of
// the planner (process_data_plan.hpp); a pure function, run once per bring-up, outside the cycle.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

/// What the planner is told of one slave.
struct PlanSlave {
    std::string subject;    ///< for messages
    std::string sync_unit;  ///< empty: a unit of its own
    std::vector<SyncManagerDescription> sync_managers;
    std::vector<PdoDescription> rx, tx;  ///< as the slave maps them now, in the order of assignment
    /// With CoE a PDO belongs to the sync manager it names, else to the first of its direction, and the length follows from
    /// the PDOs. Without, PDOs that name none fill the managers in order, and the length is the description's.
    bool coe = true;
    std::uint8_t fmmus = 8, sync_manager_count = 8;  ///< what its controller has
    bool lrw = true;                                 ///< its controller executes LRW
    bool bitwise_fmmu = true;                        ///< its FMMUs map single bits, not only whole bytes
    std::optional<std::uint8_t> mailbox_in;          ///< the sync manager of its answers: "full" is mapped where an FMMU is left
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

/// One direction of one slave.
struct MappedHalf {
    /// Physical memory that one FMMU reaches: one sync manager, or several that lie without a gap.
    struct Run {
        std::uint16_t start = 0;
        std::uint16_t bytes = 0;
    };
    std::vector<PlannedSyncManager> sync_managers;
    std::vector<Run> runs;
    std::vector<MappedEntry> entries;  ///< bit offsets from the half's start
    std::uint32_t bytes = 0;
};

struct SlaveMapping {
    MappedHalf outputs, inputs;
    [[nodiscard]] std::size_t bytes() const noexcept { return std::size_t{outputs.bytes} + inputs.bytes; }
};

/// Errors: bus.plan.no_sync_manager, too_large, overlap, too_many_sync_managers, too_many_fmmus.
[[nodiscard]] Result<SlaveMapping> map_slave(const PlanSlave& slave);

/// Bits that the PDOs map.
[[nodiscard]] std::size_t mapped_bits(std::span<const PdoDescription> pdos) noexcept;

}  // namespace taktwerk::ecat
