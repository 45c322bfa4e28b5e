#include "hmi_bridge/socket/peer_name.hpp"

#include <cctype>
#include <fstream>

#include <fmt/format.h>

namespace taktwerk::hmi {

std::string peer_name(const Peer& peer) {
    std::ifstream comm(fmt::format("/proc/{}/comm", peer.pid));
    char text[17] = {};  // the kernel keeps 15 characters
    comm.read(text, sizeof text - 1);
    std::string name;
    for (const char c : std::string_view(text, static_cast<std::size_t>(comm.gcount())))
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.') name += c;
    return fmt::format("process {}{} of user {}", peer.pid, name.empty() ? "" : " (" + name + ")", peer.uid);
}

}  // namespace taktwerk::hmi
