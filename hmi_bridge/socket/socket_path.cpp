#include "hmi_bridge/socket/socket_path.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
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
    return (info.st_uid == ::geteuid() || folder.starts_with("/run/")) && ::faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) == 0;
}

/// A socket whose runtime was killed stays behind, and nobody listens. (Its lock is the runtime's alone: it cannot be asked.)
bool left_behind(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) return true;
    std::memcpy(address.sun_path, path.c_str(), path.size());
    const int asker = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const bool refused = ::connect(asker, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 && errno == ECONNREFUSED;
    ::close(asker);
    return refused;
}

/// The folder in /tmp, and others beside it whose names nobody could guess; this user's alone.
std::vector<std::string> folders_in_tmp() {
    const auto name = fmt::format("taktwerk-{}", ::geteuid());
    std::vector<std::string> found;
    std::error_code failed;
    for (std::filesystem::directory_iterator entry("/tmp", failed), end; !failed && entry != end; entry.increment(failed)) {
        const auto file = entry->path().filename().string();
        struct stat info {};
        if ((file != name && !file.starts_with(name + "-")) || ::lstat(entry->path().c_str(), &info) != 0) continue;
        if (S_ISDIR(info.st_mode) && info.st_uid == ::geteuid()) found.push_back(entry->path().string());
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

std::vector<std::string> socket_folders() {
    std::vector<std::string> folders{"/run/taktwerk"};
    if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && *runtime == '/')
        folders.push_back(std::string(runtime) + "/taktwerk");
    const auto in_tmp = folders_in_tmp();
    folders.insert(folders.end(), in_tmp.begin(), in_tmp.end());
    const auto usual = fmt::format("/tmp/taktwerk-{}", ::geteuid());
    struct stat info {};
    if (::lstat(usual.c_str(), &info) != 0) folders.push_back(usual);  // nobody has it yet
    return folders;
}

Result<std::string> make_socket_path(std::string_view machine) {
    for (const auto& folder : socket_folders())
        if (usable(folder)) return folder + "/" + file_name(machine);
    // Somebody else was there before: a name that he could not know.
    auto pattern = fmt::format("/tmp/taktwerk-{}-XXXXXX", ::geteuid());
    if (::mkdtemp(pattern.data()) != nullptr && ::chmod(pattern.c_str(), 0755) == 0) return pattern + "/" + file_name(machine);
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
