#pragma once
// {"cmd":"alarm_history",...} and its answer. README.md of the floor has the keys. Not real-time.

#include <string>

#include "core/result.hpp"
#include "hmi_bridge/history/alarm_row.hpp"
#include "hmi_bridge/socket/json_fields.hpp"

namespace taktwerk::hmi {

/// All its keys are optional. Errors: those of JsonFields, command.bad_value.
[[nodiscard]] Result<HistoryQuery> read_history_query(JsonFields& fields);

/// Of an answer, at most: what is over is left for the next page, with "more".
inline constexpr std::size_t longest_history_answer = 512 * 1024;
/// `id`: as JSON.
[[nodiscard]] std::string history_line(const std::string& id, const HistoryPage& page);

}  // namespace taktwerk::hmi
