#pragma once
// What an axis sees of the machine around it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "axes/axis/command_queue.hpp"
#include "axes/tables/motion_tables.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

class Axis;

/// What an axis may follow besides its own commands: the other axes, the tables, the machine's digital points.
struct MotionScene {
    const Axis* first = nullptr;
    std::size_t count = 0;
    MotionTables* tables = nullptr;
    std::span<const std::int64_t> inputs;

    /// nullptr for an invalid handle.
    [[nodiscard]] const Axis* axis(AxisRef ref) const noexcept;
};

/// Axes that an axis follows now or will by commands it has; some may be named twice.
struct MasterList {
    std::array<AxisRef, 2 * (2 + 1 + CommandQueue::capacity) + 1> axes;  // and the axis that drives its group's path
    std::size_t count = 0;
};

}  // namespace taktwerk::axes
