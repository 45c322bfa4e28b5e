#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

std::vector<AxisBinding> sides_of(const std::vector<AxisBinding>& axes) {
    auto sides = axes;
    for (const auto& axis : axes) {
        if (!axis.axis.gantry.on) continue;
        auto side = axis;
        side.axis.name += ".follower";
        side.axis.gearing.inverted = axis.axis.gearing.inverted != axis.follower.mirrored;
        side.axis.gantry = {};
        side.slave = axis.follower.slave;
        side.simulation.start += axis.simulation.racked;
        side.drive_axis = axis.follower.drive_axis;
        side.profile = axis.follower.profile;
        side.stored = axis.follower.stored;
        side.follower = {};
        sides.push_back(std::move(side));
    }
    return sides;
}

}  // namespace taktwerk::runtime
