#pragma once
// What a drive file says, as pages for people: the features between two marks of docs/drives/<drive>.md, and the tables of all alarms
// and all parameters as pages of their own. Made from the loaded profile: what stands there is what runtime and simulator act on.
// Not real-time.

#include <string>
#include <string_view>
#include <vector>

#include "config/drive_file/drive_loader.hpp"
#include "core/result.hpp"

namespace taktwerk::apps {

inline constexpr std::string_view features_begin = "<!-- generated: features -->\n", features_end = "<!-- /generated -->\n";

/// Modes, homing, process data, cycle times, units, switches, stops, delays, quirks, hazards, counts of alarms and parameters,
/// assumptions, questions. A drive without a bus description (RS-485) has no process data.
[[nodiscard]] std::string drive_features_markdown(const config::LoadedDrive& drive);
/// Every alarm: code, panel, both names, cause, remedy, how it goes, section.
[[nodiscard]] std::string drive_alarms_markdown(const config::LoadedDrive& drive);
/// Every parameter: number, names, type, range, factory value, unit, when it counts, section.
[[nodiscard]] std::string drive_parameters_markdown(const config::LoadedDrive& drive);

/// `page` with the text between the two marks replaced. Errors: docs.no_marks, when one is missing or they stand in the wrong order.
[[nodiscard]] Result<std::string> with_features(const std::string& page, const std::string& features, const std::string& file);

struct CommittedPage {
    std::string file;  ///< below the folder of the documentation: "reference/drives/se-808x-alarms.md"
    std::string text;
};
/// The pages of one drive as they should stand below `docs_folder`, where its page is read. Errors: docs.no_page, docs.no_marks.
[[nodiscard]] Result<std::vector<CommittedPage>> drive_pages(const config::LoadedDrive& drive, const std::string& docs_folder);

}  // namespace taktwerk::apps
