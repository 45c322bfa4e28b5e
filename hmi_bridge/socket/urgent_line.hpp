#pragma once
// Lines of the socket that must act before anything else is looked at: a stop, the end of the run, a jog that is let go. Also the press
// of a jog or a measurement, for who presses will have to let go. Any bytes may come in. Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

struct UrgentLine {
    enum class Kind : std::uint8_t { stop, shutdown, jog_release, jog_hold };  ///< jog_hold: a press or a renewal
    Kind kind = Kind::stop;
    std::uint16_t axis = 0xFFFF;  ///< 0xFFFF: all
    bool press = false;
    /// A key stands in it twice, it has more than 64, or it cannot be read to its end, so that nobody can tell what exactly was meant: it stops
    /// every axis, and is refused all the same.
    bool unclear = false;
    std::string id = "null";  ///< as the answer repeats it
    /// The axis of a stop is none of this machine's, or no name: it stops every axis, and is refused all the same.
    bool unclear_axis = false;
    std::vector<std::uint16_t> held{};  ///< of a press, a renewal, a release: its axis, or those of its group as configured
};

/// A stop is a stop, however odd the rest of its line: no age, no missing id, no unknown key, no length holds it up, nor that something beside
/// it is no JSON (a name that is not UTF-8, a number that is none). nullopt: none of these, or a press or a release in a line longer than 1 KiB;
/// that goes the ordinary way, which ends in the same level.
[[nodiscard]] std::optional<UrgentLine> urgent_line(std::string_view line, const runtime::MachineLayout& layout);

}  // namespace taktwerk::hmi
