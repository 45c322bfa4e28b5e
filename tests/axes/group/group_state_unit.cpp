// The state table against our rules of the diagram, transcribed by hand as a list of arrows; everything else must be forbidden.

#include "axes/group/group_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace taktwerk::axes::state_table {  // whose words would be ambiguous beside axis_group.hpp
namespace {

using enum GroupState;
using E = GroupEvent;

struct Arrow {
    GroupState from;
    E by;
    GroupState to;
};

// clang-format off
constexpr std::array arrows{
    // Disabled-(Enable)->Standby; enabling an enabled group changes nothing (decided); with a kept error it leads back to it (decided)
    Arrow{GroupDisabled, E::enable, GroupStandby}, Arrow{GroupStandby, E::enable, GroupStandby}, Arrow{GroupHoming, E::enable, GroupHoming},
    Arrow{GroupMoving, E::enable, GroupMoving}, Arrow{GroupDisabled, E::enable_failed, GroupErrorStop},
    // any-(Disable)->Disabled
    Arrow{GroupDisabled, E::disable, GroupDisabled}, Arrow{GroupStandby, E::disable, GroupDisabled}, Arrow{GroupHoming, E::disable, GroupDisabled},
    Arrow{GroupMoving, E::disable, GroupDisabled}, Arrow{GroupStopping, E::disable, GroupDisabled}, Arrow{GroupErrorStop, E::disable, GroupDisabled},
    // Standby-(GroupHome)->Homing-(done)->Standby
    Arrow{GroupStandby, E::home, GroupHoming}, Arrow{GroupHoming, E::done, GroupStandby},
    // Standby-(motion)->Moving, Moving-(done, queue empty)->Standby; a motion while moving
    Arrow{GroupStandby, E::motion, GroupMoving}, Arrow{GroupMoving, E::motion, GroupMoving}, Arrow{GroupMoving, E::done, GroupStandby},
    // Standby, Homing, Moving-(GroupStop)->Stopping-(Done and not Execute)->Standby
    Arrow{GroupStandby, E::stop, GroupStopping}, Arrow{GroupHoming, E::stop, GroupStopping}, Arrow{GroupMoving, E::stop, GroupStopping},
    Arrow{GroupStopping, E::stopped, GroupStandby},
    // enabled-(error)->ErrorStop-(Reset)->Standby
    Arrow{GroupStandby, E::error, GroupErrorStop}, Arrow{GroupHoming, E::error, GroupErrorStop}, Arrow{GroupMoving, E::error, GroupErrorStop},
    Arrow{GroupStopping, E::error, GroupErrorStop}, Arrow{GroupErrorStop, E::error, GroupErrorStop}, Arrow{GroupErrorStop, E::reset, GroupStandby},
};
// clang-format on

// G-010, G-011, G-018
TEST(GroupStates, EveryStateAnswersEveryEventAsTheDiagramDoes) {
    for (std::size_t state = 0; state < group_state_count; ++state)
        for (std::size_t event = 0; event < group_event_count; ++event) {
            const auto from = static_cast<GroupState>(state);
            const auto by = static_cast<E>(event);
            const auto* arrow = std::find_if(arrows.begin(), arrows.end(), [&](const Arrow& a) { return a.from == from && a.by == by; });
            const auto to = next_state(from, by);
            if (arrow == arrows.end()) EXPECT_FALSE(to) << state << ' ' << event;
            else EXPECT_EQ(to, arrow->to) << state << ' ' << event;
        }
}

}  // namespace
}  // namespace taktwerk::axes::state_table
