#pragma once
// The rooms of a machine and the order of its cycle. Private to runtime/machine/machine*.cpp. A room reads the body and those above it here.

#include <atomic>
#include <memory>
#include <vector>

#include "core/stopwatch.hpp"
#include "runtime/cycle_histograms.hpp"
#include "runtime/machine/alarm_words.hpp"
#include "runtime/machine/bus_look.hpp"
#include "runtime/machine/drive_desk.hpp"
#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/hot_connect.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"
#include "runtime/machine/measuring.hpp"
#include "runtime/machine/modbus_devices.hpp"
#include "runtime/machine/operator_desk.hpp"
#include "runtime/machine/outcome_recorder.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/machine/replayed_inbox.hpp"
#include "runtime/machine/row_writer.hpp"
#include "runtime/machine/snapshot_writer.hpp"
#include "runtime/machine/supervisor.hpp"
#include "runtime/recording/outcome_record.hpp"
#include "runtime/retain/retain_keeper.hpp"

namespace taktwerk::runtime {

struct Machine::Impl {
    Impl(MachineConfig machine, ecat::Transport& transport, const std::vector<modbus::SerialLine*>& lines,
         const std::vector<modbus::tcp::Exchange*>& exchanges, std::vector<Error>& errors);

    void cycle(const CycleTick& tick) noexcept;
    /// Steps 2 to 8: what only an armed machine does.
    void compute(const CycleTick& tick) noexcept;
    /// Before it is armed.
    void wait_for_bus(const CycleTick& tick) noexcept;
    /// Steps 10 and 11.
    void tell(const CycleTick& tick) noexcept;
    /// People have asked for it.
    void reset_statistics() noexcept;
    /// What was kept into variables and parameters.
    void restore_values();
    /// What is done beside the cycle, where it is recorded.
    void note(Call call, Instant now = {}, std::size_t index = 0) noexcept {
        if (body.calls != nullptr) record_call(*body.calls, call, now, static_cast<std::uint16_t>(index));
    }
    /// The same of what may have a thread of its own: then the cycle records that it was done.
    void note_beside(Call call, std::size_t index = 0) noexcept {
        if (!body.threads_beside) note(call, {}, index);
    }
    void service_bus(Instant now);
    /// What is done beside the cycle has its place in a recording.
    [[nodiscard]] bool in_order() const noexcept { return body.recorder != nullptr || body.replayed; }
    void service_disk(Instant now) {
        if (retain && !body.replayed) retain->step(now);
    }
    void done(Step step) noexcept { steps.done(static_cast<std::size_t>(step)); }

    Result<void> arm();
    /// The outputs carry their safe values from the bus' first frames on: what enters OP must not find zeros. Service side.
    void lay_out_outputs();

    MachineBody body;
    MachineDrives drives;
    DriveDesk asked;
    BusLook look;
    HotConnect groups;
    ModbusDevices modbus;
    std::unique_ptr<RetainKeeper> retain;  // nullptr: nothing is kept
    HandMotion hands;
    Measuring measuring;
    GroupDesk axis_groups;
    ProgramRunner programs;
    OperatorDesk desk;
    Supervisor supervisor;
    OutcomeRecorder outcome;
    ReplayedInbox replayed;
    SnapshotWriter snapshots;
    MachineLayout layout;
    RowWriter rows;
    AlarmWords words;
    StepStatistics<step_count - 1> steps;
    CycleHistograms times;
    int power_fail = -1;                        // input point
    std::atomic<bool> outputs_laid_out{false};  // the cycle may write them although nothing runs yet
    std::atomic<std::uint64_t> pulse_cycles{0};
};

}  // namespace taktwerk::runtime
