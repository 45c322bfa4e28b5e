#pragma once
// Everything that can be known of a machine without starting it: what `taktwerk check` says, and what a bundle is made of only when it is well.

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "config/machine_file/machine_loader.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

struct CheckedMachine {
    runtime::MachineConfig config;
    hmi::HmiConfig hmi;
    std::vector<Error> warnings, remarks;  ///< legal, but perhaps not meant: by the file; by what it means
    std::vector<config::UsedFile> files;
    std::unique_ptr<runtime::World> world;      ///< the machine stands in it
    std::unique_ptr<runtime::Machine> machine;  ///< built, never started
};

/// Loads the file, its drives and its programs, whose code runs here with the rights of whoever asked. Every problem at once, or the machine.
[[nodiscard]] std::variant<CheckedMachine, std::vector<Error>> check_machine(const std::string& file);

}  // namespace taktwerk::apps
