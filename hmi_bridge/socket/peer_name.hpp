#pragma once
// What the other end of a local socket is called in answers and in the log.

#include <string>

#include "hmi_bridge/line_handler.hpp"

namespace taktwerk::hmi {

/// "process 812 (taktwerk) of user 1000". Process and user are the kernel's word; the name in brackets is what the process calls itself, without
/// anything that could look like more than a name. Not looked up: a user's name, for that may ask the network.
[[nodiscard]] std::string peer_name(const Peer& peer);

}  // namespace taktwerk::hmi
