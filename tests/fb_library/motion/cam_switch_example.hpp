#pragma once
// The example of the standard for MC_DigitalCamSwitch (PLCopen Part 1 v2.0, p. 82): modulo 5000.

#include <chrono>
#include <vector>

#include "axes/tables/motion_tables.hpp"

namespace taktwerk::fb::test {

inline constexpr double cam_switch_turn = 5000;

inline std::vector<axes::CamSwitch> cam_switch_example() {
    using namespace std::chrono_literals;
    using axes::CamSwitchDirection;
    return {
        {.track = 1, .first = 2000, .last = 3000, .direction = CamSwitchDirection::positive},
        {.track = 1, .first = 2500, .last = 3000, .direction = CamSwitchDirection::negative},
        {.track = 1, .first = 4000, .last = 1000},
        {.track = 2, .first = 3000, .mode = axes::CamSwitchMode::time, .duration = 1350ms},
    };
}

}  // namespace taktwerk::fb::test
