#pragma once
// The kinds of slaves of a Bench, by their letters.

#include <memory>
#include <vector>

#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"

namespace taktwerk::troubles {

/// What a file says of it, and what its manual would.
[[nodiscard]] std::shared_ptr<ecat::DeviceDescription> device_of(char kind);
/// What the slave itself is: its firmware knows more than a file says.
[[nodiscard]] std::shared_ptr<ecat::DeviceDescription> played(char kind);
[[nodiscard]] std::unique_ptr<ecat::sim::DeviceModel> model_of(char kind);

}  // namespace taktwerk::troubles
