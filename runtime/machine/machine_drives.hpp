#pragma once
// What each axis moves or is measured by: a drive on the bus, one on a serial line, an amplifier on wires, an encoder, or none. Who stands on which slave.

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/encoder/encoder_port.hpp"
#include "axes/drives/gantry/gantry_port.hpp"
#include "axes/port/drive_port.hpp"
#include "runtime/machine/analog_wires.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/serial_drives.hpp"

namespace taktwerk::runtime {

class MachineDrives {
public:
    static constexpr auto no_slave = std::numeric_limits<std::size_t>::max();

    /// A port for each axis of the configuration, and `body.axes` on them. `lines` as SerialDrives has them.
    MachineDrives(MachineBody& body, const std::vector<modbus::SerialLine*>& lines, std::vector<Error>& errors);

    [[nodiscard]] axes::DrivePort& port(std::size_t axis) noexcept { return *ports_[axis]; }
    [[nodiscard]] const axes::DrivePort& port(std::size_t axis) const noexcept { return *ports_[axis]; }
    /// Index in the bus configuration; no_slave for an axis that is on none.
    [[nodiscard]] std::size_t slave_of(std::size_t axis) const noexcept { return slave_of_[axis]; }
    [[nodiscard]] bool on_bus(std::size_t axis) const noexcept { return slave_of_[axis] != no_slave; }
    [[nodiscard]] SerialDrives& serial() noexcept { return serial_; }
    [[nodiscard]] const SerialDrives& serial() const noexcept { return serial_; }

    /// Of a gantry: the slave whose drive shows an alarm.
    [[nodiscard]] std::string gantry_side(std::size_t axis) const;

    /// Service side: their services, and the lines'.
    void step(Instant now);
    /// Service side, once the bus is operational.
    [[nodiscard]] Result<void> resolve();
    /// Cycle: an alarm of a whole drive stops all of its axes. Real-time safe.
    void stop_axes_of_faulted_drives() noexcept;
    /// Cycle: what the wires of analog drives say, before the axes look at their drives; what they are given, when the axes have told them.
    void read_wires() noexcept { analog_.read(); }
    void write_wires() noexcept { analog_.write(); }
    /// Cycle: the outputs that open holding brakes are the axes', whatever a program wrote there. Real-time safe.
    void hold_brake_outputs() noexcept;

private:
    void build_ports();
    [[nodiscard]] std::unique_ptr<axes::DrivePort> on_bus_drive(std::size_t slave, const AxisBinding& side);
    [[nodiscard]] std::unique_ptr<axes::DrivePort> at_encoder(std::size_t slave, const AxisBinding& binding);
    void build_axes();

    MachineBody& body_;
    SerialDrives serial_;
    std::vector<std::unique_ptr<axes::DrivePort>> ports_;  // per axis
    std::vector<axes::cia402::Cia402Drive*> bus_drives_;   // those of `ports_` that are on the bus
    std::vector<axes::encoder::EncoderPort*> encoders_;    // of terminals: ports of their own, or within analog ones
    std::vector<axes::gantry::GantryPort*> gantries_;      // those of `ports_` that are two drives
    AnalogWires analog_;
    std::vector<std::size_t> slave_of_;  // per axis
    struct BrakeOutput {
        std::size_t axis, output;
    };
    std::vector<BrakeOutput> brakes_;
    std::vector<std::vector<std::size_t>> shared_;  // the axes of each slave that carries more than one
};

}  // namespace taktwerk::runtime
