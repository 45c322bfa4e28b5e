#include "axes/axis/plan_order.hpp"

namespace taktwerk::axes {

void plan_axes(std::span<Axis> axes, Instant now, Duration period) noexcept {
    bool followers = false;
    for (auto& axis : axes) {
        const bool planned = axis.plan_unless_following(now, period);
        axis.plan_mark() = {.begun = planned, .planned = planned};
        followers = followers || !planned;
    }
    if (!followers) return;
    for (auto& root : axes) {
        // Depth first, with the way back noted in the axes themselves.
        Axis* at = &root;
        while (at) {
            auto& mark = at->plan_mark();
            mark.begun = true;
            Axis* before = nullptr;
            if (!mark.planned) {
                const auto masters = at->masters();
                for (std::size_t i = 0; i < masters.count && !before; ++i) {
                    const auto index = masters.axes[i].index;
                    // One that is begun but not planned would be a loop; submit refuses those.
                    if (index < axes.size() && !axes[index].plan_mark().begun) before = &axes[index];
                }
            }
            if (before) {
                before->plan_mark().slave = at;
                at = before;
                continue;
            }
            if (!mark.planned) at->plan(now, period);
            mark.planned = true;
            at = mark.slave;
            mark.slave = nullptr;
        }
    }
}

}  // namespace taktwerk::axes
