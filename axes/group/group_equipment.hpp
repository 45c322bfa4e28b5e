#pragma once
// What stands around a group and what it carries: frames, tools, payloads, and what its arm is made of. Plain data, without Eigen.
//
// Frames (G-073): the world (WCS) is what the others are seen from; the machine (MCS) is what the arm's base is seen from. A command takes the frame,
// the tool and the payload of the moment in which it is accepted (G-029); what waits in front of it has had its turn by then.

#include <array>
#include <cstddef>
#include <cstdint>

#include "axes/group/frame_track.hpp"
#include "axes/group/group_command.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/kinematics/joints.hpp"
#include "axes/kinematics/tools.hpp"
#include "axes/pose.hpp"

namespace taktwerk::axes {

class Kinematics;

/// Nearer to a singularity than this a path is refused: 1 / measure says how fast a joint has to be.
inline constexpr double least_singularity = 0.01;

struct GroupFrames {
    SixNumbers machine{};                              ///< MCS, seen from WCS
    std::array<SixNumbers, product_frames> product{};  ///< seen from WCS; of one that moves: where it is now
    std::array<FrameTrack, product_frames> tracks{};   ///< of those that move

    /// nullptr: that frame is not set (the world), or is none (axes, flange), or is written otherwise (the tool).
    [[nodiscard]] SixNumbers* find(MC_CoordSystem frame) noexcept {
        if (frame == mcMCS) return &machine;
        return is_product(frame) ? &product[product_index(frame)] : nullptr;
    }
    [[nodiscard]] const SixNumbers* find(MC_CoordSystem frame) const noexcept { return const_cast<GroupFrames*>(this)->find(frame); }
    /// Of MCS, WCS and products; others: as MCS.
    [[nodiscard]] Pose seen_from_machine(MC_CoordSystem frame) const noexcept;

    /// A frame that stands has a track of no kind.
    [[nodiscard]] FrameTrack track_of(MC_CoordSystem frame) const noexcept {
        return is_product(frame) ? tracks[product_index(frame)] : FrameTrack{};
    }

    friend bool operator==(const GroupFrames&, const GroupFrames&) = default;
};

/// With what a command is gone.
struct CarriedTool {
    Pose tool{};  ///< the tool's point, seen from the flange
    std::uint8_t tool_number = 0, payload_number = 0;
};

/// What a command took when it was accepted.
struct CommandPlace {
    Pose frame{};  ///< its frame, seen from the machine; of TCS only the planner knows it
    CarriedTool carried{};
    FrameTrack track{};  ///< where its frame moves: the frame is said anew when the command begins
};

/// A row of Denavit and Hartenberg's; rad and the unit of length.
struct ArmRow {
    double theta = 0, d = 0, a = 0, alpha = 0;
};
/// The arm as it is configured.
struct ArmFacts {
    std::uint8_t joints = 0;  ///< 0: the group has no arm
    std::uint8_t kind = 0;    ///< its place among the kinds of an ArmDescription
    bool closed_form = false;
    SixNumbers base{};  ///< seen from the machine
    struct Joint {
        bool rotary = false, reversed = false;
        double zero = 0;  ///< rad or the unit of length: the arm's own where the axis is at 0
    };
    std::array<Joint, max_joints> joint{};
    bool rows_known = false, modified = false;  ///< Craig's convention, else the classic one
    std::array<ArmRow, max_joints> rows{};
};
[[nodiscard]] ArmFacts facts_of(const Kinematics* arm) noexcept;

struct GroupEquipment {
    static constexpr std::size_t most_bodies = most_moved_members;

    GroupFrames frames{};
    Tools tools{};
    Payloads payloads{};
    std::array<RigidBody, most_bodies> bodies{};  ///< of the arm's links; no set-point depends on them
    std::uint8_t body_count = 0;
    std::uint8_t selected_tool = 0, selected_payload = 0;  ///< for the next command
    std::uint8_t active_tool = 0, active_payload = 0;      ///< of the running one, else the selected ones
    ArmFacts arm{};

    /// Of the selected one, seen from the flange.
    [[nodiscard]] Pose tool_pose() const noexcept { return pose_of_numbers(tools.find(selected_tool)->frame); }
};

/// A queued setting (set_frame, write_tool): whether it can be done at all [invalid_parameter, invalid_tool, not_supported], and doing it.
[[nodiscard]] ErrorId refuse_equipment(const GroupCommand& setting) noexcept;
void apply(GroupEquipment& equipment, const GroupCommand& setting) noexcept;
void apply(GroupFrames& frames, const GroupCommand& setting) noexcept;

/// Finite, mass and inertias not negative.
[[nodiscard]] bool usable(const RigidBody& body) noexcept;

}  // namespace taktwerk::axes
