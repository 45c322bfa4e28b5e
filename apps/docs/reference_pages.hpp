#pragma once
// Reference pages made from the tables the runtime itself uses: what stands there is what happens.

#include <string>

namespace taktwerk::apps {

/// Every alarm of bus, axes and machine: words in both languages, cause, remedy, reset, both reactions.
[[nodiscard]] std::string alarm_reference_markdown();
/// Every ErrorID of the blocks.
[[nodiscard]] std::string error_reference_markdown();
/// Every parameter of an axis by number.
[[nodiscard]] std::string parameter_reference_markdown();

}  // namespace taktwerk::apps
