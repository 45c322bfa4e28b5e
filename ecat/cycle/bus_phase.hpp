#pragma once
// How far a bus is: written by the scripts, read by the cycle and by everybody above.

#include <cstdint>

namespace taktwerk::ecat {

enum class BusPhase : std::uint8_t { idle, scanning, preop, configuring, safeop, operational, failed, stopping, stopped };

}  // namespace taktwerk::ecat
