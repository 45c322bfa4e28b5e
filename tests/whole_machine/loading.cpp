#include "tests/whole_machine/loading.hpp"

#include <stdexcept>

#include "config/machine_file/machine_loader.hpp"
#include "tests/whole_machine/rogue.hpp"

namespace taktwerk::whole {

runtime::MachineConfig load(std::string_view name, const std::string& folder) {
    config::LoadOptions options;
    options.simulate = true;
    options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
    options.device_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/devices");
    options.program_path.emplace_back(TAKTWERK_BINARY_DIR "/programs");
    auto loaded = config::load_machine(std::string(TAKTWERK_SOURCE_DIR "/config/machines/") + std::string(name) + ".yaml", options);
    if (const auto* errors = std::get_if<1>(&loaded)) {
        std::string all;
        for (const auto& error : *errors) all += error.text() + "\n";
        throw std::runtime_error(all);
    }
    auto machine = std::move(std::get<0>(loaded).machine);
    machine.simulation.events.clear();
    machine.simulation.supervision = runtime::Supervision::strict;
    machine.start_mode = runtime::Mode::automatic;
    machine.retain.directory = folder + "/kept";
    machine.recording.directory = folder + "/recordings";
    machine.recording.depth = std::chrono::seconds{4};
    machine.recording.before = std::chrono::seconds{1};
    machine.recording.after = std::chrono::milliseconds{200};
    machine.recording.files = 3;
    add_rogue(machine);
    return machine;
}

}  // namespace taktwerk::whole
