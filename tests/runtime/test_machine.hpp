#pragma once
// A whole machine in virtual time for tests: real frames, simulated slaves and drives, built from structs.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/machine/machine.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "runtime/world/world.hpp"
#include "tests/ecat/tampered_cable.hpp"
#include "tests/machines/plain_machine.hpp"
#include "tests/machines/replay_check.hpp"
#include "tests/runtime/drive_oracle.hpp"

namespace taktwerk::runtime::testing {

using namespace std::chrono_literals;

/// Follows one axis through all cycles.
struct AxisWatch {
    double largest_step = 0;      ///< u between two set-points while the drive was enabled
    double largest_velocity = 0;  ///< of the set-point, u/s
    double previous = 0;
    bool was_enabled = false;
    bool homed = false;
};

class TestMachine {
public:
    explicit TestMachine(const MachineConfig& config) : TestMachine(config, config) {}
    /// On the cable stands something else than the machine was told: `there`.
    TestMachine(MachineConfig config, const MachineConfig& there)
        : clock(Instant{} + 1s), world(there, clock.now()), cable(world.network()) {
        world.transport().plug_into(cable);
        auto built = Machine::build(std::move(config), world.bus(), world.serial().lines(), world.modbus().exchanges());
        if (auto* errors = std::get_if<1>(&built)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return;
        }
        machine = std::move(std::get<0>(built));
        runner = std::make_unique<VirtualRunner>(*machine, world, clock);
        replayed.watch(*machine, runner.get(), clock.now());
        watch.resize(machine->layout().axes.size());
        for (const auto& binding : machine->config().axes) oracles.emplace_back(binding, machine->config().cycle);
        runner->after_cycle = [this](Instant) { each_cycle(); };
    }
    TestMachine(const TestMachine&) = delete;
    TestMachine& operator=(const TestMachine&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~TestMachine() {
        for (const auto& oracle : oracles) EXPECT_TRUE(oracle.clean()) << oracle.report();
    }
    bool up() {
        auto ok = runner->bring_up();
        if (!ok) ADD_FAILURE() << ok.error().text();
        run(2ms);
        return ok.ok();
    }
    void run(Duration d) { runner->run_for(d); }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        return runner->run_until([&] { return condition(); }, patience);
    }
    const Snapshot& state() {
        const auto* s = machine->latest();
        return *s;
    }
    const axes::AxisView& axis(std::size_t i) { return state().axes[i]; }

    /// What the drive of an axis is told since this cycle.
    ToldDrive told(std::size_t i) { return taps_[i]->drive.told(machine->bus().outputs()); }

    /// Sends an operator command and returns its answer.
    CommandAnswer command(OperatorCommand c) {
        c.client = 1;
        c.sequence = ++sequence;
        EXPECT_TRUE(machine->submit(c));
        for (int i = 0; i < 10; ++i) {
            run(machine->config().cycle);
            while (auto answer = machine->next_answer())
                if (answer->sequence == sequence) return *answer;
        }
        ADD_FAILURE() << "no answer";
        return {};
    }
    CommandAnswer command(OperatorAction action, std::uint16_t axis = 0xFFFF, bool flag = false, double value = 0, double value2 = 0) {
        OperatorCommand c;
        c.action = action;
        c.axis = axis;
        c.index = axis;
        c.flag = flag;
        c.value = value;
        c.value2 = value2;
        return command(c);
    }
    CommandAnswer mode(Mode wanted) {
        OperatorCommand c;
        c.action = OperatorAction::set_mode;
        c.mode = wanted;
        return command(c);
    }
    /// Power on and wait.
    void enable(std::uint16_t axis) {
        EXPECT_EQ(command(OperatorAction::power, axis, true).answer, Answer::accepted);
        EXPECT_TRUE(until([&] { return this->axis(axis).powered; }, 3s)) << "axis " << axis << " did not power on";
    }
    void home(std::uint16_t axis) {
        EXPECT_EQ(command(OperatorAction::home, axis).answer, Answer::accepted);
        EXPECT_TRUE(until([&] { return this->axis(axis).homed; }, 60s)) << "axis " << axis << " did not home";
        EXPECT_TRUE(until([&] { return this->axis(axis).state == axes::AxisState::Standstill; }, 5s));
    }
    bool has_alarm(AlarmId id) {
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            if (s.alarms[i].fact.id == id) return true;
        return false;
    }
    std::string alarms() {
        std::string out;
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i) {
            const auto words = machine->describe(s.alarms[i].fact);
            out += words.source + ": " + words.english + "; ";
        }
        return out;
    }
    /// No set-point of an enabled drive ever stepped further than full speed allows in a cycle.
    void expect_no_jump() {
        for (std::size_t i = 0; i < watch.size(); ++i) {
            const double most = machine->config().axes[i].axis.limits.velocity * to_seconds(machine->config().cycle) * (1 + 1e-9);
            EXPECT_LE(watch[i].largest_step, most) << "axis " << i << " was given a set-point that jumps";
            if (auto* drive = world.drive(machine->layout().axes[i].name)) {
                const double counts = std::abs(machine->config().axes[i].axis.gearing.counts_per_unit());
                EXPECT_LE(drive->largest_increment(), most * counts + 2) << "the drive of axis " << i << " saw its target jump";
            }
        }
    }

