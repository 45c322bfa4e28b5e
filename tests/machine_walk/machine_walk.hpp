#pragma once
// A random walk through a whole machine: programs or people ask, faults of drives, cables, supplies and switches come and go, and through real
// frames three simulated drives are told what to do. The oracles of TestMachine look at every cycle; what ends a walk is that all comes back.

#include <map>
#include <string>

#include "tests/axes/axis/walk_commands.hpp"
#include "tests/machine_walk/walk_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {

using WalkCounts = std::map<std::string, long, std::less<>>;

class MachineWalk {
public:
    MachineWalk(unsigned seed, WalkCounts& counts)
        : counts_(counts),
          dice_(seed),
          by_program_(seed % 3 != 0),
          ring_(seed % 4 == 1),
          m_(machine()),
          any_(dice_, axis_count, views(), tables_) {}
    MachineWalk(const MachineWalk&) = delete;
    MachineWalk& operator=(const MachineWalk&) = delete;

    /// What went wrong; "" for nothing.
    std::string run(int length) {
        m_.on_cycle = [this] { note(); };
        if (!m_.up()) return "the bus does not come up\n";
        if (!by_program_) (void)m_.command(OperatorAction::power, 0xFFFF, true);
        for (int i = 0; i < length && clean(); ++i) {
            if (!by_program_ && dice_.once_in(15)) ask_by_hand();
            disturb();
            m_.run(m_.machine->config().cycle);
            while (m_.machine->next_answer()) {}
        }
        if (clean()) come_back();
        m_.on_cycle = {};
        std::string out = wrong_;
        for (auto& oracle : m_.oracles) {
            out += oracle.report();
            compared += oracle.motion().compared();
            arrived += oracle.compared();
            oracle.look_away("told by the walk, with its seed");
        }
        return out;
    }
    [[nodiscard]] long cycles() const { return cycles_; }
    [[nodiscard]] const std::string& log() const { return log_; }
    long compared = 0, arrived = 0;
    bool logs = false;

private:
    static constexpr std::size_t axis_count = 3;

    class Walker final : public Program {
    public:
        void declare(Declaration& d) override {
            for (const auto* name : {"x", "y", "z"}) (void)d.axis(name);
            d.task<&Walker::scan>("main");
        }
        void scan(TaskContext& ctx) { here->scan(ctx); }
    };
    static inline MachineWalk* here = nullptr;

    [[nodiscard]] MachineConfig machine() {
        here = this;
        // Tables are no matter of the way to the drive; commands that name one are refused.
        tables_.cams.resize(3);
        tables_.positions.resize(2);
        tables_.velocities.resize(2);
        tables_.accelerations.resize(2);
        auto config = walk_machine(dice_, by_program_ ? &entry_of<Walker> : nullptr);
        if (ring_) config.bus.ring = ecat::RingConfig{"", ecat::BehindBreak::hand_time_on};
        return config;
    }
    [[nodiscard]] axes::test::AnyCommand::Views views() {
        return [this](std::size_t i) -> const axes::AxisView& { return seen_.empty() ? nobody_ : seen_[i]; };
    }
    [[nodiscard]] bool clean() const {
        return wrong_.empty() && std::all_of(m_.oracles.begin(), m_.oracles.end(), [](const auto& oracle) { return oracle.clean(); });
    }
    void count(const std::string& what) { ++counts_[what]; }
    void tell(std::string text) {
        if (logs) log_ += fmt::format("{}: {}\n", cycles_ / static_cast<long>(axis_count), text);
    }

    // --- a program ------------------------------------------------------------------------------------------------------------------

    void scan(const TaskContext& ctx) {
        seen_ = ctx.axes;
        for (std::uint16_t i = 0; i < axis_count; ++i) {
            const auto& view = ctx.axes[i];
            auto& mine = mine_[i];
            if (!lively_) mine.unpowered = 0;
            (void)ctx.requests->power({i}, mine.unpowered == 0, true, true, ctx.owner);
            if (mine.unpowered > 0) --mine.unpowered;
            if (view.state == axes::AxisState::ErrorStop && dice_.once_in(50)) (void)ctx.requests->reset({i}, ctx.owner);
            if (mine.lock != 0 && (dice_.once_in(40) || !lively_)) ctx.requests->release_stop({i}, std::exchange(mine.lock, 0), ctx.owner);
            if (mine.jog != 0 && ctx.requests->renew_jog({i}, mine.jog, dice_.between(-60, 60), ctx.owner) != axes::ErrorId::none)
                mine.jog = 0;
            if (!lively_) continue;
            if (dice_.once_in(1500)) {
                mine.unpowered = 50 + static_cast<int>(dice_.below(400));
                tell(fmt::format("axis {} without MC_Power", i));
                count("MC_Power off");
            }
            if (dice_.once_in(60)) ask(ctx, i);
            if (dice_.once_in(300)) (void)ctx.requests->set({i}, any_.any_setting(i), ctx.owner);
        }
        seen_ = {};
    }
    void ask(const TaskContext& ctx, std::uint16_t i) {
        const auto command = any_(i);
        const auto answer = ctx.requests->submit({i}, command, ctx.owner);
        tell(fmt::format("axis {} {} mode {} p {} v {} -> {}", i, axes::test::walk_name(command.kind),
                         static_cast<int>(command.buffer_mode), command.position, command.velocity, static_cast<int>(answer.error)));
        if (answer.id == 0) return;
        count(std::string(axes::test::walk_name(command.kind)));
        if (command.kind == axes::CommandKind::stop) mine_[i].lock = answer.id;
        if (command.kind == axes::CommandKind::jog) mine_[i].jog = answer.id;
    }

