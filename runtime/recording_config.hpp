#pragma once
// What of a machine's past is kept, and where.

#include <chrono>
#include <cstdint>
#include <string>

#include "core/time.hpp"

namespace taktwerk::runtime {

/// The memory of the scope, and what is kept of it around each alarm that stops something (docs/recording.md).
struct RecordingConfig {
    Duration depth = std::chrono::seconds{20};   ///< of every signal, each cycle, in memory
    std::string directory;                       ///< of the recordings around alarms; empty: none is kept
    std::uint16_t files = 20;                    ///< so many are kept, the newest; 0: none is made
    Duration before = std::chrono::seconds{10};  ///< what a recording shows before its alarm ...
    Duration after = std::chrono::seconds{2};    ///< ... and behind it
    bool replay = true;                          ///< the run up to there is kept as well, for `taktwerk replay`
    std::uint32_t replay_memory = 64;            ///< MB of it in memory, then it goes to the disk
    std::uint32_t replay_disk = 2000;            ///< MB of all of them there
};

}  // namespace taktwerk::runtime
