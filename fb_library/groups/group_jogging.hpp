#pragma once
// A group by hand: MC_GroupJog, MC_GroupJogVector, MC_GroupWriteJoggingDynamics, MC_GroupReadJoggingDynamics. PLCopen Part 4 v2.0. Real-time safe.
//
//   * Needs jogging dynamics: AxisVelocity of the members in ACS, Velocity in the other frames.
//   * Each call renews the lease; a program that is no longer called stops the group after the shortest jog_lease of its members.
//   * What ends by itself - at a limit, in front of a singularity, at a distance - begins again when the inputs have changed.
//   * Another command that takes over: CommandAborted until Enable falls.

#include <cmath>
#include <string_view>

#include "fb_library/groups/jog_core.hpp"

namespace taktwerk::fb {

using JogSlots = std::array<bool, axes::most_members>;
using JogDirection = std::array<double, 6>;
// clang-format off
template <> struct PinTypeOf<JogSlots> { static constexpr PinType value{PinKind::STRUCT, "ARRAY OF BOOL"}; };
template <> struct PinTypeOf<JogDirection> { static constexpr PinType value{PinKind::STRUCT, "ARRAY[6] OF LREAL"}; };
// clang-format on

struct MC_GroupJog {
    using Self = MC_GroupJog;
    GroupRef AxesGroup{};
    bool Enable = false;
    JogSlots JogPositive{}, JogNegative{};
    double VelOverride = 1, AccOverride = 1;
    MC_CoordSystem CoordSystem = mcACS;
    double MaxLinearDistance = 0, MaxAngularDistance = 0;

    bool Enabled = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    JogCore core{};  ///< not a pin

    static constexpr std::string_view summary = "Moves the group as long as an input of a member, or of a direction of the tool, is TRUE.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(),
                         in<&Self::JogPositive>("", "ACS: of each member by IdentInGroup; else X, Y, Z, and turns about them"),
                         in<&Self::JogNegative>("", "likewise; both of a slot TRUE: it stands"),
                         in<&Self::VelOverride>("1", "0 to 1; default 1"), in<&Self::AccOverride>("1", "above 0 to 1; default 1"),
                         in<&Self::CoordSystem>("", "in which frame"),
                         in<&Self::MaxLinearDistance>("u", "how far a press goes at most; 0 = as far as it can"),
                         in<&Self::MaxAngularDistance>("rad", "likewise: rad of the tool's turns, in ACS u of turning members"),
                         out<&Self::Enabled>("", "the inputs count"), out<&Self::Active>("", "moving"),
                         grouped<&Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    void operator()(const MotionContext& ctx) noexcept {
        JogWish wish{.frame = CoordSystem, .pins = {MaxLinearDistance, MaxAngularDistance, VelOverride, AccOverride}};
        for (std::size_t i = 0; i < JogPositive.size(); ++i)
            wish.direction[i] = static_cast<double>(JogPositive[i]) - static_cast<double>(JogNegative[i]);
        wish.error = refuse_jog_shares(VelOverride, AccOverride);
        core.call(ctx, AxesGroup, Enable, wish);
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {
        core.warm_start();
        core.publish(*this);
    }
};

/// In a frame of the tool only. A length above 1 counts as 1; a direction that is off by more than 0.05 rad stands first.
struct MC_GroupJogVector {
    using Self = MC_GroupJogVector;
    GroupRef AxesGroup{};
    bool Enable = false;
    JogDirection Direction{};
    double VelOverride = 1, AccOverride = 1;
    MC_CoordSystem CoordSystem = mcMCS;

    bool Enabled = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    JogCore core{};  ///< not a pin

