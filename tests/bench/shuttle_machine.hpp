#pragma once
// A machine whose axes shuttle between 100 and 300 mm for ever: each a CSP axis with MC_Power, MC_Home and two MC_MoveAbsolute in one program, on real
// frames. The simulated slaves work between the cycles, as they do on a wire, so that the figures are the controller's alone.

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fb_library/all_blocks.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/tasks/program_library.hpp"
#include "runtime/world/world.hpp"
#include "tests/bench/between_cycles.hpp"
#include "tests/machines/plain_machine.hpp"

namespace taktwerk::bench {

class Shuttle final : public Program {
    struct One {
        AxisRef axis;
        fb::MC_Power power;
        fb::MC_Home home;
        fb::MC_MoveAbsolute there, back;
    };
    std::vector<One> axes_;

public:
    static inline std::vector<std::string> names;
    void declare(Declaration& d) override {
        axes_.resize(names.size());
        for (std::size_t i = 0; i < names.size(); ++i) axes_[i].axis = d.axis(names[i]);
        d.task<&Shuttle::scan>("main");
    }
    void scan(TaskContext& ctx) {
        for (auto& a : axes_) {
            a.power.Axis = a.home.Axis = a.there.Axis = a.back.Axis = a.axis;
            a.power.Enable = true;
            a.power(ctx);
            a.home.Execute = a.power.Status;
            a.home(ctx);
            a.there.Position = 300;
            a.back.Position = 100;
            a.there.Velocity = a.back.Velocity = 400;
            a.there.Execute = a.home.Done && !a.there.Done && !a.back.Busy;
            a.there(ctx);
            a.back.Execute = a.there.Done || a.back.Busy;
            a.back(ctx);
        }
    }
};

/// One at a time. Ends the program with its words where the machine does not come up.
class ShuttleMachine {
public:
    explicit ShuttleMachine(std::size_t axes) : config_(configured(axes)), world_(config_, now_), wire_(world_.network()) {}

    /// The controller, beside the slaves that are there already.
    void build() {
        auto built = runtime::Machine::build(config_, wire_);
        if (auto* errors = std::get_if<1>(&built)) die(errors->front());
        machine_ = std::move(std::get<0>(built));
    }

    void cycle() {
        now_ += period;
        machine_->cycle({now_, now_, 0});
        wire_.deliver(now_ + period / 2);
        machine_->service(now_);
        if (between) between();
    }
    /// Until every slave is in OP: the time of the machine that it took.
    Duration bring_up() {
        const Instant begun = now_;
        machine_->start_bus();
        for (int i = 0; i < 60000 && !machine_->bus_operational(); ++i) {
            cycle();
            if (auto failure = machine_->bus_failure()) die(*failure);
        }
        return now_ - begun;
    }
    /// Powered, homed, moving.
    void start() {
        if (auto armed = machine_->arm(); !armed) die(armed.error());
        for (int i = 0; i < 500; ++i) cycle();
        machine_->reset_step_statistics();
    }
    /// Cycles, and which part of the axes was in motion meanwhile.
    double run(int cycles) {
        std::size_t moving = 0, asked = 0;
        for (int i = 0; i < cycles; ++i) {
            cycle();
            if (i % 100 != 0) continue;
            for (const auto& view : machine_->latest()->axes) ++asked, moving += view.set_velocity != 0;
        }
        return static_cast<double>(moving) / static_cast<double>(asked);
    }
    /// After each cycle, beside it.
    std::function<void()> between;
    [[nodiscard]] runtime::Machine& machine() noexcept { return *machine_; }
    [[nodiscard]] const BetweenCycles& wire() const noexcept { return wire_; }

    /// Of that many axes, with their program.
    static runtime::MachineConfig configured(std::size_t axes) {
        auto config = runtime::testing::machine_config(axes);
        config.bus.sync0_shift = std::chrono::microseconds{950};  // the frames of 200 axes are through after 840 us
        Shuttle::names.clear();
        for (auto& binding : config.axes) {
            binding.axis.homing.kind = axes::HomingKind::set_here;
            binding.axis.limits.position_max = 400;
            binding.axis.limits.position_min = -10;
            Shuttle::names.push_back(binding.axis.name);
        }
        static const ProgramEntry entry{program_magic,
                                        sizeof(ProgramEntry),
                                        runtime::ProgramLibrary::expected_abi(),
                                        "0.1.0",
                                        "shuttle",
                                        []() -> Program* { return new Shuttle; },
                                        [](Program* p) { delete p; }};
        runtime::ProgramConfig program;
        program.name = "bench";
        program.entry = [] { return &entry; };
        program.autostart = true;
        config.programs = {program};
        config.start_mode = runtime::Mode::automatic;
        return config;
    }

private:
    static constexpr Duration period = std::chrono::milliseconds{1};

    [[noreturn]] static void die(const Error& error) {
        fmt::print(stderr, "{}\n", error.text());
        std::exit(1);
    }
    runtime::MachineConfig config_;
    Instant now_{std::chrono::seconds{1}};
    runtime::World world_;
    BetweenCycles wire_;
    std::unique_ptr<runtime::Machine> machine_;
};

}  // namespace taktwerk::bench
