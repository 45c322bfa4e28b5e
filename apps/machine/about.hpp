#pragma once
// What runs: the version of Taktwerk and of the libraries it was built with, with their licences.

#include "hmi_bridge/socket/json_requests.hpp"

namespace taktwerk::apps {

[[nodiscard]] hmi::JsonRequests::About about();

}  // namespace taktwerk::apps