    VirtualClock clock;
    World world;
    ecat::test::TamperedCable cable;
    ReplayCheck replayed;
    std::unique_ptr<Machine> machine;
    std::unique_ptr<VirtualRunner> runner;
    std::vector<AxisWatch> watch;
    std::vector<DriveOracle> oracles;
    std::uint64_t sequence = 0;
    std::function<void()> on_cycle;

private:
    struct Tap {
        DriveTap drive;
        ecat::sim::SimSlave* slave;
    };
    void tap_drives() {
        const auto& config = machine->config();
        auto& bus = machine->bus();
        taps_.resize(config.axes.size());
        for (std::size_t i = 0; i < config.axes.size(); ++i) {
            if (!config.axes[i].profile || world.drive(config.axes[i].axis.name) == nullptr) continue;
            for (std::size_t slave = 0; slave < bus.slave_count(); ++slave)
                if (bus.slave(slave).name == config.axes[i].slave)
                    taps_[i].emplace(Tap{DriveTap(bus, slave, config.axes[i]), simulated(config.axes[i].slave)});
        }
    }
    ecat::sim::SimSlave* simulated(const std::string& slave) {
        for (std::size_t i = 0; i < world.network().size(); ++i)
            if (auto& there = world.network().slave(i); there.options().name == slave) return &there;
        return nullptr;
    }
    void look(std::size_t i, const axes::AxisView& view) {
        auto& oracle = oracles[i];
        if (!taps_[i]) return oracle.observe(view);
        const auto& [tap, slave] = *taps_[i];
        const auto& health = tap.health();
        const auto told = this->told(i);
        oracle.observe(view, told, health.fresh);
        const bool reached = slave != nullptr && health.age == 0 && slave->state() == ecat::sim::EsmState::op;
        if (reached) oracle.arrived(tap.arrived(slave->dictionary()), told, health.due);
        else oracle.out_of_reach();
    }
    void each_cycle() {
        const auto* s = machine->latest();
        if (!s) return;
        if (taps_.empty()) tap_drives();
        for (std::size_t i = 0; i < oracles.size() && i < s->axes.size(); ++i) look(i, s->axes[i]);
        for (std::size_t i = 0; i < watch.size() && i < s->axes.size(); ++i) {
            const auto& view = s->axes[i];
            auto& w = watch[i];
            // While the drive moves itself (homing) the set-point follows it and is not sent.
            // Homing in place gives the same place another name; the drive's own check below sees its counts.
            const bool commanded =
                view.drive_state == axes::PowerState::enabled && view.state != axes::AxisState::Homing && view.homed == w.homed;
            w.homed = view.homed;
            if (commanded && w.was_enabled) w.largest_step = std::max(w.largest_step, std::abs(view.set_position - w.previous));
            w.largest_velocity = std::max(w.largest_velocity, std::abs(view.set_velocity));
            w.previous = view.set_position;
            w.was_enabled = commanded;
        }
        if (on_cycle) on_cycle();
    }

    std::vector<std::optional<Tap>> taps_;
};

}  // namespace taktwerk::runtime::testing