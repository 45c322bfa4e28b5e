#pragma once
// What a cycle in a mode of the drive came to.

#include <cstdint>

namespace taktwerk::axes {

enum class ModeStep : std::uint8_t {
    made,        ///< this cycle's set-point is made
    free,        ///< it is made as ever
    again,       ///< another phase has begun: step once more
    next,        ///< a command is over: what waits has its turn, and the set-point is made as ever
    next_again,  ///< likewise, then step once more
};

}  // namespace taktwerk::axes
