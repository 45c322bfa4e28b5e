#include "axes/sim/communication_watch.hpp"

#include "axes/sim/communication_error.hpp"

namespace taktwerk::axes::sim {

CommunicationWatch::CommunicationWatch(const DriveProfile& profile)
    : lost_data_(first_alarm(profile, DriveAlarmKind::communication, {0x7500})),
      lost_sync_(first_alarm(profile, DriveAlarmKind::sync_lost, lost_data_)),
      lost_time_(profile, profile.behaviour.lost_data_time),
      type_(profile, profile.behaviour.sync_type),
      losses_(profile, profile.behaviour.sync_losses),
      deviation_(profile, profile.behaviour.sync_deviation) {
    if (profile.behaviour.state.error_sub_code.index == 0) return;
    lost_data_.detail = communication_error::general;
    lost_sync_.detail = communication_error::sync;
}

void CommunicationWatch::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    for (auto* value : {&lost_time_, &type_, &losses_, &deviation_}) value->power_on(dictionary);
    operational_ = sync0_ = fresh_ = false;
    sync_watch_.restart({});
    data_at_ = sync_at_ = now;
}

void CommunicationWatch::synchronised(bool running, Duration cycle) noexcept {
    sync0_ = running;
    sync_watch_.restart(running ? cycle : Duration{});
}

void CommunicationWatch::operational(bool op, Instant now) noexcept {
    operational_ = op;
    data_at_ = sync_at_ = now;
}

void CommunicationWatch::exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept {
    fresh_ = cause.outputs;
    if (cause.outputs) data_at_ = now;
    if (!cause.sync0) return;
    sync_at_ = now;
    sync_watch_.signal(now, deviation());
}

void CommunicationWatch::watch(Cia402Axis& axis, Instant now) noexcept {
    watch_data(axis, now);
    watch_sync(axis, now);
}

void CommunicationWatch::watch_data(Cia402Axis& axis, Instant now) noexcept {
    if (!operational_ || !lost_time_.present() || lost_time_.get() <= 0) return;
    const bool enabled = axis.state() == Cia402Axis::State::enabled || axis.state() == Cia402Axis::State::quick_stop;
    const Duration patience = std::chrono::milliseconds{lost_time_.get()};
    if (!enabled) {  // watched only from enabling on
        data_at_ = sync_at_ = now;
        return;
    }
    if (sync0_ && watches_sync() && now - sync_at_ > patience) axis.raise(lost_sync_);
    else if (now - data_at_ > patience) axis.raise(lost_data_);
}

/// SV33-E 5.4, E.D32.
void CommunicationWatch::watch_sync(Cia402Axis& axis, Instant now) noexcept {
    if (!operational_ || !sync0_ || !losses_.present()) return;
    if (sync_watch_.lost(now, deviation()) > losses_.get()) axis.raise(lost_sync_);
}

}  // namespace taktwerk::axes::sim
