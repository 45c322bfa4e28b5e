#pragma once
// A machine as structs, for tests and benchmarks: plain CiA 402 servos and a digital terminal.

#include <memory>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime::testing {

using namespace std::chrono_literals;

/// A plain CiA 402 servo with the objects this suite needs.
std::shared_ptr<const ecat::DeviceDescription> servo_device();
std::shared_ptr<const axes::DriveProfile> servo_profile();

/// `axes` servos named x, y, z, ... on slaves x_drive, ..., each with 800 mm of travel, 10 mm a turn, switches at its ends and
/// a home switch from -20 to 0 mm; then one terminal `io` with 8 inputs and 8 outputs: estop_ok, button, spare; lamp.
MachineConfig machine_config(std::size_t axes);

}  // namespace taktwerk::runtime::testing
