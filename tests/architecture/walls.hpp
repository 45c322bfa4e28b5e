#pragma once
// The walls of docs/architecture.md as functions: each takes files and answers with what breaks a wall.

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/source_text.hpp"

namespace taktwerk::architecture {

/// "ecat/wire/frame.cpp:12: includes axes/..., a higher floor"
using Violations = std::vector<std::string>;

/// Lowest first; names on one level are siblings that never include each other.
[[nodiscard]] const std::vector<std::vector<std::string>>& floor_levels();

/// Which folders each folder links, as the taktwerk_library() lists say: folder -> its DEPENDS.
using FolderGraph = std::map<std::string, std::set<std::string>>;

/// One line a folder: "ecat/exchange ecat/transport core".
[[nodiscard]] FolderGraph parse_folder_graph(std::string_view lines);

/// Files include only from their own floor or lower ones; siblings never include each other.
[[nodiscard]] Violations check_floor_order(const std::vector<SourceFile>& files);

/// The buses and the third-party libraries appear only in the folders that own them.
[[nodiscard]] Violations check_owned_includes(const std::vector<SourceFile>& files);

/// A file includes only from folders that its own folder links, directly or through others. Headers at the top of a floor
/// (or in a folder without a target) are its vocabulary: a folder may include them when it may include all they include.
[[nodiscard]] Violations check_folder_links(const std::vector<SourceFile>& files, const FolderGraph& graph);

/// Folders link only their own floor or lower ones, no folder links itself through others, and all of them exist.
[[nodiscard]] Violations check_folder_graph(const FolderGraph& graph);

/// Nothing above core/ reads a clock, except where real-time stamps are wanted; nothing draws unseeded random numbers.
[[nodiscard]] Violations check_determinism(const std::vector<SourceFile>& files);

/// A file is found by asking whose idea it is: no utils, helpers, common, manager.
[[nodiscard]] Violations check_names(const std::vector<SourceFile>& files);

}  // namespace taktwerk::architecture
