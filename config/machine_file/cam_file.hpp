#pragma once
// A cam as a CSV file:
//
//   # measured on the sample of 12 May
//   master [deg], slave [mm], velocity [mm/deg]
//   0, 0, 0
//   45, 12.5, 0.4
//
// One header line names the columns with their units: master and slave, and velocity (du/dM) where it is known; a unit that converts to the axis'
// is converted. Columns are parted by `,`, `;` or tabs, numbers have a decimal point. Empty lines and lines that begin with # do not count;
// CR LF and a byte-order mark do no harm.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axes/tables/cam_table.hpp"
#include "core/result.hpp"

namespace taktwerk::config {

/// A cam is prepared in one cycle, so its points are limited. The number is our choice: what that many cost a cycle was not measured.
inline constexpr std::size_t max_cam_points = 4096;

/// The units that positions are in, those of the two axes.
struct CamUnits {
    std::string master, slave;
};

struct CamFile {
    std::vector<axes::CamPoint> points;  ///< position, and velocity where the file has it
    std::vector<int> lines;              ///< of the points
    bool velocities = false;
    std::vector<Error> errors;  ///< config.cam_...: file:line:column, what and what to do; then the points are of no use
};

/// `file` is only for messages.
[[nodiscard]] CamFile parse_cam_file(const std::string& file, std::string_view text, const CamUnits& units);
/// The errors of a file that cannot be read have no place.
[[nodiscard]] CamFile read_cam_file(const std::string& path, const CamUnits& units);

/// "0.5 mm/deg" (order 1) or "0.1 mm/deg2" (order 2) in `units`; a bare number where both are the same. Nothing where it is no such quantity.
[[nodiscard]] std::optional<double> parse_cam_derivative(std::string_view text, int order, const CamUnits& units);
/// "mm/deg", "mm/deg2"
[[nodiscard]] std::string unit_of_cam_derivative(int order, const CamUnits& units);

}  // namespace taktwerk::config
