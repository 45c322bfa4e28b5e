#include "apps/machine/load.hpp"

#include <cstdlib>
#include <filesystem>

#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {

std::vector<std::string> program_path() {
    std::vector<std::string> folders;
    std::error_code unknown;
    const auto executable = std::filesystem::read_symlink("/proc/self/exe", unknown);
    if (!unknown) {
        folders.push_back((executable.parent_path() / "programs").string());                                     // in the build folder
        folders.push_back((executable.parent_path().parent_path() / "lib" / "taktwerk" / "programs").string());  // installed
    }
    if (const char* more = std::getenv("TAKTWERK_PROGRAM_PATH")) {
        const std::string text = more;
        for (std::size_t at = 0; at < text.size();) {
            const auto end = std::min(text.find(':', at), text.size());
            if (end > at) folders.push_back(text.substr(at, end - at));
            at = end + 1;
        }
    }
    return folders;
}

config::LoadOptions load_options(bool simulate) {
    config::LoadOptions options;
    options.simulate = simulate;
    options.program_path = program_path();
    std::error_code unknown;  // installed below any prefix, the data is found from the executable
    const auto executable = std::filesystem::read_symlink("/proc/self/exe", unknown);
    if (!unknown) {
        const auto above = executable.parent_path().parent_path();
        options.data_dirs.push_back((above / "share" / "taktwerk").string());
        options.data_dirs.push_back((above.parent_path() / "config").string());  // in a build folder of the source tree: build/dev/taktwerk
    }
    return options;
}

config::LoadResult read_machine(const std::string& file, bool simulate) { return config::load_machine(file, load_options(simulate)); }

std::vector<std::string> drive_folders(const std::string& machine_file) { return config::drive_folders(machine_file, load_options(false)); }
std::vector<std::string> device_folders(const std::string& machine_file) {
    return config::device_folders(machine_file, load_options(false));
}

config::LoadResult read_machine_without_programs(const std::string& file, bool simulate) {
    auto options = load_options(simulate);
    options.resolve_programs = false;
    return config::load_machine(file, options);
}

namespace {

std::optional<LoadedFile> printed(config::LoadResult result) {
    if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
        print_errors(*errors);
        return std::nullopt;
    }
    auto& loaded = std::get<LoadedFile>(result);
    for (const auto& warning : loaded.warnings) print_warning(warning);
    return std::move(loaded);
}

}  // namespace

std::optional<LoadedFile> load(const std::string& file, bool simulate) { return printed(read_machine(file, simulate)); }
std::optional<LoadedFile> load(const std::string& file, const config::LoadOptions& options) {
    return printed(config::load_machine(file, options));
}
std::optional<LoadedFile> load_without_programs(const std::string& file, bool simulate) {
    return printed(read_machine_without_programs(file, simulate));
}

}  // namespace taktwerk::apps
