#pragma once
// What became of each kept name at the start of a machine, for whoever reads the log.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace taktwerk::runtime {

/// What became of a name at the start.
struct RetainNote {
    enum class What : std::uint8_t {
        kept,        ///< it has the value that was kept
        converted,   ///< the same in another type
        added,       ///< nothing was kept of it: it begins with its first value
        unclaimed,   ///< nobody has it any more: kept aside
        refused,     ///< what was kept does not fit: it begins with its first value
        configured,  ///< a parameter whose value in the machine file or program is another one since: that one holds
        cold,        ///< given up, since the start is cold or the origin
        damaged,     ///< no name but a file that cannot be used
    };
    What what = What::kept;
    std::string name;
    std::string text;  ///< one sentence for people, where there is more to say than the value
};

/// The notes as lines for a log: one with the counts, then those that have more to say. None where there is nothing to tell.
[[nodiscard]] std::vector<std::string> lines_of(std::span<const RetainNote> notes);

}  // namespace taktwerk::runtime
