// The state table against PLCopen Part 1 v2.0, figure 2 (page 15), transcribed by hand as a list of arrows; everything else must be forbidden.

#include "axes/axis/state_machine.hpp"

#include <gtest/gtest.h>

#include <array>

namespace taktwerk::axes {
namespace {

using enum AxisState;
using E = AxisEvent;

struct Arrow {
    AxisState from;
    E by;
    AxisState to;
};

// clang-format off
constexpr std::array arrows{
    // note 2: "any" but ErrorStop
    Arrow{Disabled, E::power_off, Disabled}, Arrow{Standstill, E::power_off, Disabled}, Arrow{Homing, E::power_off, Disabled},
    Arrow{DiscreteMotion, E::power_off, Disabled}, Arrow{ContinuousMotion, E::power_off, Disabled},
    Arrow{SynchronizedMotion, E::power_off, Disabled}, Arrow{Stopping, E::power_off, Disabled},
    // notes 3 to 6
    Arrow{ErrorStop, E::reset_unpowered, Disabled}, Arrow{ErrorStop, E::reset_powered, Standstill}, Arrow{Disabled, E::powered, Standstill},
    Arrow{Stopping, E::stop_finished, Standstill},
    // MC_Stop
    Arrow{Standstill, E::stop, Stopping}, Arrow{Homing, E::stop, Stopping}, Arrow{DiscreteMotion, E::stop, Stopping},
    Arrow{ContinuousMotion, E::stop, Stopping}, Arrow{SynchronizedMotion, E::stop, Stopping},
    // homing and ends
    Arrow{Standstill, E::home, Homing}, Arrow{Homing, E::done, Standstill}, Arrow{DiscreteMotion, E::done, Standstill},
    // discrete, continuous and synchronized motion from everywhere that moves or stands
    Arrow{Standstill, E::discrete, DiscreteMotion}, Arrow{DiscreteMotion, E::discrete, DiscreteMotion},
    Arrow{ContinuousMotion, E::discrete, DiscreteMotion}, Arrow{SynchronizedMotion, E::discrete, DiscreteMotion},
    Arrow{Standstill, E::continuous, ContinuousMotion}, Arrow{DiscreteMotion, E::continuous, ContinuousMotion},
    Arrow{ContinuousMotion, E::continuous, ContinuousMotion}, Arrow{SynchronizedMotion, E::continuous, ContinuousMotion},
    Arrow{Standstill, E::synchronized, SynchronizedMotion}, Arrow{DiscreteMotion, E::synchronized, SynchronizedMotion},
    Arrow{ContinuousMotion, E::synchronized, SynchronizedMotion}, Arrow{SynchronizedMotion, E::synchronized, SynchronizedMotion},
    // MoveSuperimposed changes the state from Standstill only; GearOut, CamOut leave SynchronizedMotion
    Arrow{Standstill, E::superimposed, DiscreteMotion}, Arrow{DiscreteMotion, E::superimposed, DiscreteMotion},
    Arrow{ContinuousMotion, E::superimposed, ContinuousMotion}, Arrow{SynchronizedMotion, E::superimposed, SynchronizedMotion},
    Arrow{SynchronizedMotion, E::decoupled, ContinuousMotion},
    // Part 5: a step leads into Homing, and from one step to the next the axis stays there; nowhere else
    Arrow{Standstill, E::homing_step, Homing}, Arrow{Homing, E::homing_step, Homing},
};
// clang-format on

std::optional<AxisState> by_figure(AxisState from, E event) {
    if (event == E::axis_error) return ErrorStop;  // note 1: from any
    for (const auto& arrow : arrows)
        if (arrow.from == from && arrow.by == event) return arrow.to;
    return std::nullopt;
}

// P1-033, P1-030, P1-031, P1-020, P1-036
TEST(AxisStates, EveryPairIsAsInFigureTwo) {
    for (std::size_t s = 0; s < axis_state_count; ++s)
        for (std::size_t e = 0; e < axis_event_count; ++e) {
            const auto state = static_cast<AxisState>(s);
            EXPECT_EQ(next_state(state, static_cast<E>(e)), by_figure(state, static_cast<E>(e))) << name(state) << ", event " << e;
        }
}

// P1-034: no arrow leads from continuous or synchronized motion to Standstill.
TEST(AxisStates, ContinuousAndSynchronizedMotionDoNotEndInStandstill) {
    for (std::size_t e = 0; e < axis_event_count; ++e) {
        EXPECT_NE(next_state(ContinuousMotion, static_cast<E>(e)), Standstill);
        EXPECT_NE(next_state(SynchronizedMotion, static_cast<E>(e)), Standstill);
    }
}

TEST(AxisStates, NamesAreTheStandards) {
    EXPECT_EQ(name(SynchronizedMotion), "SynchronizedMotion");
    EXPECT_EQ(name(ErrorStop), "ErrorStop");
    EXPECT_EQ(name(Owner::operator_panel), "operator");
}

}  // namespace
}  // namespace taktwerk::axes
