#pragma once
// The simulated machine behind the bus: slaves, drives, mechanics, and what happens to them at given times. Built from the same
// configuration as the machine; reached by the master only through frames.

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "axes/sim/cia402_device.hpp"
#include "core/time.hpp"
#include "ecat/ring/ring_transport.hpp"
#include "ecat/sim/plain_device.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/world/analog_motor.hpp"
#include "runtime/world/group_world.hpp"
#include "runtime/world/modbus_world.hpp"
#include "runtime/world/serial_world.hpp"
#include "runtime/world/turned_encoder.hpp"

namespace taktwerk::runtime {

class World {
public:
    /// `config` has passed check(). `start`: the machine time now.
    World(const MachineConfig& config, Instant start);

    /// What a master is connected to: one cable, or two where the bus is a ring.
    [[nodiscard]] ecat::Transport& bus() noexcept { return ring_ ? static_cast<ecat::Transport&>(*ring_) : transport_; }
    /// The first cable by itself, with its faults.
    [[nodiscard]] ecat::LoopbackTransport& transport() noexcept { return transport_; }
    /// The second one; nullptr where the bus is no ring.
    [[nodiscard]] ecat::LoopbackTransport* second_transport() noexcept { return second_.get(); }
    [[nodiscard]] ecat::sim::SimNetwork& network() noexcept { return network_; }
    /// The serial lines; serial().lines() is for Machine::build.
    [[nodiscard]] SerialWorld& serial() noexcept { return serial_; }

    /// The Modbus TCP devices; modbus().exchanges() is for Machine::build.
    [[nodiscard]] ModbusWorld& modbus() noexcept { return modbus_; }

    /// Lets the configured events happen that are due. Called by whoever runs the cycle, before it.
    void apply_events(Instant now);
    /// Called with each apply_events(), on its thread: other hands on the machine. Set before anything runs.
    std::function<void(Instant)> also;
    /// Lets one thing happen now; `at` does not matter. From the thread that applies the events. Unknown names: nothing happens.
    void happen(const SimulationEvent& event);

    // --- hands on the machine: tests, demos -----------------------------------------------------------------------------------
    /// nullptr when the axis is not on a simulated drive.
    [[nodiscard]] axes::sim::Cia402Axis* drive(std::string_view axis) noexcept;
    /// nullptr when the axis is no analog one.
    [[nodiscard]] AnalogMotor* analog_motor(std::string_view axis) noexcept;
    /// The terminal of an axis' encoder reports that its position does not hold, or takes it back.
    void set_encoder_fault(std::string_view axis, bool holds);
    /// The contact of a named input point (before its `inverted`).
    void set_input(std::string_view point, bool value) { set_input_value(point, value ? 1 : 0); }
    /// What the field gives a named input point, of any width: the raw word of its object. A one-bit point takes 0 as FALSE.
    void set_input_value(std::string_view point, std::int64_t value);
    /// The terminal reports what it can of this input (its error bit, else the first of its states), or takes it back. A terminal that
    /// reports nothing: nothing happens.
    void set_input_fault(std::string_view point, bool holds);
    /// An input of a terminal: 0 or 1, and nothing else.
    [[nodiscard]] bool is_single_bit(std::string_view input) const noexcept;
    /// What a named output point drives at the terminal.
    [[nodiscard]] bool output(std::string_view point) const { return output_value(point) != 0; }
    /// The same as a raw word.
    [[nodiscard]] std::int64_t output_value(std::string_view point) const;
    /// The coupling between motor and load slips by so many u: what a load encoder shows from here on.
    void slip(std::string_view axis, double u);
    void set_slave_power(std::string_view slave, bool on);
    /// Pulls or plugs the cable in front of a slave.
    void set_cable(std::string_view slave, bool plugged);
    /// That of a ring's second interface.
    void set_ring_cable(bool plugged);

private:
    [[nodiscard]] ecat::sim::SimSlave* find(std::string_view slave) const noexcept;
    void close_ring(const MachineConfig& config);
    void lose_under_way();

    struct Point {
        IoPoint config;
        ecat::sim::PlainDevice* device = nullptr;  // either ...
        axes::sim::Cia402Device* drive = nullptr;  // ... or
        bool single_bit = false;
    };
    struct AxisPlace {
        std::string name;
        axes::sim::Cia402Axis* axis = nullptr;
        axes::sim::Cia402Device* device = nullptr;
        std::size_t index = 0;  ///< of the axis in its drive
    };
    [[nodiscard]] const AxisPlace* place(std::string_view axis) const noexcept;
    SerialWorld serial_;
    ModbusWorld modbus_;
    ecat::sim::SimNetwork network_;
    ecat::LoopbackTransport transport_;
    std::unique_ptr<ecat::LoopbackTransport> second_;  // of a ring
    std::unique_ptr<ecat::RingTransport> ring_;
    Instant start_;
    struct SlavePlace {
        std::string name;
        ecat::sim::SimSlave* slave;
    };
    std::vector<SlavePlace> slaves_;  // in cable order
    std::vector<AxisPlace> axes_;
    /// A load encoder: what its input counts for each count of the motor.
    struct LoadPlace {
        std::string axis, input;
        double counts_per_count = 0, counts_per_unit = 0, slipped = 0;
    };
    std::vector<LoadPlace> loads_;
    void add_encoders(const MachineConfig& config, const ecat::SlaveConfig& slave, const TurnedEncoder::Device& device);
    void turn_encoders(Instant now);
    struct EncoderPlace {
        TurnedEncoder encoder;
        ecat::sim::SimSlave* terminal;
        double counts_per_unit = 0;  ///< of the axis that turns it
    };
    std::vector<EncoderPlace> encoders_;
    /// An amplifier with its motor, at points of the machine.
    struct AnalogPlace {
        std::string axis;
        AnalogAxis wires;
        std::string brake;  ///< output that opens it; empty: none
        AnalogMotor motor;
    };
    void run_analog_motors(Instant now);
    void set_wired(const std::string& name, bool seen);
    std::vector<AnalogPlace> analogs_;
    std::optional<Instant> run_until_;
    /// A holding brake on an output of the machine.
    struct BrakePlace {
        std::string axis, output;
    };
    std::vector<BrakePlace> brakes_;
    std::vector<Point> points_;
    GroupWorld groups_{*this};
    std::vector<SimulationEvent> events_;  // by time
    std::size_t next_event_ = 0;
};

}  // namespace taktwerk::runtime
