#pragma once
// A program of the test's own in a machine.

#include <cstdint>
#include <string>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime::testing {

/// Program `name`, which starts by itself, with its task "main".
inline void add_program(MachineConfig& config, const std::string& name, const ProgramEntry* (*entry)(), std::uint16_t divisor = 1) {
    ProgramConfig program;
    program.name = name;
    program.entry = entry;
    program.autostart = true;
    config.programs.push_back(program);
    TaskConfig task;
    task.name = "main";
    task.program = name;
    task.divisor = divisor;
    config.tasks.push_back(task);
}

}  // namespace taktwerk::runtime::testing
