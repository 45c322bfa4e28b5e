#include "tests/whole_machine/rogue.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "runtime/tasks/program_library.hpp"
#include "tests/machines/add_program.hpp"

namespace taktwerk::whole {

void Rogue::declare(Declaration& d) {
    has_axis_ = !axis.empty();
    has_output_ = !output.empty();
    if (has_axis_) axis_ = d.axis(axis);
    if (has_output_) output_ = d.output_real(output);
    d.retain("scans", scans_);
    d.monitor("scans", scans_);
    d.monitor("refused", refused_);
    d.task<&Rogue::scan>("main");
}

void Rogue::stop() {
    if (mischief == Mischief::throws_in_stop) throw std::runtime_error("stop() of this program always fails");
}

void Rogue::scan(TaskContext& ctx) {
    ++scans_;
    switch (mischief) {
        case Mischief::none:
        case Mischief::throws_in_stop: return;
        case Mischief::throws_in_scan: throw std::runtime_error("this scan always fails");
        case Mischief::no_numbers:
            if (has_output_) ctx.set(output_, std::numeric_limits<double>::quiet_NaN());
            [[fallthrough]];
        case Mischief::wrong_commands: return command_nonsense(ctx);
        case Mischief::takes_others_axis:
            // To and fro, whoever moves it.
            move_.Axis = axis_;
            move_.Execute = scans_ % 64 != 0;
            move_.Position = has_axis_ ? ctx.view(axis_)->set_position + (scans_ % 128 < 64 ? 0.5 : -0.5) : 0;
            move_.Velocity = 1;
            move_(ctx);
            return;
    }
}

/// Blocks of nobody's axis, with values that no axis takes: each says what is wrong with it, and no axis hears of it.
void Rogue::command_nonsense(const TaskContext& ctx) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const bool numbers = mischief == Mischief::wrong_commands;
    const AxisRef nobodys{static_cast<std::uint16_t>(1000 + scans_ % 100)};
    move_.Axis = numbers ? nobodys : axis_;
    move_.Position = numbers ? 1e300 : nan;
    move_.Velocity = numbers ? -1 : infinite;
    move_.Execute = !move_.Execute;
    move_(ctx);
    run_.Axis = numbers ? nobodys : axis_;
    run_.Velocity = numbers ? 1e300 : nan;
    run_.Acceleration = numbers ? -5 : infinite;
    run_.Execute = !run_.Execute;
    run_(ctx);
    halt_.Axis = nobodys;
    halt_.Deceleration = numbers ? -1 : nan;
    halt_.Execute = !halt_.Execute;
    halt_(ctx);
    refused_ += move_.Error + run_.Error + halt_.Error;
}

void add_rogue(runtime::MachineConfig& config) {
    static const ProgramEntry entry{program_magic,
                                    sizeof(ProgramEntry),
                                    runtime::ProgramLibrary::expected_abi(),
                                    "0.1.0",
                                    "rogue",
                                    []() -> Program* { return new Rogue; },
                                    [](Program* program) { delete program; }};
    Rogue::mischief = Mischief::none;
    Rogue::axis = Rogue::output = "";
    for (const auto& binding : config.axes)
        if (Rogue::axis.empty() && !binding.encoder) Rogue::axis = binding.axis.name;
    for (const auto& point : config.io)
        if (point.direction == runtime::IoDirection::output && Rogue::output.empty()) Rogue::output = point.name;
    runtime::testing::add_program(config, "rogue", [] { return &entry; });
}

}  // namespace taktwerk::whole
