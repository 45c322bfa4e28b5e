#pragma once
// What of a machine is kept over a time without power, where, and how often.

#include <chrono>
#include <cstdint>
#include <string>

#include "core/time.hpp"

namespace taktwerk::runtime {

/// Which kept values a start begins with (docs/retain.md).
enum class RetainStart : std::uint8_t {
    warm,    ///< all
    cold,    ///< those that are persistent, parameters, positions
    origin,  ///< none
};

/// What is kept over a time without power: variables and blocks that programs name, parameters that operators set, positions of axes with
/// absolute encoders.
struct RetainConfig {
    /// Empty: nothing is kept. Simulated drives forget their positions with the process, so a run on a simulated bus wants none or one of its own.
    std::string directory;
    /// Values are written at most this often: no more than that (and what the disk takes) is lost with the power. Positions have rules of
    /// their own (retain/position_watch.hpp).
    Duration every = std::chrono::seconds{1};
    /// An input that is TRUE when the supply fails: then values are written at once. Empty: there is none.
    std::string power_fail;
    RetainStart start = RetainStart::warm;

    [[nodiscard]] bool empty() const noexcept { return directory.empty(); }
};

}  // namespace taktwerk::runtime
