#include "axes/axis/jog_lease.hpp"

#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/plannable.hpp"

namespace taktwerk::axes {

void JogLease::watch() noexcept {
    const auto& active = body_.queue.active();
    if (active.command.kind != CommandKind::jog || expired_ || body_.now - renewed_ < body_.config.patience.jog_lease) return;
    expired_ = true;
    conduct_.fail(AxisAlarm::jog_lease_expired, to_seconds(body_.config.patience.jog_lease));
    if (body_.state == AxisState::ErrorStop) return;  // where a harder reaction is chosen
    body_.begin_pending = false;
    aim_.at_velocity(0, dynamics_of(active.command, body_.config.limits, body_.config.defaults));
}

ErrorId JogLease::renew(CommandId id, double velocity) noexcept {
    auto& active = body_.queue.active();
    if (id == 0 || id != active.id || active.command.kind != CommandKind::jog || expired_) return ErrorId::state_forbids;
    if (!std::isfinite(velocity) || as_good_as_none(velocity, body_.config.limits.velocity)) return ErrorId::invalid_velocity;
    if (!measured_.permitted(velocity)) return ErrorId::interlocked;
    renewed_ = body_.now;
    if (velocity != active.command.velocity) {
        active.command.velocity = velocity;
        body_.begin_pending = true;
    }
    return ErrorId::none;
}

void JogLease::begin() noexcept {
    renewed_ = body_.now;
    expired_ = false;
    body_.alarms.clear(AxisAlarm::jog_lease_expired);
}

}  // namespace taktwerk::axes
