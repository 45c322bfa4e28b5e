#pragma once
// Where a group is and how fast: MC_GroupReadPosition, MC_GroupReadVelocity, MC_GroupReadAcceleration (v2.0), MC_GroupReadActualPosition,
// MC_GroupReadActualVelocity (v1.0). PLCopen Part 4. Real-time safe. Values go back whenever Valid is FALSE.

#include <cmath>
#include <string_view>

#include "fb_library/groups/group_arm_blocks.hpp"
#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

namespace detail {

/// v1.0 has one array for both: of the tool X, Y, Z, RX, RY, RZ.
[[nodiscard]] inline AxisValues values_of(const axes::SixNumbers& six) noexcept { return {six[0], six[1], six[2], six[3], six[4], six[5]}; }
[[nodiscard]] inline double norm(const AxisValues& values) noexcept {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum);
}

/// Of the axes; in other frames of the tool's point, whose turns do not count.
[[nodiscard]] inline double path_norm(const AxisValues& values, MC_CoordSystem frame) noexcept {
    return frame == mcACS ? norm(values) : norm({values[0], values[1], values[2]});
}

[[nodiscard]] inline ErrorId velocity_into(AxisValues& velocity, const MotionContext& ctx, const axes::GroupView& view, GroupRef group,
                                           MC_CoordSystem frame, MC_Source source) noexcept {
    if (source == mcCommandedValue) return ErrorId::not_supported;
    if (frame == mcACS) {
        velocity = source == mcActualValue ? view.actual_velocity : view.set_velocity;
        return ErrorId::none;
    }
    const auto answer = ctx.groups->velocity_in(group, frame, source);
    if (answer.error == ErrorId::none) velocity = values_of(answer.six);
    return answer.error;
}

}  // namespace detail

/// Of mcActualValue Error with drive_not_ready while the feedback of a member is missing.
struct MC_GroupReadPosition : GroupReadBlock<MC_GroupReadPosition> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcACS;
    MC_Source Source = mcSetValue;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_POS_REF Position{};

    static constexpr std::string_view summary = "Gives where the group is.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem, &Self::Source>(), reading<Self>(),
            out<&Self::Position>(
                "", "A in ACS, else C of the active tool with Cfg and turns; mcCommandedValue: the end of the active command"));
    }
    [[nodiscard]] Reading read_group(const MotionContext& ctx, const axes::GroupView& view) noexcept {
        const auto answer = ctx.groups->position_in(AxesGroup, CoordSystem, Source);
        if (answer.error != ErrorId::none) return Reading::unless(answer.error);
        Position = detail::position_of(answer.place, CoordSystem);
        return Reading::unless(Source == mcActualValue && !view.online ? ErrorId::drive_not_ready : ErrorId::none);
    }
    void clear() noexcept { Position = {}; }
};

/// Its commanded value would be the path's: not_supported.
struct MC_GroupReadVelocity : GroupReadBlock<MC_GroupReadVelocity> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcACS;
    MC_Source Source = mcSetValue;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    AxisValues Velocity{};
    double PathVelocity = 0;

    static constexpr std::string_view summary = "Gives how fast the group moves.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem, &Self::Source>(), reading<Self>(),
                         out<&Self::Velocity>("", "u/s of each member; in other frames of X, Y, Z, and rad/s about them"),
                         out<&Self::PathVelocity>("u/s", "along the path"));
    }
    [[nodiscard]] Reading read_group(const MotionContext& ctx, const axes::GroupView& view) noexcept {
        const auto error = detail::velocity_into(Velocity, ctx, view, AxesGroup, CoordSystem, Source);
        if (error != ErrorId::none) return Reading::unless(error);
        PathVelocity = Source == mcActualValue ? detail::path_norm(Velocity, CoordSystem) : view.path_velocity;
        return Reading::unless(Source == mcActualValue && !view.online ? ErrorId::drive_not_ready : ErrorId::none);
    }
    void clear() noexcept {
        Velocity = {};
        PathVelocity = 0;
    }
};

/// Of set values, in ACS; nobody measures the others: not_supported.
struct MC_GroupReadAcceleration : GroupReadBlock<MC_GroupReadAcceleration> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcACS;
    MC_Source Source = mcSetValue;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    AxisValues Acceleration{};
    double PathAcceleration = 0;

    static constexpr std::string_view summary = "Gives the group's set acceleration.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), in<&Self::Source>("", "mcSetValue"),
                         reading<Self>(), out<&Self::Acceleration>("", "u/s2 of each member"),
                         out<&Self::PathAcceleration>("u/s2", "along the path"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        auto error = CoordSystem != mcACS && !view.kinematics ? ErrorId::no_kinematics : ErrorId::none;
        if (error == ErrorId::none && (Source != mcSetValue || CoordSystem != mcACS)) error = ErrorId::not_supported;
        if (error != ErrorId::none) return Reading::unless(error);
        Acceleration = view.set_acceleration;
        PathAcceleration = view.path_acceleration;
        return Reading::valid();
    }
    void clear() noexcept {
        Acceleration = {};
        PathAcceleration = 0;
    }
};

/// MC_GroupReadPosition of actual values, under the name and with the pins of v1.0.
struct MC_GroupReadActualPosition : GroupReadBlock<MC_GroupReadActualPosition> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcACS;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    AxisValues Position{};

    static constexpr std::string_view summary = "Gives the group's actual position (v1.0; v2.0: MC_GroupReadPosition).";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::Position>("", "u of each member; in other frames X, Y, Z, RX, RY, RZ"));
    }
    [[nodiscard]] Reading read_group(const MotionContext& ctx, const axes::GroupView& view) noexcept {
        const auto answer = ctx.groups->position_in(AxesGroup, CoordSystem, mcActualValue);
        if (answer.error != ErrorId::none) return Reading::unless(answer.error);
        Position = CoordSystem == mcACS ? answer.place.axes : detail::values_of(answer.place.six);
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept { Position = {}; }
};

/// MC_GroupReadVelocity of actual values, likewise.
struct MC_GroupReadActualVelocity : GroupReadBlock<MC_GroupReadActualVelocity> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcACS;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    AxisValues Velocity{};
    double PathVelocity = 0;

    static constexpr std::string_view summary = "Gives the group's actual velocity (v1.0; v2.0: MC_GroupReadVelocity).";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::Velocity>("", "u/s of each member; in other frames of X, Y, Z, and rad/s about them"),
                         out<&Self::PathVelocity>("u/s", "of all together"));
    }
    [[nodiscard]] Reading read_group(const MotionContext& ctx, const axes::GroupView& view) noexcept {
        const auto error = detail::velocity_into(Velocity, ctx, view, AxesGroup, CoordSystem, mcActualValue);
        if (error != ErrorId::none) return Reading::unless(error);
        PathVelocity = detail::path_norm(Velocity, CoordSystem);
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept {
        Velocity = {};
        PathVelocity = 0;
    }
};

}  // namespace taktwerk::fb
