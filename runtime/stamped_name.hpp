#pragma once
// Names of files that a machine keeps by the moment: "demo-20261123T143015.123-slave_lost.pcapng". They sort as they read, and only the
// newest few are kept. Not real-time.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace taktwerk::runtime {

/// `ending` with its point. `since_1970`: calendar time. What is no letter, digit or underscore in `machine` and `what` becomes one.
[[nodiscard]] std::string stamped_name(std::string_view machine, Duration since_1970, std::string_view what, std::string_view ending);
/// Made by stamped_name() for this machine and ending.
[[nodiscard]] bool is_stamped(std::string_view file_name, std::string_view machine, std::string_view ending);
/// "20261123T143015.123"
[[nodiscard]] std::string utc_stamp(Duration since_1970);
/// Deletes the oldest of this machine's files with this ending, so that `most` are left. `newest`: the one just written (a path or a name); what
/// bears a later stamp was written while the clock went wrong, by it or before it was set, and counts as oldest of all. Nobody else's are touched;
/// what cannot be deleted stays.
void keep_newest(const std::string& folder, std::string_view machine, std::string_view ending, std::size_t most, const std::string& newest);

/// What is in the folder, as far as its disk says: never an exception, which a loop over a directory_iterator throws when the disk goes away. Not real-time.
[[nodiscard]] std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

}  // namespace taktwerk::runtime
