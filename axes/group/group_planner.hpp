#pragma once
// The service side of a group: makes paths of its commands, joins them, and keeps the cycle supplied with committed stretches. Steps; never waits.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "axes/group/mixed_corner.hpp"
#include "axes/group/move_shape.hpp"
#include "axes/group/path_segment.hpp"
#include "axes/group/path_shelf.hpp"
#include "axes/group/run_curve.hpp"
#include "axes/path_time/path_service.hpp"

namespace taktwerk::axes {

class GroupPlanner {
public:
    /// `lead` [s]: how soon a plan made now can be in the cycle.
    /// `space`: arm and workspace; members and limits come with a restart. `paths`: the stored ones; nullptr: there are none. `millimetre`: in u.
    GroupPlanner(GroupLink& link, const MoveSpace& space, double lead, const PathShelf* paths, double millimetre)
        : link_(link), lead_(lead), space_(space), paths_(paths), millimetre_(millimetre) {}

    void step();

private:
    struct Run {
        Run(const MoveSpace& space, RunTrack& on, double lead)
            : curve(space.arm, space.members, space.limits, space.tool_velocity), track(on) {
            plan_anew(lead);
        }
        void plan_anew(double lead) {
            service.emplace(std::vector<PathAxisLimits>{curve.axis_limits().begin(), curve.axis_limits().end()}, track.exchange, lead);
        }
        RunCurve curve;
        std::optional<PathService> service;
        RunTrack& track;
        std::uint32_t first = 0;
        std::uint32_t number = 0;  // of this run in its life, from 1
        bool pulled = false;       // of a stored path: what comes behind does not depend on the time
        bool open = true;          // a later move may join
        bool offered = false;      // its first stretch
        bool said_stuck = false;
        bool rolls = false;           // a jog: planned as far as it goes soon
        bool driven = false;          // by an axis: nothing is planned
        std::uint32_t published = 0;  // parts in front of it are the track's
        double final_end = 0;
    };

    /// A stored path that is being pulled.
    struct Walk {
        CommandId id = 0;
        std::unique_ptr<PathSource> source;
        PathItem item;
        bool pending = false;  // the item is not placed yet
        std::optional<MoveShape> shape;
        SegmentPlace place;
        PathItem::Joint joint = PathItem::Joint::stop;  // of the piece before
        double deviation = 0;
        bool resting = true;  // the next piece begins from rest
        bool full = false;    // until there is room for many
        bool laid = false;    // of a driven path: it has a run
        MoveEnd began;        // where it begins
    };

    void take(const GroupOrder& order);
    void restart(const GroupOrder& order);
    void place_moves();
    [[nodiscard]] bool place(const GroupOrder& move, const MoveShape& shape);
    [[nodiscard]] bool append(Run& run, const GroupOrder& move, const MoveShape& shape, bool blended);
    /// Behind a path of the other kind of points.
    [[nodiscard]] bool append_mixed(Run& run, const GroupOrder& move, const MoveShape& shape);
    [[nodiscard]] MixedRequest mixed_request_of(const Run& run, const GroupOrder& move, const MoveShape& shape) const;
    [[nodiscard]] bool has_room(const Run& run) const noexcept;
    /// The last two sections of the run, where a curve leads to this move; the last one.
    [[nodiscard]] RunCurve::Seen corner_of(const Run& run, const GroupOrder& move, const MoveShape& shape, CornerPassed passed) const;
    [[nodiscard]] RunCurve::Seen section_of(const Run& run, const GroupOrder& move, const MoveShape& shape, CornerPassed passed) const;
    [[nodiscard]] BlendRequest blend_of(const Run& run, const GroupOrder& move, const MoveShape& shape) const;
    void feed(Run& run);
    void take_back(Run& run);
    /// True: all of it is placed.
    [[nodiscard]] bool walk(const GroupOrder& move);
    // Of a path that an axis drives, which is laid out as a whole: path_lay.cpp. True: it is, or will not be.
    [[nodiscard]] bool lay(const GroupOrder& move);
    [[nodiscard]] ErrorId lay_piece(const GroupOrder& move, const MoveShape& shape);
    bool refuse_laid(const GroupOrder& move, ErrorId error, const PathHindrance& at = {});
    bool lay_done(const GroupOrder& move);
    void look_ahead(Run& run, MC_PATH_SYNC_MODE mode) const;
    [[nodiscard]] GroupOrder piece_of(const GroupOrder& move) const;
    /// A track for a run that begins with this move; nullptr: none is free yet.
    [[nodiscard]] Run* claim(const GroupOrder& move);
    void open_path(const GroupOrder& move);
    /// False: not now.
    [[nodiscard]] bool place_piece(const GroupOrder& move);
    [[nodiscard]] bool note();
    [[nodiscard]] std::size_t room() const noexcept;
    [[nodiscard]] double final_end(const Run& run) const;
    [[nodiscard]] double rolling_end(const Run& run) const;
    void publish(Run& run);
    void say(CommandId id, ErrorId error) { (void)link_.verdicts.try_push({life_, id, error}); }
    void say_stuck(Run& run);
    [[nodiscard]] Run* last() const noexcept { return next_ == 0 ? nullptr : runs_[(next_ - 1) % 2].get(); }

    GroupLink& link_;
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
    const PathShelf* paths_;
    double millimetre_;
    std::unique_ptr<Walk> walk_;
};

}  // namespace taktwerk::axes
