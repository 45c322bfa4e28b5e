#pragma once
// Small programs linked into the tests.

#include <stdexcept>

#include "fb_library/all_blocks.hpp"
#include "runtime/tasks/program_library.hpp"
#include "tests/machines/add_program.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {

/// A program made of one class, for tests.
template <class Body>
const ProgramEntry* entry_of() {
    static const ProgramEntry entry{program_magic,
                                    sizeof(ProgramEntry),
                                    ProgramLibrary::expected_abi(),
                                    "0.1.0",
                                    "test",
                                    []() -> Program* { return new Body; },
                                    [](Program* p) { delete p; }};
    return &entry;
}

/// Program "p" with task "main", started by itself.
inline MachineConfig with_program(std::size_t axes, const ProgramEntry* (*entry)(), std::uint16_t divisor = 1) {
    auto config = machine_config(axes);
    add_program(config, "p", entry, divisor);
    config.start_mode = Mode::automatic;
    return config;
}

inline double variable(TestMachine& m, std::string_view name) {
    const auto& variables = m.machine->layout().variables;
    for (std::size_t i = 0; i < variables.size(); ++i)
        if (variables[i].name == name) return m.state().variables[i];
    ADD_FAILURE() << "no variable " << name;
    return 0;
}

/// Counts its scans.
class Idle : public Program {
public:
    std::int64_t scans = 0, first_scans = 0;
    Parameter parameter;
    void declare(Declaration& d) override {
        parameter = d.parameter("p", {.value = 5, .minimum = 0, .maximum = 10, .unit = "", .doc = ""});
        d.monitor("scans", scans);
        d.monitor("first_scans", first_scans);
        d.task<&Idle::scan>("main");
    }
    void scan(TaskContext& ctx) {
        ++scans;
        if (ctx.first_scan) ++first_scans;
    }
};

/// Powers x and runs it.
class RunsX : public Program {
public:
    AxisRef x;
    fb::MC_Power power;
    fb::MC_MoveVelocity move;
    double velocity = 50;  ///< u/s
    void declare(Declaration& d) override {
        x = d.axis("x");
        d.task<&RunsX::scan>("main");
    }
    void start() override {
        power = {};
        move = {};
    }
    void scan(TaskContext& ctx) {
        power.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        move.Velocity = velocity;
        move.Execute = power.Status;
        move(ctx);
    }
};

class ThrowsInStart final : public Idle {
    void start() override { throw std::runtime_error("no recipe"); }
};

}  // namespace taktwerk::runtime::testing
