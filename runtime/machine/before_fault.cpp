#include "runtime/machine/before_fault.hpp"

#include <algorithm>

#include "axes/axis/alarms.hpp"
#include "ecat/bringup/bus.hpp"

namespace taktwerk::runtime {

BeforeFault::BeforeFault(MachineBody& body, const MachineDrives& drives)
    : body_(body), drives_(drives), axes_(std::make_unique<OfAxis[]>(body.config.axes.size())) {}

void BeforeFault::note(std::size_t axis) noexcept {
    const auto facts = body_.axes[axis].active_alarms();
    const bool faulted = std::any_of(facts.begin(), facts.end(), [](const AlarmFact& fact) {
        return fact.id == axes::id(axes::AxisAlarm::drive_fault) || fact.id == axes::id(axes::AxisAlarm::following_error);
    });
    auto& stall = axes_[axis].stall;
    if (!faulted) stall.store(-1, std::memory_order_relaxed);
    if (!faulted || stall.load(std::memory_order_relaxed) >= 0) return;
    const auto& link = body_.bus.bus().link;
    axes_[axis].gap.store(drives_.on_bus(axis) ? ecat::recent_gap(link, body_.now) : 0, std::memory_order_relaxed);
    stall.store(ecat::recent_stall(link, body_.now).count(), std::memory_order_relaxed);
}

}  // namespace taktwerk::runtime
