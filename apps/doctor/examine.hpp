#pragma once
// The whole examination: facts, findings, measuring, verdict. Used by `taktwerk doctor` and by `taktwerk diag`.

#include <string>

#include "apps/doctor/ethernet_port.hpp"
#include "apps/doctor/report.hpp"

namespace taktwerk::apps {

/// Not measured yet: what is there, and what it means. `root`: of the files that are read.
[[nodiscard]] Examination examine(const std::filesystem::path& root, const EthernetPorts& ports, const Wanted& wanted,
                                  const std::string& interface);
/// Measures for `lasts` on this computer, over the interface too where nobody else is on it, and judges anew.
void measure(Examination& seen, Duration lasts);

}  // namespace taktwerk::apps
