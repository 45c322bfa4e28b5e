#pragma once
// What this computer did right before a drive complained. A drive supervises the frames; what it says right after this computer sent none, or
// after some were lost, is no fault of the drive (docs/faults.md).

#include <atomic>
#include <cstdint>
#include <memory>

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"

namespace taktwerk::runtime {

class BeforeFault {
public:
    BeforeFault(MachineBody& body, const MachineDrives& drives);

    /// Cycle, once for each axis. Real-time safe.
    void note(std::size_t axis) noexcept;

    /// Any thread. ns that this computer sent nothing right before the fault that the drive of the axis shows; 0: it was in time; -1: no fault.
    [[nodiscard]] std::int64_t stall(std::size_t axis) const noexcept { return axes_[axis].stall.load(std::memory_order_relaxed); }
    /// Any thread. Cycles in a row that were not answered right before it; valid as stall() is.
    [[nodiscard]] std::uint32_t gap(std::size_t axis) const noexcept { return axes_[axis].gap.load(std::memory_order_relaxed); }

private:
    struct OfAxis {
        std::atomic<std::int64_t> stall{-1};
        std::atomic<std::uint32_t> gap{0};
    };
    MachineBody& body_;
    const MachineDrives& drives_;
    std::unique_ptr<OfAxis[]> axes_;
};

}  // namespace taktwerk::runtime
