#pragma once
// The page of devices that are no drives: what is known, and from where.

#include <string>
#include <vector>

namespace taktwerk::apps {

/// A row for every device file in these folders. Files with problems are left out.
[[nodiscard]] std::string device_reference_markdown(const std::vector<std::string>& folders);

}  // namespace taktwerk::apps
