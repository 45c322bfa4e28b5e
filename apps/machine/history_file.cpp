#include "apps/machine/history_file.hpp"

#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* ending = ".alarms.sqlite";
constexpr const char* state_folder = "/var/lib/taktwerk";

}  // namespace

std::string history_path(const std::string& folder, std::string_view machine) {
    std::string name;
    for (const char c : machine.substr(0, 60)) name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
    return (fs::path(folder) / (name + ending)).string();
}

HistoryPlace history_place(const hmi::HistoryConfig& config, const runtime::MachineLayout& layout, const std::string& socket) {
    if (!config.directory.empty()) return {history_path(config.directory, layout.machine), {}};
    const auto beside = fs::path(socket).replace_extension().string() + ending;
    if (layout.interface.empty()) return {beside, {}};
    if (const char* given = std::getenv("STATE_DIRECTORY"); given != nullptr && *given == '/') {
        const std::string folders = given;  // several, with colons between
        return {history_path(folders.substr(0, folders.find(':')), layout.machine), {}};
    }
    std::error_code unknown;
    if (fs::is_directory(state_folder, unknown) && ::access(state_folder, W_OK) == 0)
        return {history_path(state_folder, layout.machine), {}};
    return {beside, fmt::format("alarms are kept in {}, which a restart of this computer empties: `history: {{directory: ...}}` keeps them",
                                beside)};
}

}  // namespace taktwerk::apps
