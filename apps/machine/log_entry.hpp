#pragma once
// One event of a running machine before it is a line: each way out (terminal, JSON, the page's log, the journal) writes it in its own manner.

#include <functional>
#include <string>

#include "runtime/machine/machine.hpp"

namespace taktwerk::apps {

struct LogEntry {
    double at_s = 0;                            ///< machine time since the log began
    std::string event;                          ///< in a word: "ALARM", "gone", "axis x"
    std::string text;                           ///< one line
    std::string remedy{};                       ///< of a command that was refused; of an alarm it is among its words
    const runtime::AlarmText* alarm = nullptr;  ///< its words, where it is one; valid within the call
};

/// Whoever takes entries must not wait: it is called on the service thread.
using LogSink = std::function<void(const LogEntry&)>;

/// For a person: the event, and below it why and what to do. Ends with a new line.
[[nodiscard]] std::string text_lines(const LogEntry& entry);
/// For a script: one JSON object.
[[nodiscard]] std::string json_line(const LogEntry& entry);

}  // namespace taktwerk::apps
