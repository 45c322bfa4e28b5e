#pragma once
// The service side of a group: makes paths of its commands, joins them, and keeps the cycle supplied with committed stretches. Steps; never waits.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "axes/group/move_shape.hpp"
#include "axes/group/run_curve.hpp"
#include "axes/path_time/path_service.hpp"

namespace taktwerk::axes {

class GroupPlanner {
public:
    /// `lead` [s]: how soon a plan made now can be in the cycle.
    GroupPlanner(GroupLink& link, const Kinematics* arm, double lead) : link_(link), arm_(arm), lead_(lead) {}

    void step();

private:
    struct Run {
        Run(const MoveSpace& space, RunTrack& on, double lead)
            : curve(space.arm, space.members, space.limits),
              service({curve.axis_limits().begin(), curve.axis_limits().end()}, on.exchange, lead),
              track(on) {}
        RunCurve curve;
        PathService service;
        RunTrack& track;
        std::uint32_t first = 0;
        bool open = true;      // a later move may join
        bool offered = false;  // its first stretch
        bool said_stuck = false;
        bool rolls = false;           // a jog: planned as far as it goes soon
        std::uint32_t published = 0;  // parts in front of it are the track's
        double final_end = 0;
    };

    void take(const GroupOrder& order);
    void restart(const GroupOrder& order);
    void place_moves();
    [[nodiscard]] bool place(const GroupOrder& move, const MoveShape& shape);
    [[nodiscard]] bool append(Run& run, const GroupOrder& move, const MoveShape& shape, bool blended);
    [[nodiscard]] BlendRequest blend_of(const Run& run, const GroupOrder& move, const MoveShape& shape) const;
    void feed(Run& run);
    [[nodiscard]] double final_end(const Run& run) const;
    [[nodiscard]] double rolling_end(const Run& run) const;
    void publish(Run& run);
    void say(CommandId id, ErrorId error, bool standing = false);
    [[nodiscard]] Run* last() noexcept { return next_ == 0 ? nullptr : runs_[(next_ - 1) % 2].get(); }

    GroupLink& link_;
    const Kinematics* arm_;
    double lead_;
    std::uint32_t life_ = 0;
    std::uint32_t next_ = 0;  // number of the next run in this life
    std::array<std::unique_ptr<Run>, 2> runs_{};
    std::deque<GroupOrder> moves_;    // not placed yet
    std::optional<MoveShape> first_;  // of the first of them
    MoveEnd end_;
    MoveSpace space_;
    GroupOrder wish_;
    std::uint32_t revision_ = 0;
};

}  // namespace taktwerk::axes
