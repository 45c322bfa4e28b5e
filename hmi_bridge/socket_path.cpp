#include "hmi_bridge/socket_path.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::hmi {
namespace {

constexpr std::string_view suffix = ".sock";
constexpr std::string_view start_hint = "Is the runtime running? Start it with `taktwerk run FILE`.";

/// A machine's name as a file name.
std::string file_name(std::string_view machine) {
    std::string out;
    for (const char c : machine.substr(0, 60))
        out += (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' ? c : '_';
    return (out.empty() ? "machine" : out) + std::string(suffix);
}

/// Ours and a real folder: in /tmp somebody else could have put a link there.
bool usable(const std::string& folder) {
    if (::mkdir(folder.c_str(), 0755) != 0 && errno != EEXIST) return false;
    struct stat info {};
    if (::lstat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode)) return false;
    return (info.st_uid == ::geteuid() || folder.starts_with("/run/")) && ::access(folder.c_str(), W_OK) == 0;
}

/// A socket whose runtime was killed stays behind; its lock does not.
bool left_behind(const std::string& path) {
    const int lock = ::open((path + ".lock").c_str(), O_RDONLY | O_CLOEXEC);
    if (lock < 0) return errno == ENOENT;
    const bool free = ::flock(lock, LOCK_SH | LOCK_NB) == 0;
    ::close(lock);
    return free;
}

}  // namespace

std::vector<std::string> socket_folders() {
    std::vector<std::string> folders{"/run/taktwerk"};
    if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime == '/')
        folders.push_back(std::string(runtime) + "/taktwerk");
    folders.push_back(fmt::format("/tmp/taktwerk-{}", ::geteuid()));
    return folders;
}

Result<std::string> make_socket_path(std::string_view machine) {
    for (const auto& folder : socket_folders())
        if (usable(folder)) return folder + "/" + file_name(machine);
    return Error{"socket.no_folder", "", fmt::format("none of {} can hold the command socket", fmt::join(socket_folders(), ", ")),
                 "Make one of them writable for this user, or give a path as `socket:` in the configuration."};
}

Result<std::string> find_socket(std::string_view wanted) {
    if (wanted.find('/') != std::string_view::npos) return std::string(wanted);
    std::vector<std::string> found;
    for (const auto& folder : socket_folders()) {
        std::error_code ignored;
        for (std::filesystem::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored)) {
            const auto path = entry->path().string();
            const bool fits = wanted.empty() ? path.ends_with(suffix) : entry->path().filename() == file_name(wanted);
            if (fits) found.push_back(path);
        }
    }
    std::sort(found.begin(), found.end());
    if (found.size() > 1) found.erase(std::remove_if(found.begin(), found.end(), left_behind), found.end());
    if (found.size() == 1 || (!wanted.empty() && !found.empty())) return found.front();
    if (found.empty())
        return Error{"socket.not_found", "",
                     wanted.empty() ? std::string("no machine runs here") : fmt::format("no machine '{}' runs here", wanted),
                     fmt::format("{} (looked in {})", start_hint, fmt::join(socket_folders(), ", "))};
    return Error{"socket.ambiguous", "", fmt::format("{} machines run here: {}", found.size(), fmt::join(found, ", ")),
                 "Say which one: its name or its socket."};
}

}  // namespace taktwerk::hmi
