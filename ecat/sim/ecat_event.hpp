#pragma once

#include <cstdint>

namespace taktwerk::ecat::sim {

/// Bits of the event request to the master (0210h).
namespace ecat_event {
inline constexpr std::uint16_t dc_latch = 1u << 0, dl_status = 1u << 2, al_status = 1u << 3;
inline constexpr unsigned sync_manager_0 = 4;  ///< bit of SM0; SM1..SM7 follow
}  // namespace ecat_event

}  // namespace taktwerk::ecat::sim
