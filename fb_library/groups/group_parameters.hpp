#pragma once
// MC_GroupReadParameter, MC_GroupWriteParameter, MC_GroupWriteReferenceDynamics, MC_GroupReadReferenceDynamics: PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// The numbers are ours: our sources name them only. Which joint mcTransitionReferencePoint means is disputed among them: not_supported.
enum MC_GroupParameter : std::uint8_t { mcDynamicsMode, mcTransitionReferencePoint };
/// Values of mcDynamicsMode.
enum class MC_DynamicsMode : std::uint8_t { mcAbsolute, mcPercentage };

namespace detail {
inline constexpr std::array<std::string_view, 2> group_parameter_names{"mcDynamicsMode", "mcTransitionReferencePoint"};

[[nodiscard]] constexpr ErrorId refuse_parameter(MC_GroupParameter number) noexcept {
    if (number > mcTransitionReferencePoint) return ErrorId::unknown_parameter;
    return number == mcDynamicsMode ? ErrorId::none : ErrorId::not_supported;
}
}  // namespace detail

template <>
struct PinTypeOf<MC_GroupParameter> {
    static constexpr PinType value{PinKind::ENUM, "MC_GROUP_PARAMETER", detail::group_parameter_names};
};

struct MC_GroupReadParameter : GroupReadBlock<MC_GroupReadParameter> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_GroupParameter ParameterNumber = mcDynamicsMode;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Value = 0;

    static constexpr std::string_view summary = "Gives the value of a parameter of the group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::ParameterNumber>("", "mcDynamicsMode"), reading<Self>(),
                         out<&Self::Value>("1", "mcDynamicsMode: 0 mcAbsolute, 1 mcPercentage"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto error = detail::refuse_parameter(ParameterNumber);
        if (error != ErrorId::none) return Reading::unless(error);
        Value = view.reference_dynamics.percent ? 1 : 0;
        return Reading::valid();
    }
    void clear() noexcept { Value = 0; }
};

/// Later commands have it; what is accepted already stays as it was meant.
struct MC_GroupWriteParameter : GroupSettingBlock<MC_GroupWriteParameter> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_GroupParameter ParameterNumber = mcDynamicsMode;
    double Value = 0;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, CommandAccepted = false, CommandAborted = false;
    CommandNumber CommandID{};
    bool Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Writes a parameter of the group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::ParameterNumber>("", "mcDynamicsMode"),
                         in<&Self::Value>("1", "mcDynamicsMode: 0 mcAbsolute, 1 mcPercentage"),
                         in<&Self::ExecutionMode>("", "mcImmediately; no other yet"), out<&Self::Done>("", "later commands have it"),
                         grouped<&Self::Busy>(), out<&Self::CommandAccepted>("", "FALSE: it is done at once, and never in the queue"),
                         out<&Self::CommandAborted>("", "FALSE, likewise"), out<&Self::CommandID>("", "0, likewise"),
                         grouped<&Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] ErrorId refuse() const noexcept {
        if (ExecutionMode != mcImmediately) return ErrorId::not_supported;
        const auto error = detail::refuse_parameter(ParameterNumber);
        if (error != ErrorId::none) return error;
        return Value == 0 || Value == 1 ? ErrorId::none : ErrorId::invalid_parameter;
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::SetDynamicsMode{Value == 1}; }
};

/// 0 or less leaves a value as it is.
struct MC_GroupWriteReferenceDynamics : GroupSettingBlock<MC_GroupWriteReferenceDynamics> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Velocity = -1, Acceleration = -1, Deceleration = -1, Jerk = -1;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says what 100 percent are, where commands say percents (mcPercentage).";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::Velocity>("u/s", "along the path; 0 or less = stays as it is"),
            in<&Self::Acceleration>("u/s2", "likewise"), in<&Self::Deceleration>("u/s2", "likewise"), in<&Self::Jerk>("u/s3", "likewise"),
            out<&Self::Done>("", "later commands have them"), grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        return axes::WriteDynamics{axes::WriteDynamics::Which::reference_dynamics, {Velocity, Acceleration, Deceleration, Jerk}};
    }
};

struct MC_GroupReadReferenceDynamics : GroupReadBlock<MC_GroupReadReferenceDynamics> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;

    static constexpr std::string_view summary = "Gives what 100 percent of a command's dynamics are.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::Velocity>("u/s", "along the path; 0 = not said: percents are refused"),
                         out<&Self::Acceleration>("u/s2", "likewise"), out<&Self::Deceleration>("u/s2", "likewise"),
                         out<&Self::Jerk>("u/s3", "likewise"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto& known = view.reference_dynamics.of;
        Velocity = known.velocity;
        Acceleration = known.acceleration;
        Deceleration = known.deceleration;
        Jerk = known.jerk;
        return Reading::valid();
    }
    void clear() noexcept { Velocity = Acceleration = Deceleration = Jerk = 0; }
};

}  // namespace taktwerk::fb
