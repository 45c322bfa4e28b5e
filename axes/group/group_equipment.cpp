#include "axes/group/group_equipment.hpp"

#include <algorithm>
#include <cmath>

#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {
namespace {

/// What is larger is no place of a machine; an arm computes with none (Kinematics).
constexpr double largest = 1e12;

bool finite(const SixNumbers& six) noexcept {
    return std::all_of(six.begin(), six.end(), [](double value) { return std::abs(value) <= largest; });
}
SixNumbers six_of(const JointVector& target) noexcept { return {target[0], target[1], target[2], target[3], target[4], target[5]}; }

}  // namespace

Pose GroupFrames::seen_from_machine(MC_CoordSystem frame) const noexcept {
    if (frame == mcWCS) return seen_from(pose_of_numbers(machine), Pose{});
    return is_product(frame) ? seen_from(pose_of_numbers(machine), pose_of_numbers(product[product_index(frame)])) : Pose{};
}

bool usable(const RigidBody& body) noexcept {
    const auto weight = [](double value) { return std::isfinite(value) && value >= 0; };
    return finite(body.centre) && weight(body.mass) && std::all_of(body.inertia.begin(), body.inertia.end(), weight);
}

ErrorId refuse_equipment(const GroupCommand& setting) noexcept {
    if (setting.execution > mcDelayed) return ErrorId::invalid_parameter;
    if (setting.kind == GroupCommandKind::track_frame) {
        if (!is_product(setting.frame)) return ErrorId::invalid_parameter;
        return finite(setting.track.origin) && finite(setting.track.object) ? ErrorId::none : ErrorId::invalid_position;
    }
    if (setting.kind == GroupCommandKind::set_frame) {
        if (setting.frame > mcPCS_8) return ErrorId::invalid_parameter;
        if (GroupFrames{}.find(setting.frame) == nullptr) return ErrorId::not_supported;
        return finite(six_of(setting.target)) ? ErrorId::none : ErrorId::invalid_position;
    }
    if (setting.number == 0 || setting.number >= tool_numbers) return ErrorId::invalid_tool;
    if (!finite(setting.tool.frame)) return ErrorId::invalid_position;
    return usable(setting.tool.body) ? ErrorId::none : ErrorId::invalid_parameter;
}

void apply(GroupFrames& frames, const GroupCommand& setting) noexcept {
    if (setting.kind == GroupCommandKind::track_frame) {
        // Where it stands is looked at in each cycle; a command of this one counts from here already, and its target has to be looked at there.
        frames.tracks[product_index(setting.frame)] = setting.track;
        frames.product[product_index(setting.frame)] = numbers_of(object_at(setting.track, 0, 1));
    }
    if (setting.kind != GroupCommandKind::set_frame) return;
    if (is_product(setting.frame)) frames.tracks[product_index(setting.frame)] = {};
    if (SixNumbers* frame = frames.find(setting.frame)) *frame = six_of(setting.target);
}

void apply(GroupEquipment& equipment, const GroupCommand& setting) noexcept {
    apply(equipment.frames, setting);
    if (setting.kind == GroupCommandKind::write_tool) (void)equipment.tools.define(setting.number, setting.tool);
}

ArmFacts facts_of(const Kinematics* arm) noexcept {
    ArmFacts facts;
    if (arm == nullptr) return facts;
    facts.joints = static_cast<std::uint8_t>(arm->joint_count());
    facts.kind = arm->kind();
    facts.closed_form = arm->closed_form();
    facts.base = numbers_of(arm->base());
    for (std::size_t i = 0; i < arm->joint_count(); ++i) {
        const auto& settings = arm->map().settings(i);
        facts.joint[i] = {arm->rotary()[i], settings.sign < 0, settings.zero};
    }
    if (const auto& table = arm->rows(); table) {
        facts.rows_known = true;
        facts.modified = table->convention == DhConvention::modified;
        for (std::size_t i = 0; i < max_joints; ++i)
            facts.rows[i] = {table->rows[i].theta, table->rows[i].d, table->rows[i].a, table->rows[i].alpha};
    }
    return facts;
}

}  // namespace taktwerk::axes
