#pragma once
// A drive by SDO on a bus that this command drives itself: a network interface, or the simulated slaves of a machine file.

#include "apps/drive/access.hpp"

namespace taktwerk::apps {

/// Refuses while another master is on the cable. Brings the bus no further than speaking to the drive's mailbox needs (PREOP); a fault
/// reset brings it to OP, with every drive disabled.
int with_drive_over_bus(const DriveOptions& options, const std::function<int(DriveAccess&)>& work);

}  // namespace taktwerk::apps
