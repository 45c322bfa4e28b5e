#pragma once
// Loading a machine file for a sub-command: where programs are looked for, and what is said about problems.

#include <optional>
#include <string>
#include <vector>

#include "config/machine_file/machine_loader.hpp"

namespace taktwerk::apps {

using LoadedFile = config::LoadedMachine;

/// Where a program library is looked for after the folder of the machine file: `programs` beside this executable, then the folders
/// of $TAKTWERK_PROGRAM_PATH (with colons between).
[[nodiscard]] std::vector<std::string> program_path();

/// How a file is loaded here. `simulate`: the bus and the drives are simulated whatever the file says.
[[nodiscard]] config::LoadOptions load_options(bool simulate);
/// Silent.
[[nodiscard]] config::LoadResult read_machine(const std::string& file, bool simulate);
/// The same for whoever looks at the bus alone: programs need not be built.
[[nodiscard]] config::LoadResult read_machine_without_programs(const std::string& file, bool simulate);

/// Where drive files are looked up for this machine file, or without one (empty).
[[nodiscard]] std::vector<std::string> drive_folders(const std::string& machine_file);
/// The same for device files.
[[nodiscard]] std::vector<std::string> device_folders(const std::string& machine_file);

/// Prints warnings, or every problem (then nothing is returned).
[[nodiscard]] std::optional<LoadedFile> load(const std::string& file, bool simulate);
[[nodiscard]] std::optional<LoadedFile> load(const std::string& file, const config::LoadOptions& options);
[[nodiscard]] std::optional<LoadedFile> load_without_programs(const std::string& file, bool simulate);

}  // namespace taktwerk::apps
