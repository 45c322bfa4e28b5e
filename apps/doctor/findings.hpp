#pragma once
// Facts -> findings. Pure.

#include <vector>

#include "apps/doctor/finding.hpp"
#include "apps/doctor/host_facts.hpp"
#include "apps/doctor/port_facts.hpp"

namespace taktwerk::apps {

[[nodiscard]] std::vector<Finding> host_findings(const HostFacts& facts, const Wanted& wanted);
[[nodiscard]] std::vector<Finding> port_findings(const PortFacts& facts, const Wanted& wanted);

}  // namespace taktwerk::apps
