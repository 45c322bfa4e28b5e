#pragma once
// From a machine file to the plain structs of the floors below. Nothing is returned unless everything is right:
//
//   auto loaded = config::load_machine("config/machines/demo.yaml", {.simulate = true});
//   if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) ...     // all of them, each with file:line:col
//   auto& [machine, hmi, warnings, files] = std::get<config::LoadedMachine>(loaded);
//
// Not real-time. Reads the machine file, its drive files and their alarm files; reads no environment.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/hmi_config.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

struct LoadOptions {
    bool simulate = false;                  ///< the bus is simulated whatever the file says
    std::vector<std::string> drive_dirs;    ///< looked up before the folder `drives` beside the machine's folder and the installed one
    std::vector<std::string> device_dirs;   ///< the same for `devices`
    std::vector<std::string> program_path;  ///< looked up after the machine file's folder
    std::vector<std::string>
        data_dirs;          ///< installed data, with `drives` and `devices` inside; looked up last but for the configured install prefix
    std::string state_dir;  ///< relative directories of what a machine keeps are in here; empty: beside the machine file
    bool resolve_programs = true;  ///< false: leave `library` as written (a file is checked where no program is built)
};

/// A file that a machine is made of, besides its own.
struct UsedFile {
    enum class Kind : std::uint8_t { drive, device, program, cam, path, image };
    Kind kind;
    std::string written;  ///< as the machine file names it; drive, device: the file's name, with its ending
    std::string path;     ///< where it was found
};

struct LoadedMachine {
    runtime::MachineConfig machine;
    hmi::HmiConfig hmi;
    std::vector<Error> warnings;  ///< legal, but perhaps not meant
    std::vector<UsedFile> files;  ///< each once; programs only where they were resolved
};

using LoadResult = std::variant<LoadedMachine, std::vector<Error>>;

[[nodiscard]] LoadResult load_machine(const std::string& path, const LoadOptions& options = {});
/// Where the drive files of a machine are looked up, in this order.
[[nodiscard]] std::vector<std::string> drive_folders(const std::string& machine_file, const LoadOptions& options);
/// Where its device files are looked up.
[[nodiscard]] std::vector<std::string> device_folders(const std::string& machine_file, const LoadOptions& options);
/// The same for a text that stands, or could stand, at `path`.
[[nodiscard]] LoadResult load_machine_text(const std::string& path, std::string_view text, const LoadOptions& options = {});

}  // namespace taktwerk::config
