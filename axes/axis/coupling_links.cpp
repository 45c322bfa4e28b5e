#include "axes/axis/coupling_links.hpp"

#include <algorithm>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

void CouplingLinks::drop(Link& link) noexcept {
    if (link.cam.value != 0) body_.scene.tables->release(link.cam);
    if (link.waits) body_.alarms.clear(AxisAlarm::coupling_start_passed);
    link = {};
}

bool CouplingLinks::read(Link& link, Duration period) noexcept {
    for (std::size_t i = 0; i < link.masters.axes.size(); ++i) {
        if (!link.masters.axes[i].valid()) continue;
        const MasterSide* master = axis(link.masters.axes[i]);
        if (!master) return false;
        auto reading = master->reading(link.masters.sources[i]);
        // What is planned now acts at the drive a little later than what was measured: there the master will be.
        if (link.masters.sources[i] == mcActualValue)
            reading.age = std::max(0.0, to_seconds(body_.port.setpoint_effective(body_.now) - reading.taken));
        if (!link.tracks[i].next(reading, to_seconds(period))) return false;
    }
    return true;
}

EndlessMotion CouplingLinks::seen(const Link& link, std::size_t master) const noexcept {
    auto motion = link.tracks[master].motion();
    if (master != 0 || link.masters.axes[0] != state.phase_master) return motion;
    const auto& shift = state.phase.state();
    motion.place.local += shift.position;
    motion.velocity += shift.velocity;
    motion.trend += shift.velocity;
    motion.acceleration += shift.acceleration;
    return motion;
}

void CouplingLinks::end_phasing(Outcome outcome) noexcept {
    if (state.phasing.id != 0) body_.queue.record(state.phasing.id, outcome, ErrorId::none);
    state.phasing = {};
}

void CouplingLinks::clear_phase() noexcept {
    end_phasing(Outcome::aborted);
    state.phase.clear();
    state.phase_master = {};
}

const MasterSide* CouplingLinks::axis(AxisRef ref) const noexcept {
    const Axis* other = body_.scene.axis(ref);
    return other ? &AxisCore::side_of(*other) : nullptr;
}

}  // namespace taktwerk::axes
