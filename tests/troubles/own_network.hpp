#pragma once
// A network of this process alone, with a pair of virtual cables: port0 is the master's, port1 stands for the first slave.

#include <string>

namespace taktwerk::troubles {

/// False: this system lets nobody make network namespaces or veth pairs.
[[nodiscard]] bool own_network_possible();
/// The pair anew, both ends switched on.
void lay_cable();
bool shell(const std::string& command);

}  // namespace taktwerk::troubles
