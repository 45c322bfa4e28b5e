#pragma once
// The way that a group goes, on the cycle's side: where the members are now, and how the way ends. Its shape and its time come from the service side
// as committed stretches (docs/motion/path.md), each of which ends at rest on the way: override, halts and stops act on s alone, and take effect
// when the planner has answered. Real-time safe but for construction and service().
//
// A run is a path from rest to rest, through any number of commands that are blended; the next one is prepared meanwhile. A life is what follows a
// restart: the members stand, and what was planned before counts no more.

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "axes/group/group_config.hpp"
#include "axes/group/group_equipment.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_view.hpp"
#include "axes/planner/motion.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class PathShelf;
struct PathNote;
struct Pose;
struct ToolMotion;

class PathRun {
public:
    /// `config`: for its arm and workspace. `paths`: stored ones; nullptr: there are none.
    PathRun(std::span<Axis> axes, const AxisGroupConfig& config, Duration cycle, const PathShelf* paths);
    PathRun(PathRun&&) noexcept;
    ~PathRun();

    /// The planner's step. Service side: one thread, beside the cycle; not real-time.
    void service();

    /// The members stand where they are; whatever was on the way is forgotten. `factors` from now on. False: not now, ask again in the next cycle.
    /// `caps`: the members keep below these too, where they are above 0. `from`: not there, but where a frame that moves had them when its path was planned.
    bool restart(const GroupMembers& members, const Override& factors, const JoggingDynamics* caps = nullptr,
                 const JointVector* from = nullptr) noexcept;
    /// From the next restart on: u/s of the tool's point that nothing goes faster.
    void keep_tool_below(double velocity) noexcept;
    /// What was planned is inside the limits that the members have now.
    [[nodiscard]] bool fits(const GroupMembers& members) const noexcept;
    /// A way behind those that were sent before. `joins`: may be blended with the one before it. `dynamics`: without 0 where the group has defaults.
    /// False: not now.
    /// `pressed`: where a jog began, by place; `way`: of its path since then.
    bool send(CommandId id, const GroupCommand& command, const CommandPlace& place, const PathDynamics& dynamics, bool joins,
              const JointVector* pressed = nullptr, double way = 0) noexcept;
    /// What the planner has said of a command that will not be gone; none: there is no way to go. Nothing: it has not, or the way is there.
    [[nodiscard]] std::optional<PathPlace> verdict(CommandId id) const noexcept;
    /// Of a jog that had nothing to go: why.
    [[nodiscard]] JogEnd jog_end(CommandId id) const noexcept;
    /// Goes over to the way of this command if it is prepared. Asked for each cycle, at rest.
    [[nodiscard]] bool begin(CommandId id) noexcept;
    // Of a path that an axis drives (driven_run.cpp):
    /// PathDrive::refuse().
    [[nodiscard]] ErrorId refuse_driver(const PathDriver& driver, const GroupMembers& members) const noexcept;
    /// Each cycle, before advance(): where its master is.
    void watch(Instant now, Duration period) noexcept;
    [[nodiscard]] PathDriverView driver() const noexcept;
    /// It has begun to come to rest by itself: master_lost, path_limit. A fault() besides: it cannot do even that on the path.
    [[nodiscard]] ErrorId lets_go() const noexcept;

