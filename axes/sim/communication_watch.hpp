#pragma once
// Process data and SYNC0 of one axis: whether they come, and the alarms when they do not. Sources: SV-DA200 3.1.2, 5.2 (Er24-c); SV33-E 5.4,
// 7.2.

#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/sync_watch.hpp"
#include "ecat/sim/device_model.hpp"

namespace taktwerk::axes::sim {

class CommunicationWatch {
public:
    explicit CommunicationWatch(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant now);
    /// SYNC0 runs each `cycle`, and the drive's clock is in step with it.
    void synchronised(bool running, Duration cycle) noexcept;
    void operational(bool op, Instant now) noexcept;
    void exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept;
    /// For tests of a clock that does not lock.
    void clock_locks(bool locks) noexcept { clock_locks_ = locks; }
    /// Looks for what does not come.
    void watch(Cia402Axis& axis, Instant now) noexcept;

    /// The exchange under way has brought outputs.
    [[nodiscard]] bool fresh() const noexcept { return fresh_; }
    [[nodiscard]] bool sync0() const noexcept { return sync0_; }
    /// The drive's clock follows SYNC0, as it shows.
    [[nodiscard]] bool locked() const noexcept { return sync0_ && watches_sync() && clock_locks_; }

private:
    void watch_data(Cia402Axis& axis, Instant now) noexcept;
    void watch_sync(Cia402Axis& axis, Instant now) noexcept;
    [[nodiscard]] bool watches_sync() const noexcept { return type_.present() ? type_.get() == 2 : sync0_; }
    [[nodiscard]] Duration deviation() const noexcept { return Duration{deviation_.get()}; }

    AlarmCode lost_data_, lost_sync_;
    BehaviourValue lost_time_, type_, losses_, deviation_;
    SyncWatch sync_watch_;
    bool fresh_ = false, sync0_ = false, operational_ = false, clock_locks_ = true;
    Instant data_at_{}, sync_at_{};
};

}  // namespace taktwerk::axes::sim