    static constexpr std::string_view summary = "Moves the tool in a direction, as fast as its length says.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Enable>(),
            in<&Self::Direction>("", "X, Y, Z, and turns about them; its length, 0 to 1, is the share of the jogging velocity"),
            in<&Self::VelOverride>("1", "0 to 1; default 1"), in<&Self::AccOverride>("1", "above 0 to 1; default 1"),
            in<&Self::CoordSystem>("", "in which frame: mcMCS; not mcACS"), out<&Self::Enabled>("", "the inputs count"),
            out<&Self::Active>("", "moving"), grouped<&Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    void operator()(const MotionContext& ctx) noexcept {
        JogWish wish{.frame = CoordSystem, .pins = {0, 0, VelOverride, AccOverride}};
        wish.error = refuse_jog_shares(VelOverride, AccOverride);
        double square = 0;
        for (const double part : Direction) square += part * part;
        const double length = std::sqrt(square);
        if (CoordSystem == mcACS || !std::isfinite(length)) {
            wish.error = ErrorId::invalid_parameter;
        } else if (length > 0) {
            for (std::size_t i = 0; i < Direction.size(); ++i) wish.direction[i] = Direction[i] / length;
            wish.pins.velocity *= std::min(length, 1.0);
        }
        core.call(ctx, AxesGroup, Enable, wish);
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {
        core.warm_start();
        core.publish(*this);
    }
};

/// 0 or less leaves a value as it is. A jog that is under way keeps those it was pressed with.
struct MC_GroupWriteJoggingDynamics : GroupSettingBlock<MC_GroupWriteJoggingDynamics> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double Velocity = -1, Acceleration = -1, Deceleration = -1, Jerk = -1;
    AxisValues AxisVelocity{}, AxisAcceleration{}, AxisDeceleration{}, AxisJerk{};

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says how fast the group is jogged.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(),
                         in<&Self::Velocity>("u/s", "of the tool's point; 0 or less = stays as it is"),
                         in<&Self::Acceleration>("u/s2", "likewise; never written: what the axes' limits leave"),
                         in<&Self::Deceleration>("u/s2", "likewise"), in<&Self::Jerk>("u/s3", "likewise"),
                         in<&Self::AxisVelocity>("", "u/s of each member, in every frame; 0 or less = stays as it is"),
                         in<&Self::AxisAcceleration>("", "u/s2, likewise"), in<&Self::AxisDeceleration>("", "u/s2, likewise"),
                         in<&Self::AxisJerk>("", "u/s3, likewise"), out<&Self::Done>("", "later jogs have them"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        return axes::WriteJoggingDynamics{
            {{Velocity, Acceleration, Deceleration, Jerk}, AxisVelocity, AxisAcceleration, AxisDeceleration, AxisJerk}};
    }
};

struct MC_GroupReadJoggingDynamics : GroupReadBlock<MC_GroupReadJoggingDynamics> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    AxisValues AxisVelocity{}, AxisAcceleration{}, AxisDeceleration{}, AxisJerk{};

    static constexpr std::string_view summary = "Gives how fast the group is jogged.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::Velocity>("u/s", "of the tool's point; 0 = not said"), out<&Self::Acceleration>("u/s2", "likewise"),
                         out<&Self::Deceleration>("u/s2", "likewise"), out<&Self::Jerk>("u/s3", "likewise"),
                         out<&Self::AxisVelocity>("", "u/s of each member; 0 = not said"),
                         out<&Self::AxisAcceleration>("", "u/s2, likewise"), out<&Self::AxisDeceleration>("", "u/s2, likewise"),
                         out<&Self::AxisJerk>("", "u/s3, likewise"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto& known = view.jogging_dynamics;
        Velocity = known.path.velocity;
        Acceleration = known.path.acceleration;
        Deceleration = known.path.deceleration;
        Jerk = known.path.jerk;
        AxisVelocity = known.velocity;
        AxisAcceleration = known.acceleration;
        AxisDeceleration = known.deceleration;
        AxisJerk = known.jerk;
        return Reading::valid();
    }
    void clear() noexcept {
        Velocity = Acceleration = Deceleration = Jerk = 0;
        AxisVelocity = AxisAcceleration = AxisDeceleration = AxisJerk = {};
    }
};

}  // namespace taktwerk::fb
