#include "axes/axis/axis.hpp"

#include <utility>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

Axis::Axis(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index, AxisView* view)
    : core_(std::make_unique<AxisCore>(std::move(config), port, cycle, index, view)), view_(&core_->view()) {}
Axis::Axis(Axis&&) noexcept = default;
Axis& Axis::operator=(Axis&&) noexcept = default;
Axis::~Axis() = default;

void Axis::bind(const MotionScene& scene) { core_->bind(scene); }
const AxisConfig& Axis::config() const noexcept { return core_->config(); }
const DriveCommand& Axis::drive_command() const noexcept { return core_->drive_command(); }

void Axis::update(Instant now) noexcept { core_->update(now); }
void Axis::supervise(Instant now) noexcept { core_->supervise(now); }
void Axis::plan(Instant now, Duration period) noexcept { core_->plan(now, period); }
void Axis::encode(Instant now) noexcept { core_->encode(now); }

bool Axis::fetch_alarm(AlarmFact& fact) noexcept { return core_->fetch_alarm(fact); }
std::span<const AlarmFact> Axis::active_alarms() const noexcept { return core_->active_alarms(); }
void Axis::acknowledge_alarms() noexcept { core_->acknowledge_alarms(); }
void Axis::stop_for_error(AlarmId reason, bool then_power_off) noexcept { core_->stop_for_error(reason, then_power_off); }
void Axis::demand_emergency_stop(EmergencyStop level) noexcept { core_->demand_emergency_stop(level); }
void Axis::shut_down() noexcept { core_->shut_down(); }
void Axis::set_mode(OperatingMode mode) noexcept { core_->set_mode(mode); }
void Axis::take_control(Owner owner) noexcept { core_->take_control(owner); }
void Axis::release_control(Owner owner) noexcept { core_->release_control(owner); }
RetainedPosition Axis::retained() const noexcept { return core_->retained(); }
void Axis::restore(const RetainedPosition& position, const Gearing& gearing) noexcept { core_->restore(position, gearing); }

MasterTrack::Reading Axis::as_master(MC_Source source) const noexcept { return core_->as_master(source); }
MasterList Axis::masters() const noexcept { return core_->masters(); }
bool Axis::may_follow() const noexcept { return core_->may_follow(); }

Submitted Axis::submit(const AxisCommand& command, Owner owner) noexcept { return core_->submit(command, owner); }
ErrorId Axis::power(bool enable, bool positive, bool negative, Owner owner) noexcept {
    return core_->power(enable, positive, negative, owner);
}
ErrorId Axis::reset(Owner owner) noexcept { return core_->reset(owner); }
ErrorId Axis::set(const AxisSetting& setting, Owner owner) noexcept { return core_->set(setting, owner); }
ErrorId Axis::update(CommandId id, const AxisCommand& command, Owner owner) noexcept { return core_->update(id, command, owner); }
void Axis::release_stop(CommandId id, Owner owner) noexcept { core_->release_stop(id, owner); }
ErrorId Axis::renew_jog(CommandId id, double velocity, Owner owner) noexcept { return core_->renew_jog(id, velocity, owner); }

}  // namespace taktwerk::axes
