#pragma once
// A machine of one simulated drive and one axis "x" in mm, from the text of a machine file, with a program of the test's own.

#include <string>
#include <variant>
#include <vector>

#include "config/machine_file/machine_loader.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {

/// `slave`: lines of the slave "drive" behind its name; `axis`: further lines of the axis, its gearing and limits among them.
template <class Desk>
MachineConfig one_drive_machine(const std::string& slave, const std::string& axis) {
    const std::string text =
        "version: 1\nname: one-drive\ncycle: 1 ms\nstart_mode: automatic\nbus:\n  interface: simulated\n  slaves:\n    - name: drive\n" +
        slave + "axes:\n  x:\n    slave: drive\n    unit: mm\n    homing: { kind: set_here }\n" + axis;
    config::LoadOptions options;
    options.simulate = true;
    auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/one-drive.yaml", text, options);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return machine_config(1);
    }
    auto config = std::get<config::LoadedMachine>(std::move(loaded)).machine;
    add_program(config, "p", &entry_of<Desk>);
    return config;
}

}  // namespace taktwerk::runtime::testing
