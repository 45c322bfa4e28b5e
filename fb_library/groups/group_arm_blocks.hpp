#pragma once
// The arm of a group and the coordinates it stands in: MC_ReadKinTransform, MC_ReadDHParameters, MC_ReadJointInfo, MC_GroupTransformPosition,
// MC_GroupSetPosition. PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"
#include "fb_library/groups/group_equipment_types.hpp"

namespace taktwerk::fb {

namespace detail {

/// none: there is an arm.
[[nodiscard]] inline ErrorId refuse_arm(const axes::GroupEquipment* known) noexcept {
    if (known == nullptr) return ErrorId::invalid_group;
    return known->arm.joints > 0 ? ErrorId::none : ErrorId::no_kinematics;
}
/// A in ACS, else C with the way the arm stands.
[[nodiscard]] inline MC_POS_REF position_of(const axes::GroupPlace& place, MC_CoordSystem frame) noexcept {
    MC_POS_REF position;
    if (frame == mcACS) {
        position.A.Axes = place.axes;
        return position;
    }
    position.C.Tcp = place_of_six(place.six);
    const auto& c = place.configuration;
    position.C.Cfg = {c.turns[0] != axes::any_turn, c.branch.shoulder == axes::Shoulder::front, c.branch.elbow == axes::Elbow::up,
                      c.branch.wrist == axes::Wrist::no_flip};
    for (std::size_t i = 0; i < axes::max_joints; ++i)
        position.C.TurnInfo.ATurns[i] = c.turns[i] == axes::any_turn ? std::int8_t{0} : c.turns[i];
    return position;
}

}  // namespace detail

/// It is configured with the group; nothing sets it.
struct MC_ReadKinTransform : EnableBlock<MC_ReadKinTransform> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_KIN_REF KinTransform{};

    static constexpr std::string_view summary = "Gives which arm the group is, and where it stands in the machine.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(), out<&Self::KinTransform>("", "kind, joints, base"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        const auto error = detail::refuse_arm(known);
        if (error != ErrorId::none) return Reading::unless(error);
        const auto& arm = known->arm;
        KinTransform = {arm.kind, arm.joints, arm.closed_form, detail::coordinates_of(arm.base)};
        return Reading::valid();
    }
    void clear() noexcept { KinTransform = {}; }
};

/// Of arms of six joints; of others not_supported. Of the nominal arm, its joints as the arm's picture counts them (MC_ReadJointInfo).
struct MC_ReadDHParameters : EnableBlock<MC_ReadDHParameters> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    fb::MC_DHParameters DHParameters{};

    static constexpr std::string_view summary = "Gives the arm's table of Denavit and Hartenberg.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(),
                         out<&Self::DHParameters>("", "rad, u; Modified says in which convention"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        auto error = detail::refuse_arm(known);
        if (error == ErrorId::none && !known->arm.rows_known) error = ErrorId::not_supported;
        if (error != ErrorId::none) return Reading::unless(error);
        DHParameters.Modified = known->arm.modified;
        for (std::size_t i = 0; i < DHParameters.Joint.size(); ++i) {
            const auto& row = known->arm.rows[i];
            DHParameters.Joint[i] = {row.theta, row.d, row.a, row.alpha};
        }
        return Reading::valid();
    }
    void clear() noexcept { DHParameters = {}; }
};

struct MC_ReadJointInfo : EnableBlock<MC_ReadJointInfo> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_JointInfo JointInfo{};

    static constexpr std::string_view summary = "Gives where each joint of the arm has its zero, and in which sense it counts.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(), out<&Self::JointInfo>("", "from the base on"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        const auto error = detail::refuse_arm(known);
        if (error != ErrorId::none) return Reading::unless(error);
        JointInfo.Joints = known->arm.joints;
        for (std::size_t i = 0; i < JointInfo.Joint.size(); ++i) {
            const auto& joint = known->arm.joint[i];
            JointInfo.Joint[i] = {joint.rotary, joint.reversed, joint.zero};
        }
        return Reading::valid();
    }
    void clear() noexcept { JointInfo = {}; }
};

/// Moves nothing, changes nothing, in any state. Goes by the frames and the tool that the next command would take; TCS is that tool at the set position.
/// Without ConfigValid the arm reaches the position as near to its set position as it can.
struct MC_GroupTransformPosition : EnableBlock<MC_GroupTransformPosition> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_POS_REF InputPosition{};
    MC_CoordSystem InputCoordSystem = mcACS, OutputCoordSystem = mcMCS;

    CommandNumber CommandID{};
    MC_POS_REF OutputPosition{};
    bool SingularPosition = false, Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Gives a position of the group in another frame.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::InputPosition>("", "A in ACS, else C"),
                         in<&Self::InputCoordSystem>("", "of the input"), in<&Self::OutputCoordSystem>("", "of the output"),
                         out<&Self::CommandID>("", "0: it is no command"),
                         out<&Self::OutputPosition>("", "A in ACS, else C with Cfg and turns"),
                         out<&Self::SingularPosition>("", "a path may not come so near to a singularity"), reading<Self>());
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        if (view_of(ctx, AxesGroup) == nullptr) return Reading::unless(ErrorId::invalid_group);
        axes::PlaceQuestion question{.from = InputCoordSystem, .to = OutputCoordSystem, .place = {}};
        question.place.axes = InputPosition.A.Axes;
        question.place.six = detail::six_of(InputPosition.C.Tcp);
        question.place.configuration = detail::wanted_by(InputPosition);
        const auto answer = ctx.groups->transformed(AxesGroup, question);
        if (answer.error != ErrorId::none) return Reading::unless(answer.error);
        OutputPosition = detail::position_of(answer.place, OutputCoordSystem);
        SingularPosition = answer.singular;
        return Reading::valid();
    }
    void clear() noexcept {
        OutputPosition = {};
        SingularPosition = false;
    }
};

/// In GroupStandby, with all members at rest: all of them or none. In other frames than ACS it shifts the axes so that the tool's point is there.
struct MC_GroupSetPosition : GroupCommandBlock<MC_GroupSetPosition> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_POS_REF Position{};
    bool Relative = false;
    MC_CoordSystem CoordSystem = mcACS;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, CommandAccepted = false, CommandAborted = false;
    CommandNumber CommandID{};
    bool Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says where the group is, without motion.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::Position>("", "where it is: A in ACS, else C"),
            in<&Self::Relative>("", "Position is a distance"), grouped<&Self::CoordSystem>(),
            in<&Self::ExecutionMode>("", "without effect: in motion it is refused"), out<&Self::Done>("", "it is there"),
            grouped<&Self::Busy, &Self::CommandAccepted, &Self::CommandAborted, &Self::CommandID, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        const auto six = detail::six_of(Position.C.Tcp);
        axes::GroupCommand command{.kind = Relative ? axes::GroupCommandKind::set_position_relative : axes::GroupCommandKind::set_position,
                                   .frame = CoordSystem,
                                   .wanted = detail::wanted_by(Position)};
        if (CoordSystem == mcACS) command.target = Position.A.Axes;
        else command.target = {six[0], six[1], six[2], six[3], six[4], six[5]};
        return command;
    }
};

}  // namespace taktwerk::fb
