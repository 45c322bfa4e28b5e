#pragma once
// A group, and an axis beside it that moves a product: with the oracle of a group's members, and where the tool is on the product, by hand.

#include <numbers>

#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {

/// As the members, half as jerky: 100 u/s, 500 u/s2, 2500 u/s3; half of a member is there for the frame.
inline AxisConfig belt_axis(AxisLimits limits = {.velocity = 100, .acceleration = 250, .deceleration = 250, .jerk = 2500}) {
    return group_axis("belt", limits);
}

struct TrackRig : GroupRig {
    TrackRig(std::size_t members, Arm arm, AxisConfig belt = belt_axis()) : TrackRig(named(members), arm, belt) {}
    TrackRig(std::vector<AxisConfig> members, Arm arm, AxisConfig belt = belt_axis(), const Rooms& rooms = {})
        : GroupRig(with(members, belt), all_of(members, arm, rooms)), last(members.size()) {
        enable();
    }
    static std::vector<AxisConfig> with(std::vector<AxisConfig> members, const AxisConfig& belt) {
        members.push_back(belt);
        return members;
    }

    [[nodiscard]] AxisRef belt() const { return {static_cast<std::uint16_t>(last)}; }
    [[nodiscard]] double belt_at() const { return axis(last).set_position; }
    void drive_belt(double velocity) {
        step([&] {
            EXPECT_EQ(axes[last].submit({.kind = CommandKind::move_velocity, .velocity = velocity}, Owner::program).error, ErrorId::none);
        });
    }
    Submitted track(const Six& origin, const Six& object, MC_CoordSystem frame = mcPCS, FrameTrack::Kind kind = FrameTrack::Kind::belt,
                    MC_ExecutionMode mode = mcImmediately) {
        GroupCommand command{.kind = GroupCommandKind::track_frame, .frame = frame, .execution = mode};
        command.track.kind = kind;
        command.track.master = belt();
        command.track.origin = origin;
        command.track.object = object;
        Submitted answer;
        step([&] {
            reference = axes[last].config().encoder ? axis(last).actual_position : belt_at();
            answer = submit(command);
        });
        seen_origin = origin;
        seen_object = object;
        table = kind == FrameTrack::Kind::table;
        return answer;
    }
    /// The object now, by hand: origin * way of the belt * object.
    [[nodiscard]] HandFrame object_now(double feed = 360) const {
        const double way = belt_at() - reference;
        const Six moved = table ? Six{0, 0, 0, 0, 0, 2 * std::numbers::pi * way / feed} : Six{way, 0, 0, 0, 0, 0};
        return hand_frame(seen_origin) * hand_frame(moved) * hand_frame(seen_object);
    }
    /// Where the tool is on it, of the set-points that were given in this cycle.
    [[nodiscard]] std::array<double, 3> on_object(double feed = 360) const {
        HandFrame tool;
        const auto& set = view().tool_set;
        tool.o = {set[0], set[1], set[2]};
        return (back(object_now(feed)) * tool).o;
    }
    bool done(CommandId id, int most = 9000) {
        return until([&] { return status(id) != CommandStatus::active && status(id) != CommandStatus::queued; }, most) &&
               status(id) == CommandStatus::done;
    }

    std::size_t last;
    double reference = 0;
    Six seen_origin{}, seen_object{};
    bool table = false;
};

inline GroupCommand on_product(GroupCommand command, MC_CoordSystem frame = mcPCS) {
    command.frame = frame;
    return command;
}
inline void expect_place(const std::array<double, 3>& at, double x, double y, double z, double within = 1e-9) {
    EXPECT_NEAR(at[0], x, within);
    EXPECT_NEAR(at[1], y, within);
    EXPECT_NEAR(at[2], z, within);
}

}  // namespace taktwerk::axes::test
