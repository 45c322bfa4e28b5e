#pragma once
// The machine as the bridge sees it: commands in, answers and snapshots out. runtime_link.hpp binds it to runtime::Machine;
// tests play one by hand. Service side, one thread, not real-time; what says "any thread" serves the door too (door.hpp).

#include <optional>
#include <string>

#include "axes/port/drive_profile.hpp"
#include "runtime/machine/bus_look.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/recording/signal_rows.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

class MachineLink {
public:
    virtual ~MachineLink() = default;
    /// False: the inbox is full.
    virtual bool submit(const runtime::OperatorCommand& command) = 0;
    virtual std::optional<runtime::CommandAnswer> next_answer() = 0;
    /// The newest snapshot, nullptr before the first cycle. Valid until the next call.
    virtual const runtime::Snapshot* latest() = 0;
    [[nodiscard]] virtual const runtime::MachineLayout& layout() const = 0;
    [[nodiscard]] virtual runtime::AlarmText describe(const AlarmFact& fact) const = 0;
    struct Drive {
        axes::DrivePort* port = nullptr;  ///< service side of it alone; nullptr: the axis has no drive
        const axes::DriveProfile* profile = nullptr;
    };
    /// Of an axis of the layout. Lives as long as the machine.
    [[nodiscard]] virtual Drive drive(std::uint16_t axis) = 0;
    /// For diagnosis. nullptr: there is none.
    [[nodiscard]] virtual ecat::Master* bus() { return nullptr; }
    /// How the ports of its slaves stand. nullptr where bus() is.
    [[nodiscard]] virtual runtime::BusLook* bus_look() { return nullptr; }
    /// Samples of a measurement, oldest first; false: none is there.
    virtual bool next_measure_sample(axes::MeasureSample& out) {
        (void)out;
        return false;
    }
    /// As configured; nullptr where nobody knows. Lives as long as the machine.
    [[nodiscard]] virtual const axes::AxisConfig* axis_config(std::uint16_t axis) const {
        (void)axis;
        return nullptr;
    }
    // --- any thread (layout(), too) ---
    /// The recording that was kept, or will be, around an alarm; empty: none. Service side.
    [[nodiscard]] virtual std::string recording_of(const AlarmFact&, Instant) const { return {}; }
    /// Every signal of the newest cycles; nullptr: this machine keeps none. Lives as long as the machine.
    [[nodiscard]] virtual const runtime::SignalRows* signals() const { return nullptr; }
    /// Of the cycle and the tasks; empty where there are none.
    [[nodiscard]] virtual runtime::MachineTimes times() const { return {}; }
    /// Levels, never queued, never refused: they work before the first cycle too (runtime/stop_levels.hpp). `axis`: all_axes, or of the layout.
    virtual runtime::StopLevels::Ticket request_stop(std::uint16_t axis) = 0;
    virtual runtime::StopLevels::Ticket release_jog(std::uint16_t axis) = 0;
    virtual runtime::StopLevels::Ticket request_shutdown() = 0;
    [[nodiscard]] virtual bool taken(runtime::StopLevels::Ticket ticket) const = 0;
    [[nodiscard]] virtual std::uint64_t levels_raised() const = 0;
    /// The cycle does not advance: since when and in whose code, one sentence. Whatever a snapshot shows then is old.
    [[nodiscard]] virtual std::optional<std::string> stuck() const { return std::nullopt; }
};

}  // namespace taktwerk::hmi
