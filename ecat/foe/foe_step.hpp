#pragma once
// What a message from the slave means for a file transfer.

#include <cstdint>
#include <string>

namespace taktwerk::ecat {

struct FoeStep {
    enum class Kind : std::uint8_t {
        next,     ///< send the next request, and wait for its answer
        last,     ///< send the next request; no answer comes, and all is done
        again,    ///< the slave is busy: the same request once more, a little later
        skip,     ///< an answer to something older: wait on
        done,     ///< all is there
        refused,  ///< the slave says no: `code`, `words`
        broken,   ///< that cannot be: `words`; the slave is told `code`
    } kind = Kind::skip;
    std::uint32_t code = 0;  ///< foe_error
    std::string words{};     ///< refused: the slave's own, may be empty

    // `again`: how far the slave says it is.
    std::uint16_t done = 0, entire = 0;  ///< entire 0: `done` is per cent
};

/// What a slave is asked for.
struct FoeFile {
    std::string name;
    std::uint32_t password = 0;
};

}  // namespace taktwerk::ecat
