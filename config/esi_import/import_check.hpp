#pragma once
// Is what was made of a vendor's device a device file that a machine can use? Not real-time.

#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::config {

/// What the loader says of this text as NAME.yaml, and what the bus says of the device as its only slave; empty: nothing is wrong.
[[nodiscard]] std::vector<Error> problems_of_device(const std::string& name, std::string_view text);

}  // namespace taktwerk::config
