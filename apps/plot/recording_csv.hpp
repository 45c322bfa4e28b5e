#pragma once
// A recording as the CSV that `run --trace` would have written of the same cycles, every signal a column. Not real-time.

#include <string>

#include "runtime/scope_file/kept_rows.hpp"

namespace taktwerk::apps {

/// The first line names the columns, with units in brackets; `time_s` counts from the first row. Numbers are shortest and exact.
[[nodiscard]] std::string recording_csv(const runtime::KeptRows& kept);

}  // namespace taktwerk::apps
