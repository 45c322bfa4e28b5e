#pragma once
// Where a group is and how fast: MC_GroupReadPosition, MC_GroupReadVelocity, MC_GroupReadAcceleration (v2.0), MC_GroupReadActualPosition,
// MC_GroupReadActualVelocity (v1.0). PLCopen Part 4. Real-time safe. Values go back whenever Valid is FALSE.

#include <cmath>
#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

namespace detail {

/// Whether values of the axes are values of this frame too: no_kinematics, not_supported.
[[nodiscard]] constexpr ErrorId refuse_frame(const axes::GroupView& view, MC_CoordSystem frame) noexcept {
    if (frame == mcACS) return ErrorId::none;
    if (!view.kinematics) return ErrorId::no_kinematics;
    if (!view.tool_known) return ErrorId::out_of_reach;
    return frame == mcMCS ? ErrorId::none : ErrorId::not_supported;
}
[[nodiscard]] inline MC_POS_REF place_of(const AxisValues& values, const std::array<double, 6>& tool, MC_CoordSystem frame) noexcept {
    MC_POS_REF place;
    if (frame == mcACS) place.A.Axes = values;
    else place.C.Tcp = {tool[0], tool[1], tool[2], tool[3], tool[4], tool[5]};
    return place;
}
/// v1.0 has one array for both: of the tool X, Y, Z, RX, RY, RZ.
[[nodiscard]] inline AxisValues values_of(const AxisValues& values, const std::array<double, 6>& tool, MC_CoordSystem frame) noexcept {
    if (frame == mcACS) return values;
    return {tool[0], tool[1], tool[2], tool[3], tool[4], tool[5]};
}
[[nodiscard]] inline double norm(const AxisValues& values) noexcept {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum);
}

/// Of the axes; in other frames of the tool's point, whose turns do not count.
[[nodiscard]] inline double path_norm(const AxisValues& values, MC_CoordSystem frame) noexcept {
    return frame == mcACS ? norm(values) : norm({values[0], values[1], values[2]});
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
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem, &Self::Source>(), reading<Self>(),
                         out<&Self::Position>("", "A in ACS, else C; mcCommandedValue: the end of the active command"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto error = detail::refuse_frame(view, CoordSystem);
        if (error != ErrorId::none) return Reading::unless(error);
        switch (Source) {
            case mcActualValue: Position = detail::place_of(view.actual_position, view.tool_actual, CoordSystem); break;
            case mcCommandedValue: Position = detail::place_of(view.commanded, view.tool_commanded, CoordSystem); break;
            case mcSetValue: Position = detail::place_of(view.set_position, view.tool_set, CoordSystem); break;
        }
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
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem, &Self::Source>(), reading<Self>(),
                         out<&Self::Velocity>("", "u/s of each member; in MCS of X, Y, Z, and rad/s about them"),
                         out<&Self::PathVelocity>("u/s", "along the path"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        auto error = detail::refuse_frame(view, CoordSystem);
        if (error == ErrorId::none && Source == mcCommandedValue) error = ErrorId::not_supported;
        if (error != ErrorId::none) return Reading::unless(error);
        Velocity = Source == mcActualValue ? detail::values_of(view.actual_velocity, view.tool_actual_velocity, CoordSystem)
                                           : detail::values_of(view.set_velocity, view.tool_velocity, CoordSystem);
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
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), in<&Self::Source>("", "mcSetValue"),
                         reading<Self>(), out<&Self::Acceleration>("", "u/s2 of each member"),
                         out<&Self::PathAcceleration>("u/s2", "along the path"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        auto error = detail::refuse_frame(view, CoordSystem);
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
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::Position>("", "u of each member; in MCS X, Y, Z, RX, RY, RZ"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto error = detail::refuse_frame(view, CoordSystem);
        if (error != ErrorId::none) return Reading::unless(error);
        Position = detail::values_of(view.actual_position, view.tool_actual, CoordSystem);
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
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::Velocity>("", "u/s of each member; in MCS of X, Y, Z, and rad/s about them"),
                         out<&Self::PathVelocity>("u/s", "of all together"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto error = detail::refuse_frame(view, CoordSystem);
        if (error != ErrorId::none) return Reading::unless(error);
        Velocity = detail::values_of(view.actual_velocity, view.tool_actual_velocity, CoordSystem);
        PathVelocity = detail::path_norm(Velocity, CoordSystem);
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept {
        Velocity = {};
        PathVelocity = 0;
    }
};

}  // namespace taktwerk::fb
