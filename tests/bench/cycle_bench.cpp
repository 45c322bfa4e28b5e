// What one cycle of a whole machine costs the cycle thread, step by step: 1, 8 and 64 CSP axes, each with MC_Power and
// MC_MoveAbsolute in one program. Real frames; the simulated slaves work between the cycles (as they do on a wire), so that the
// figures are the controller's alone.

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <vector>

#include <fmt/format.h>

#include "core/math.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/tasks/program_library.hpp"
#include "runtime/world/world.hpp"
#include "tests/bench/between_cycles.hpp"
#include "tests/machines/plain_machine.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;
using namespace taktwerk::runtime;
using namespace std::chrono_literals;

/// Every axis shuttles between 100 and 300 mm for ever.
class Shuttle final : public Program {
    struct One {
        AxisRef axis;
        MC_Power power;
        MC_Home home;
        MC_MoveAbsolute there, back;
    };
    std::vector<One> axes_;

public:
    static std::size_t count;
    static std::vector<std::string> names;
    void declare(Declaration& d) override {
        axes_.resize(count);
        for (std::size_t i = 0; i < count; ++i) axes_[i].axis = d.axis(names[i]);
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
std::size_t Shuttle::count = 0;
std::vector<std::string> Shuttle::names;

double us(Duration d) { return static_cast<double>(d.count()) / 1000.0; }

void run(std::size_t axes, int cycles) {
    auto config = testing::machine_config(axes);
    Shuttle::count = axes;
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
    ProgramConfig program;
    program.name = "bench";
    program.entry = [] { return &entry; };
    program.autostart = true;
    config.programs = {program};
    config.start_mode = Mode::automatic;

    Instant now{1s};
    World world{config, now};
    bench::BetweenCycles wire{world.network()};
    auto built = Machine::build(config, wire);
    if (auto* errors = std::get_if<1>(&built)) {
        for (const auto& error : *errors) fmt::print(stderr, "{}\n", error.text());
        std::exit(1);
    }
    auto& machine = *std::get<0>(built);
    machine.start_bus();
    const auto cycle = [&] {
        now += 1ms;
        machine.cycle({now, now, 0});
        wire.deliver(now + 500us);
        machine.service(now);
    };
    for (int i = 0; i < 60000 && !machine.bus_operational(); ++i) {
        cycle();
        if (auto failure = machine.bus_failure()) {
            fmt::print(stderr, "{}\n", failure->text());
            std::exit(1);
        }
    }
    if (auto armed = machine.arm(); !armed) {
        fmt::print(stderr, "{}\n", armed.error().text());
        std::exit(1);
    }
    for (int i = 0; i < 500; ++i) cycle();  // powered, homed, moving
    machine.reset_step_statistics();
    std::size_t moving = 0;
    for (int i = 0; i < cycles; ++i) {
        cycle();
        if (i % 100 == 0)
            for (const auto& view : machine.latest()->axes) moving += view.set_velocity != 0;
    }
    const auto& steps = machine.step_statistics();
    fmt::print("\n{} axes, {} cycles, {:.0f} % of them in motion\n", axes, cycles,
               100.0 * static_cast<double>(moving) / (static_cast<double>(axes) * cycles / 100));
    fmt::print("{:<10} {:>36}   {:>32}\n", "", "ns per axis and cycle", "us per cycle");
    fmt::print("{:<10} {:>11} {:>11} {:>12}   {:>10} {:>10} {:>10}\n", "step", "p50", "p99", "max", "p50", "p99", "max");
    const auto row = [&](std::string_view step, const Histogram& h) {
        const double n = static_cast<double>(axes) / 1000.0;
        fmt::print("{:<10} {:>11.1f} {:>11.1f} {:>12.1f}   {:>10.2f} {:>10.2f} {:>10.2f}\n", step, us(h.percentile(50)) / n,
                   us(h.percentile(99)) / n, us(h.max()) / n, us(h.percentile(50)), us(h.percentile(99)), us(h.max()));
    };
    for (std::size_t i = 0; i < steps.size(); ++i) row(steps.name(i), steps.times(i));
    row("total", steps.total());
}

}  // namespace

int main() {
    math::set_stepping_thread_float_environment();
    fmt::print("One cycle of a machine on the cycle thread; simulated slaves answer between the cycles.\n");
    for (const std::size_t axes : {1, 8, 64}) run(axes, 20000);
    return 0;
}
