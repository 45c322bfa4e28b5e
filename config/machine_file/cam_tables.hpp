#pragma once
// The keys of a cam in a machine file, and what is remarked of it.

#include <optional>
#include <string>
#include <vector>

#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

/// As written, before the laws and velocities that are left out are filled in.
struct CamPointEntry {
    axes::CamPoint point;
    std::optional<double> velocity;
    std::optional<axes::CamSegment> law;
    std::string place;  ///< file:line:column
};

struct CamEntry {
    runtime::CamConfig cam;  ///< complete once it is read, also when its points come from a file
    std::optional<axes::CamSegment> law;
    std::vector<CamPointEntry> points;
    std::string file;
    std::vector<Error> remarks;  ///< legal, but perhaps not meant: steps between segments
};

/// Keys under `cams.<name>`. The axes have to be read before: they give the units.
[[nodiscard]] Table<CamEntry> cam_table();

}  // namespace taktwerk::config
