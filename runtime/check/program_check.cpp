#include "runtime/check/program_check.hpp"

#include "runtime/tasks/program_host.hpp"

namespace taktwerk::runtime {

std::vector<Error> check_programs(const MachineConfig& config) {
    std::vector<Error> errors;
    axes::MotionTables tables;
    const ProgramHost host{config, IoImage{config.io, config.cycle}, tables, errors};
    return errors;
}

}  // namespace taktwerk::runtime
