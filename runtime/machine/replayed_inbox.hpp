#pragma once
// Where a recording goes in again at the places where the cycle takes what comes from outside: whoever replays a machine (runtime/replay/) puts in
// before each cycle what it had. Frames come over its transport. Not real-time; between two cycles, on their thread.

#include "runtime/machine/bus_look.hpp"
#include "runtime/machine/drive_desk.hpp"
#include "runtime/machine/modbus_devices.hpp"
#include "runtime/machine/operator_desk.hpp"
#include "runtime/machine/serial_drives.hpp"
#include "runtime/machine/supervisor.hpp"
#include "runtime/recording/inbox_reader.hpp"

namespace taktwerk::runtime {

/// All say whether the machine has what the record names.
class ReplayedInbox {
public:
    ReplayedInbox(MachineBody& body, ProgramRunner& programs, OperatorDesk& desk, SerialDrives& serial, ModbusDevices& modbus,
                  Supervisor& supervisor, DriveDesk& asked, BusLook& look)
        : body_(body),
          programs_(programs),
          desk_(desk),
          serial_(serial),
          modbus_(modbus),
          supervisor_(supervisor),
          asked_(asked),
          look_(look) {}

    /// From here on nothing comes from where it usually does.
    void begin() noexcept { body_.replayed = true; }

    [[nodiscard]] bool put(const LevelRecord& record) noexcept {
        if (record.axis >= body_.axes.size() && record.axis != StopLevels::all_axes) return false;
        if (record.level == StopLevel::release_jog && record.axis == StopLevels::all_axes) return false;
        desk_.levels().raise_again(record.level, record.axis, record.number);
        return true;
    }
    [[nodiscard]] bool put(const OperatorCommand& command) noexcept { return desk_.submit(command); }
    [[nodiscard]] bool put(const SampleRecord& record) noexcept { return serial_.replay(record.drive, record.sample); }
    [[nodiscard]] bool put(const RequestRecord& record) { return modbus_.replay(record.device, record.request, record.state); }
    [[nodiscard]] bool put(const WordRecord& record) { return modbus_.replay_word(record.device, record.channel, record.word); }
    [[nodiscard]] bool put(const DiskSays& says) noexcept {
        supervisor_.replay(says);
        return true;
    }
    [[nodiscard]] bool put(const FaultsSeen& seen) noexcept {
        supervisor_.page_faults().replay(seen);
        return true;
    }
    [[nodiscard]] bool put(const AskedRecord& record) {
        if (record.kind != AskedKind::ports) return asked_.ask_again(record);
        look_.begin();
        return true;
    }
    [[nodiscard]] bool put(const HookRecord& record) { return programs_.replay_hook(record.program, record.stop); }
    [[nodiscard]] bool put(const TaskTimesRecord& record) noexcept { return programs_.replay_times(record); }
    [[nodiscard]] bool put(const SlowRecord& record) noexcept {
        return record.task < programs_.slow_task_count() && programs_.run_slow_task(record.task);
    }
    /// All of a cycle is in.
    void complete() { modbus_.publish_replayed(); }

private:
    MachineBody& body_;
    ProgramRunner& programs_;
    OperatorDesk& desk_;
    SerialDrives& serial_;
    ModbusDevices& modbus_;
    Supervisor& supervisor_;
    DriveDesk& asked_;
    BusLook& look_;
};

}  // namespace taktwerk::runtime
