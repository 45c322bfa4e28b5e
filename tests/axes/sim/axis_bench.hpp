#pragma once
// One simulated axis on a table with switches, driven by its objects as a master with a 1 ms cycle does.

#include <chrono>
#include <memory>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

using namespace std::chrono_literals;

/// Limit switches at -50000 and +50000 counts, home switch from 0 to 5000.
inline PlantConfig table() {
    PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_from = 0;
    plant.home_to = 5000;
    return plant;
}

/// No switch in the way.
inline PlantConfig long_table() {
    auto plant = table();
    plant.negative_limit = -1e9;
    plant.positive_limit = 1e9;
    return plant;
}

/// Exchanges each millisecond, as a master with a 1 ms cycle does.
struct Bench {
    Cia402Axis axis;
    AxisInputs in;
    AxisOutputs out;
    Instant now{};

    explicit Bench(PlantConfig plant = table(), const DriveProfile& profile = {}, const SimulatedMotor& motor = {})
        : axis(plant, std::make_shared<const DriveProfile>(profile), motor) {
        axis.power_on(now);
        axis.operational(true);
        in.mode = 8;
        cycle();
    }
    void cycle() {
        now += 1ms;
        axis.advance(now);
        axis.exchange(in, 1ms, out);
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) cycle();
    }
    void command(std::uint16_t word, int cycles = 3) {
        in.control = word;
        run(cycles);
    }
    void enable() {
        command(6);
        command(7);
        in.target_position = out.position;
        command(15);
    }
    [[nodiscard]] unsigned state() const { return out.status & 0x6Fu; }
};

}  // namespace taktwerk::axes::sim