    // --- people ---------------------------------------------------------------------------------------------------------------------

    void ask_by_hand() {
        OperatorCommand command;
        command.client = 7;
        command.sequence = ++sequence_;
        command.axis = static_cast<std::uint16_t>(dice_.below(axis_count));
        command.flag = true;
        using enum OperatorAction;
        command.action = dice_.one_of({power, power, power, home, jog, jog, jog, move_absolute, move_absolute, move_absolute, stop, reset});
        if (command.action == power) command.flag = !dice_.once_in(4);
        if (command.action == jog) {
            command.value = dice_.between(-60, 60);
            command.flag = dice_.once_in(2);
        }
        if (command.action == move_absolute) {
            command.value = dice_.between(0, 200);
            command.value2 = dice_.between(5, 100);
        }
        tell(fmt::format("by hand {} axis {} {} {} {}", static_cast<int>(command.action), command.axis, command.flag, command.value,
                         command.value2));
        if (m_.machine->submit(command)) count("by hand");
    }

    // --- the world ------------------------------------------------------------------------------------------------------------------

    void disturb() {
        if (healed_in_ > 0 && --healed_in_ == 0) heal();
        if (healed_in_ > 0 || !dice_.once_in(700)) return;
        hurt_ = static_cast<std::uint16_t>(dice_.below(axis_count));
        const auto& name = m_.machine->config().axes[hurt_].axis.name;
        auto& drive = *m_.world.drive(name);
        healed_in_ = 20 + static_cast<int>(dice_.below(600));
        static constexpr std::array events{"drive fault",     "mains lost",     "slave restarts", "cable pulled",   "frames lost",
                                           "few frames lost", "emergency stop", "jammed",         "all powered off"};
        const auto event = dice_.below(events.size());
        tell(fmt::format("{} at {} for {} cycles", events[event], name, healed_in_));
        count(events[event]);
        switch (event) {
            case 0: drive.raise(0x3130); break;
            case 1: drive.main_power(false); break;
            case 2: m_.world.set_slave_power(name + "_drive", false); break;
            case 3: m_.world.set_cable(name + "_drive", false); break;
            case 4: m_.world.network().lose_frames(5 + dice_.below(40)); break;
            case 5: m_.world.network().lose_frames(1 + dice_.below(2)); break;
            case 6: m_.world.set_input("estop_ok", false); break;
            case 7: drive.jam(true); break;
            default:
                for (const auto& binding : m_.machine->config().axes) m_.world.drive(binding.axis.name)->main_power(false);
        }
    }
    void heal() {
        for (const auto& binding : m_.machine->config().axes) {
            m_.world.drive(binding.axis.name)->main_power(true);
            m_.world.drive(binding.axis.name)->jam(false);
            m_.world.set_slave_power(binding.slave, true);
            m_.world.set_cable(binding.slave, true);
        }
        m_.world.set_input("estop_ok", true);
        healed_in_ = 0;
        tell("healed");
        submit(OperatorAction::reset);
        submit(OperatorAction::acknowledge_alarms);
        if (by_program_) submit(OperatorAction::program_start, 0);
        else submit(OperatorAction::power);
    }
    void submit(OperatorAction action, std::uint16_t index = 0xFFFF) {
        OperatorCommand command;
        command.client = 7;
        command.sequence = ++sequence_;
        command.action = action;
        command.index = index;
        command.flag = true;
        (void)m_.machine->submit(command);
    }

    /// Nothing is broken any more and nobody asks for anything: within half a minute the bus is up and each axis stands with power.
    void come_back() {
        lively_ = false;
        const auto all_well = [&] {
            if (!m_.machine->bus_operational()) return false;
            for (std::size_t i = 0; i < axis_count; ++i)
                if (m_.axis(i).state != axes::AxisState::Standstill) return false;
            return true;
        };
        for (int i = 0; i < 60 && clean(); ++i) {
            if (all_well()) {
                count("came back");
                return;
            }
            heal();
            if (i % 4 == 3) submit(OperatorAction::stop);
            m_.run(500ms);
            while (m_.machine->next_answer()) {}
        }
        if (!clean()) return;
        for (std::size_t i = 0; i < axis_count; ++i)
            wrong_ += fmt::format("axis {} is in {} (error {}, drive {}) although nothing is broken any more; {}\n", i,
                                  axes::name(m_.axis(i).state), m_.axis(i).error, axes::name(m_.axis(i).drive_state), m_.alarms());
    }

    void note() {
        for (std::size_t i = 0; i < axis_count; ++i) {
            ++cycles_;
            const auto& view = m_.axis(i);
            count(fmt::format("in {}", axes::name(view.state)));
            if (view.drive_state == axes::PowerState::enabled) count(fmt::format("runs in mode {}", m_.told(i).mode));
            if (view.drive_state == axes::PowerState::enabled && view.set_velocity != 0) count("moves");
        }
    }

    WalkCounts& counts_;
    axes::test::Dice dice_;
    bool by_program_, ring_;  // of a ring a pulled cable costs nobody anything
    axes::test::WalkTables tables_;
    TestMachine m_;
    std::span<const axes::AxisView> seen_;
    axes::AxisView nobody_;
    axes::test::AnyCommand any_;
    struct Mine {
        axes::CommandId lock = 0, jog = 0;
        int unpowered = 0;  // cycles without MC_Power.Enable
    };
    std::array<Mine, axis_count> mine_;
    std::uint64_t sequence_ = 1'000'000;
    std::uint16_t hurt_ = 0;
    int healed_in_ = 0;
    bool lively_ = true;
    long cycles_ = 0;
    std::string wrong_, log_;
};

}  // namespace taktwerk::runtime::testing
