#pragma once
// What a motion block is handed: the time, the axis views of this scan, and the way to submit. No pointer is kept in a block.

#include <cstdint>
#include <span>

#include "axes/axis/axis_view.hpp"
#include "axes/axis/command.hpp"
#include "axes/tables/motion_tables.hpp"
#include "core/cycle_context.hpp"
#include "core/object_access.hpp"

namespace taktwerk::axes {

/// Where submitted requests go: straight to the axes (base task) or into a task's latch (slower tasks). One per task.
/// Every function answers at once and is real-time safe.
class AxisRequests {
public:
    virtual Submitted submit(AxisRef axis, const AxisCommand& command, Owner owner) noexcept = 0;
    /// MC_Power's level. Called each scan by whoever holds it; the strongest wish wins: two holders are an error (power_conflict).
    virtual ErrorId power(AxisRef axis, bool enable, bool positive, bool negative, Owner owner) noexcept = 0;
    virtual ErrorId reset(AxisRef axis, Owner owner) noexcept = 0;
    /// Something of the axis that is no motion, at once: coordinates, parameters, outputs, override, a fed set-point. Id 0 without an
    /// error: done (the next scan's views show it). With an id (a slower task): the views say what it came to, as of a command.
    virtual Submitted set(AxisRef axis, const AxisSetting& setting, Owner owner) noexcept = 0;
    /// ContinuousUpdate: the running (or waiting) command `id` goes on with other inputs, of the same kind. Relative inputs keep the
    /// conditions of its start. Cheap when nothing differs: called each scan. An id that is over: none.
    virtual ErrorId update(AxisRef axis, CommandId id, const AxisCommand& command, Owner owner) noexcept = 0;
    /// MC_Stop's Execute fell: the lock goes when the axis stands.
    virtual void release_stop(AxisRef axis, CommandId id, Owner owner) noexcept = 0;
    /// Keeps a jog alive; without it the axis stops after its lease.
    virtual ErrorId renew_jog(AxisRef axis, CommandId id, double velocity, Owner owner) noexcept = 0;

protected:
    ~AxisRequests() = default;
};

class GroupAccess;  // axes/group/group_access.hpp

struct MotionContext : CycleContext {
    std::span<const AxisView> axes;
    AxisRequests* requests = nullptr;
    Owner owner = Owner::program;
    ObjectAccess* objects = nullptr;  ///< of the bus' devices; nullptr where there is no bus
    GroupAccess* groups = nullptr;    ///< of axes that move together; nullptr where there are none, and in slower tasks
    MotionTables* tables = nullptr;   ///< cams, profiles over time, cam switches; nullptr where nobody declared any
    // One value per declared point of the whole machine, indexed by the handles.
    std::span<const std::int64_t> inputs;
    std::span<std::int64_t> outputs;
    std::span<const std::uint8_t> output_bits;  ///< how many of them each output has on the wire; empty: not known

    /// What the wire carries of an output point that exists: bits beyond are cut off.
    [[nodiscard]] std::uint64_t output_mask(std::size_t point) const noexcept {
        const unsigned bits = point < output_bits.size() ? output_bits[point] : 64;
        return bits < 64 ? (std::uint64_t{1} << bits) - 1 : ~std::uint64_t{0};
    }

    /// nullptr for an invalid handle: blocks answer with ErrorId::invalid_axis.
    [[nodiscard]] const AxisView* view(AxisRef axis) const noexcept { return axis.index < axes.size() ? &axes[axis.index] : nullptr; }
};

}  // namespace taktwerk::axes
