#include "apps/machine/recordings_folder.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "hmi_bridge/socket/socket_path.hpp"

namespace taktwerk::apps {

std::string usual_recordings(const runtime::MachineConfig& machine) {
    std::vector<std::string> parents;
    if (!machine.bus.interface.empty()) {
        // systemd gives a list with colons between, where a unit has several.
        if (const char* state = std::getenv("STATE_DIRECTORY"); state != nullptr && *state == '/')
            parents.emplace_back(std::string_view{state}.substr(0, std::string_view{state}.find(':')));
        parents.emplace_back("/var/lib/taktwerk");
    }
    if (const auto socket = hmi::make_socket_path(machine.name)) parents.push_back(std::filesystem::path(*socket).parent_path().string());
    for (const auto& parent : parents) {
        const auto folder = parent + "/recordings";
        std::error_code failed;
        std::filesystem::create_directories(folder, failed);
        if (std::filesystem::is_directory(folder, failed) && ::access(folder.c_str(), W_OK) == 0) return folder;
    }
    return {};
}

}  // namespace taktwerk::apps
