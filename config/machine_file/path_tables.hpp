#pragma once
// `paths:` of a machine file: programs in G-code that groups go, and the file of the tools and offsets that they meet.

#include <string>
#include <vector>

#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

struct PathEntry {
    runtime::PathConfig path;  ///< without text, tools and offsets
    std::string tables;        ///< file of tools and offsets; empty: there are none
    Position at{};
};

/// Keys under `paths.<name>`.
[[nodiscard]] Table<PathEntry> path_table();

struct OffsetEntry {
    std::string name;
    gcode::AxisValues zero{};
};
struct PathTablesFile {
    std::vector<OffsetEntry> named_tools, offsets;
    gcode::AxisValues reference{}, second_reference{};
};
/// Of a file of tools and offsets.
[[nodiscard]] Table<PathTablesFile> path_tables_table();

/// What the machine has of it: text, tools and offsets are read. `beside`: what a relative name is relative to. Errors: config.path_file, config.tool, config.offset, and those of
/// reading YAML, with file, line and column.
void complete(Reader& reader, PathEntry& entry, const std::string& beside);

}  // namespace taktwerk::config
