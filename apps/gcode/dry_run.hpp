#pragma once
// A program in G-code on a simulated machine, in virtual time: what `taktwerk gcode run` does. The machine's own programs do not run.

#include <array>
#include <string>
#include <vector>

#include "axes/group/group_view.hpp"
#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

struct DryRunWish {
    std::string group;  ///< of the machine
    axes::PathOptions options{};
    double override_factor = 1;
    double most_seconds = 3600;  ///< of machine time
    bool keeps_points = false;
};

struct DryRunPoint {
    double seconds = 0;
    std::array<double, 3> at{};  ///< of the tool's point, u of the group
    double velocity = 0;         ///< along the path
    std::uint32_t line = 0;
};

struct DryRunRequest {
    axes::PathRequest request{};
    std::uint32_t line = 0;
    double seconds = 0;
};

struct DryRunOutcome {
    bool done = false;
    axes::PathPlace place{};  ///< why not; error none: it took too long
    std::string where{};      ///< of that, in words, but for the line (hmi_bridge/words/place_text.hpp); empty: nobody can say
    double seconds = 0;       ///< from MC_MovePath to its end
    double moving = 0;        ///< of them
    double length = 0, fastest = 0;
    double at_feed = 0;                                 ///< s, that the command's own velocity or acceleration held the path back
    std::array<double, axes::most_members> at_limit{};  ///< s, that a member did, by place
    std::vector<DryRunRequest> requests{};
    std::vector<DryRunPoint> points{};
};

/// `config`: of the machine, simulated, with the program as its only path. Errors: what Machine::build, bringing up or homing says.
[[nodiscard]] Result<DryRunOutcome> dry_run(runtime::MachineConfig config, const DryRunWish& wish);

}  // namespace taktwerk::apps