    // Of a stored path, which is gone in many runs:
    /// What is to be done now, before the set-point goes on; nullptr: nothing.
    [[nodiscard]] const PathNote* note() noexcept;
    /// It is done.
    void drop_note() noexcept;
    /// At rest at the end of a run, to the next one if it is prepared.
    void go_over(CommandId id) noexcept;
    /// The line of its text that is carried out, and the N word of that.
    [[nodiscard]] std::uint32_t line() const noexcept { return line_; }
    [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

    /// Nothing to run; the members stand.
    void clear() noexcept;

    /// One period on.
    void advance(Duration period) noexcept;

    /// Other factors, from the planner's next answer on. Where the way left is too short for less acceleration or jerk they wait until it is not (G-071).
    void override_with(const Override& factors) noexcept;
    /// Comes to rest on the way, at its end at the latest. `ramp`: deceleration and jerk, 0 = the limits'.
    void stop(const PathDynamics& ramp, const Override& factors) noexcept { stand(ramp, false, factors); }
    /// Comes to rest as its command says.
    void release(const Override& factors) noexcept { stand({}, true, factors); }
    /// After a stop: on to the end.
    void resume(const Override& factors) noexcept;

    [[nodiscard]] bool exists() const noexcept { return exists_; }
    /// At rest, and stays so by itself.
    [[nodiscard]] bool over() const noexcept;
    /// At rest where the way of command() ends.
    [[nodiscard]] bool arrived() const noexcept { return arrived_; }
    [[nodiscard]] bool stops() const noexcept { return stops_; }
    /// The reason why it has come to rest before the end and finds no way on, or none into the next run of a stored path; none: it has not.
    [[nodiscard]] ErrorId stuck() const noexcept;
    /// The set-point could not follow the way: out of reach, which the check before the start excludes. G-021
    [[nodiscard]] ErrorId fault() const noexcept { return fault_; }

    /// Whose way the set-point is on: from the middle of a blend on the later one's (G-061). 0: none.
    [[nodiscard]] CommandId command() const noexcept { return command_; }
    /// Of a periodic path that an axis drives: laps count.
    [[nodiscard]] const MotionState& along() const noexcept { return s_; }
    /// Of the path that along() is on: no two have the same.
    [[nodiscard]] std::uint64_t serial() const noexcept;
    [[nodiscard]] MotionState of(std::size_t place) const noexcept { return states_[place]; }
    /// Of a path of poses: how the tool's point goes it. False: it stands in front of it, or there is none.
    [[nodiscard]] bool see_tool(ToolMotion& motion) const noexcept;
    /// With what that is gone; only while command() is not 0.
    [[nodiscard]] const CarriedTool& carried() const noexcept { return carried_; }
    /// Where the way of command() ends.
    [[nodiscard]] const JointVector& end() const noexcept { return end_; }
    [[nodiscard]] double length() const noexcept { return length_; }
    /// How the joint in front of command() was passed.
    [[nodiscard]] CornerPassed corner() const noexcept { return corner_; }
    [[nodiscard]] double remaining() const noexcept { return remaining_; }
    /// s, of the stretch that runs; 0 where it does not lead to the end.
    [[nodiscard]] double remaining_time() const noexcept;
    /// GroupView::path_members.
    [[nodiscard]] std::uint16_t members_on_way() const noexcept { return members_on_way_; }
    [[nodiscard]] PathLimiter limiter() const noexcept { return limiter_; }
    [[nodiscard]] std::uint8_t narrowest() const noexcept { return narrowest_; }
    /// Plans that came after their place had been passed.
    [[nodiscard]] std::uint32_t late() const noexcept;

private:
    struct Inside;
    void tell() noexcept;
    void stand(const PathDynamics& ramp, bool own, const Override& factors) noexcept;
    void take_track() noexcept;
    void begin_driven() noexcept;
    void go_driven(Duration period) noexcept;
    [[nodiscard]] bool too_fast_ahead() const noexcept;
    [[nodiscard]] bool look_driven() noexcept;
    void find_part() noexcept;
    [[nodiscard]] bool at_end_of_run() const noexcept;
    void look() noexcept;
    void see_limits() noexcept;

    std::unique_ptr<Inside> inside_;
    std::array<MotionState, most_members> states_{};
    JointVector end_{};
    MotionState s_;
    CommandId command_ = 0;
    CarriedTool carried_{};
    std::uint32_t line_ = 0, number_ = 0;
    double length_ = 0, remaining_ = 0;
    bool exists_ = false, arrived_ = false;
    bool stops_ = false;  // the goal is rest, not the end
    ErrorId stuck_ = ErrorId::none, fault_ = ErrorId::none;
    std::uint32_t stuck_run_ = 0;
    CornerPassed corner_ = CornerPassed::none;
    PathLimiter limiter_ = PathLimiter::none;
    std::uint8_t narrowest_ = 0;
    std::uint16_t members_on_way_ = 0;
};

}  // namespace taktwerk::axes
