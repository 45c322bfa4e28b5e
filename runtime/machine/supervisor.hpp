#pragma once
// Step 5: what holds is raised, the log decides what remains, the strongest reaction is carried out. Real-time safe.

#include <optional>
#include <vector>

#include "runtime/cycle_tick.hpp"
#include "runtime/machine/before_fault.hpp"
#include "runtime/machine/drive_emergencies.hpp"
#include "runtime/machine/emergency_inputs.hpp"
#include "runtime/machine/hot_connect.hpp"
#include "runtime/machine/late_cycles.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"
#include "runtime/machine/modbus_devices.hpp"
#include "runtime/machine/operator_desk.hpp"
#include "runtime/machine/page_fault_alarm.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/machine/shutdown.hpp"
#include "runtime/recording/inbox_record.hpp"
#include "runtime/retain/retain_keeper.hpp"

namespace taktwerk::runtime {

class Supervisor {
public:
    /// `retain`: nullptr where nothing is kept.
    Supervisor(MachineBody& body, MachineDrives& drives, HotConnect& groups, ModbusDevices& modbus, ProgramRunner& programs,
               OperatorDesk& desk, const RetainKeeper* retain);

    void step(const CycleTick& tick) noexcept;

    /// In the place of what the disk's thread says.
    void replay(const DiskSays& says) noexcept { replayed_disk_ = says; }

    [[nodiscard]] PageFaultAlarm& page_faults() noexcept { return page_faults_; }

    /// Any thread.
    [[nodiscard]] const BeforeFault& before_fault() const noexcept { return before_fault_; }
    [[nodiscard]] Duration longest_stop() const noexcept { return shutdown_.patience(); }

private:
    void raise_bus_alarms() noexcept;
    void raise_rivals() noexcept;
    void raise_retain() noexcept;
    void raise_inputs() noexcept;
    void raise_forces() noexcept;
    void supervise(std::size_t axis, axes::EmergencyStop level) noexcept;
    [[nodiscard]] bool follows_from_another(const AlarmFact& fact) noexcept;
    void react() noexcept;
    /// What the bus says of one slave stops the axes on it, and no others.
    void stop_axes_of_slaves() noexcept;
    /// What a program says of itself stops the axes that it powers or moves.
    void stop_axes_of_programs() noexcept;

    MachineBody& body_;
    MachineDrives& drives_;
    HotConnect& groups_;
    ModbusDevices& modbus_;
    ProgramRunner& programs_;
    OperatorDesk& desk_;
    const RetainKeeper* retain_;
    std::optional<DiskSays> replayed_disk_;
    DiskSays recorded_disk_;
    EmergencyInputs emergency_inputs_;
    LateCycles late_cycles_;
    PageFaultAlarm page_faults_;
    DriveEmergencies drive_emergencies_;
    BeforeFault before_fault_;
    Shutdown shutdown_;
    std::vector<Instant> explained_until_;  // per axis: what follows from another alarm is not listed until then
};

}  // namespace taktwerk::runtime
