#include "axes/group/group_places.hpp"

#include <algorithm>
#include <cmath>

#include "axes/kinematics/kinematics.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

Joints first_joints(const JointVector& values) noexcept {
    Joints joints{};
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
    return joints;
}
JointVector by_place(const Joints& joints) noexcept {
    JointVector values{};
    for (std::size_t i = 0; i < max_joints; ++i) values[i] = joints[i];
    return values;
}

ErrorId refuse(MC_CoordSystem frame, const GroupView& view) noexcept {
    if (frame > mcPCS_8) return ErrorId::invalid_parameter;
    if (frame == mcFCS) return ErrorId::not_supported;
    return frame == mcACS || view.kinematics ? ErrorId::none : ErrorId::no_kinematics;
}

ErrorId error_of_miss(const Miss& miss) noexcept {
    switch (miss.fault) {
        case KinematicFault::none: return ErrorId::none;
        case KinematicFault::joint_limit: return ErrorId::beyond_software_limit;
        case KinematicFault::not_finite: return ErrorId::invalid_position;
        default: return ErrorId::out_of_reach;
    }
}

bool finite_six(const SixNumbers& six) noexcept {
    return std::all_of(six.begin(), six.end(), [](double value) { return std::isfinite(value); });
}

/// The frames of one question: how each is seen from the machine.
class Seen {
public:
    Seen(const GroupEquipment& equipment, const Pose& tool_now) noexcept : frames_(equipment.frames), tool_(tool_now) {}
    [[nodiscard]] Pose of(MC_CoordSystem frame) const noexcept { return frame == mcTCS ? tool_ : frames_.seen_from_machine(frame); }

private:
    const GroupFrames& frames_;
    const Pose& tool_;
};

SixNumbers turned_back(const Pose& frame, const SixNumbers& v) noexcept {
    const Eigen::Quaterniond back = orientation_of(frame).conjugate();
    const Eigen::Vector3d linear = back * Eigen::Vector3d(v[0], v[1], v[2]), angular = back * Eigen::Vector3d(v[3], v[4], v[5]);
    return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
}

}  // namespace

PlaceAnswer transformed(const PlaceQuestion& question, const GroupView& view, const GroupEquipment& equipment,
                        const Kinematics* arm) noexcept {
    PlaceAnswer answer;
    for (const auto frame : {question.from, question.to})
        if (const auto error = refuse(frame, view); error != ErrorId::none) return {error, {}, false};
    answer.place = question.place;
    const bool from_axes = question.from == mcACS;
    const auto& given = question.place;
    if (from_axes ? !std::all_of(given.axes.begin(), given.axes.end(), [](double v) { return std::isfinite(v); }) : !finite_six(given.six))
        return {ErrorId::invalid_position, {}, false};
    if (!view.kinematics) return answer;  // from axes to axes

    const Pose& tool = equipment.tool_pose();
    const Joints set = first_joints(view.set_position);
    const auto now = arm->forward(set, tool);
    if ((question.from == mcTCS || question.to == mcTCS) && !now.miss.ok()) return {error_of_miss(now.miss), {}, false};
    const Seen seen(equipment, now.pose);
    Pose pose;
    if (from_axes) {
        const auto at = arm->forward(first_joints(given.axes), tool);
        if (!at.miss.ok()) return {error_of_miss(at.miss), {}, false};
        pose = at.pose;
        answer.place.configuration = arm->configuration(first_joints(given.axes));
        answer.singular = arm->singularity(first_joints(given.axes)).measure < least_singularity;
    } else {
        pose = composed(seen.of(question.from), pose_of_numbers(given.six));
        const auto stand = arm->inverse(pose, tool, given.configuration, set);
        if (question.to == mcACS && !stand.ok()) return {error_of_miss(stand.miss), {}, false};
        if (stand.ok()) {
            answer.place.axes = by_place(stand.axes);
            answer.place.configuration = stand.configuration;
            answer.singular = arm->singularity(stand.axes).measure < least_singularity;
        }
    }
    if (question.to != mcACS) answer.place.six = numbers_of(composed(inverted(seen.of(question.to)), pose));
    return answer;
}

PlaceAnswer position_in(MC_CoordSystem frame, MC_Source source, const GroupView& view, const GroupEquipment& equipment,
                        const Kinematics* arm) noexcept {
    if (const auto error = refuse(frame, view); error != ErrorId::none) return {error, {}, false};
    const bool actual = source == mcActualValue, commanded = source == mcCommandedValue;
    PlaceAnswer answer;
    answer.place.axes = actual ? view.actual_position : commanded ? view.commanded : view.set_position;
    if (frame == mcACS) return answer;
    if (frame == mcTCS) return {ErrorId::not_supported, {}, false};
    if (!view.tool_known) return {ErrorId::out_of_reach, {}, false};
    const Joints joints = first_joints(answer.place.axes);
    answer.place.configuration = arm->configuration(joints);
    answer.singular = arm->singularity(joints).measure < least_singularity;
    const auto& six = actual ? view.tool_actual : commanded ? view.tool_commanded : view.tool_set;
    answer.place.six = frame == mcMCS ? six : numbers_of(seen_from(equipment.frames.seen_from_machine(frame), pose_of_numbers(six)));
    return answer;
}

SixAnswer velocity_in(MC_CoordSystem frame, MC_Source source, const GroupView& view, const GroupEquipment& equipment) noexcept {
    if (const auto error = refuse(frame, view); error != ErrorId::none) return {error, {}};
    if (frame == mcACS || source == mcCommandedValue) return {ErrorId::not_supported, {}};
    if (!view.tool_known) return {ErrorId::out_of_reach, {}};
    const bool actual = source == mcActualValue;
    const Pose tool = pose_of_numbers(actual ? view.tool_actual : view.tool_set);
    return {ErrorId::none, turned_back(Seen(equipment, tool).of(frame), actual ? view.tool_actual_velocity : view.tool_velocity)};
}

PlaceAnswer members_for(const SetGroupPosition& wanted, const GroupView& view, const GroupEquipment& equipment,
                        const Kinematics* arm) noexcept {
    if (const auto error = refuse(wanted.frame, view); error != ErrorId::none) return {error, {}, false};
    PlaceAnswer answer;
    if (wanted.frame == mcACS) {
        for (std::size_t i = 0; i < most_members; ++i)
            answer.place.axes[i] = wanted.relative ? view.actual_position[i] + wanted.target[i] : wanted.target[i];
        return answer;
    }
    const Pose given = pose_of_six(wanted.target);
    if (!finite_six({wanted.target[0], wanted.target[1], wanted.target[2], wanted.target[3], wanted.target[4], wanted.target[5]}))
        return {ErrorId::invalid_position, {}, false};
    const Pose& tool = equipment.tool_pose();
    const auto here = arm->forward(first_joints(view.actual_position), tool);
    if (!here.miss.ok()) return {error_of_miss(here.miss), {}, false};
    const Pose frame = Seen(equipment, here.pose).of(wanted.frame);
    Pose goal = composed(frame, given);
    if (wanted.relative) {  // as a relative move: the distance and the turn are in the frame's directions
        const Eigen::Quaterniond f = orientation_of(frame);
        goal =
            pose_of(position_of(here.pose) + f * position_of(given), f * orientation_of(given) * f.conjugate() * orientation_of(here.pose));
    }
    const auto stand = arm->inverse(goal, tool, wanted.wanted, first_joints(view.actual_position));
    if (!stand.ok()) return {error_of_miss(stand.miss), {}, false};
    answer.place.axes = by_place(stand.axes);
    return answer;
}

}  // namespace taktwerk::axes
