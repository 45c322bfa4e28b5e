#pragma once
// taktwerk jog GROUP DIRECTION...: a group of axes moves in a frame while this command lives. See jog.hpp for one axis alone.

#include <string>
#include <vector>

#include "apps/machine/remote.hpp"

namespace taktwerk::apps {

struct GroupJogOptions {
    std::string group, frame = "mcs", speed, distance;
    std::vector<std::string> directions;  ///< "x+", "shoulder-"
    double for_s = 0;                     ///< 0: until a signal
};

/// Presses, renews, lets go. Returns the exit code.
[[nodiscard]] int jog_group(const RemoteOptions& remote, const GroupJogOptions& options, hmi::Client& client);

}  // namespace taktwerk::apps
