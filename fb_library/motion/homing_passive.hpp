#pragma once
// Passive homing of PLCopen Part 5: the axis goes on with what it does and takes its reference in passing. The state does not change; the
// number of an absolute target stays, so the way to it changes. Real-time safe.

#include <string_view>

#include "fb_library/motion/homing_pins.hpp"

namespace taktwerk::fb {

struct MC_StepReferenceFlyingSwitch : StepBlock<MC_StepReferenceFlyingSwitch> {
    AxisRef Axis{};
    bool Execute = false;
    MC_SwitchMode SwitchMode = MC_SwitchMode::mcRisingEdge;
    fb::ReferenceSignal ReferenceSignal = home_switch_signal;
    double SetPosition = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::flying_switch;
    static constexpr std::string_view summary = "Passive homing: sets the coordinates when a switch is passed.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::SwitchMode>("", "what counts"),
                         in<&Self::ReferenceSignal>("", "the switch; by default the drive's"),
                         in<&Self::SetPosition>("u", "coordinate of the edge"),
                         in<&Self::TimeLimit>("", "not passed in this time: Error; 0 = no limit"),
                         in<&Self::DistanceLimit>("u", "not passed this far from the start: Error; 0 = no limit"),
                         out<&Self::Done>("", "passed, coordinates set"), outcome<Self>());
    }
};

struct MC_StepReferenceFlyingRefPulse : StepBlock<MC_StepReferenceFlyingRefPulse> {
    AxisRef Axis{};
    bool Execute = false;
    fb::ReferenceSignal ReferenceSignal = index_pulse_signal;
    double SetPosition = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::flying_reference_pulse;
    static constexpr std::string_view summary = "Passive homing: sets the coordinates when the next zero mark is passed.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::ReferenceSignal>("", "the pulse; by default the encoder's index, latched by the drive"),
                         in<&Self::SetPosition>("u", "coordinate of the pulse"),
                         in<&Self::TimeLimit>("", "not passed in this time: Error; 0 = no limit"),
                         in<&Self::DistanceLimit>("u", "not passed this far from the start: Error; 0 = no limit"),
                         out<&Self::Done>("", "passed, coordinates set"), outcome<Self>());
    }
};

struct MC_AbortPassiveHoming : CommandBlock<MC_AbortPassiveHoming> {
    AxisRef Axis{};
    bool Execute = false;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::abort_passive_homing;
    static constexpr std::string_view summary = "Cancels passive homing and nothing else.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), out<&Self::Done>("", "no passive homing waits any more"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb
