#pragma once
// MC_MoveSuperimposed and MC_HaltSuperimposed: a motion of its own on top of the base, which keeps its command, its state and its times.
//
// The velocity is held down to what the axis' limit leaves beside the base; where the base uses all of it the superimposed motion waits.
// Where the base is to become faster than that, the superimposed motion slows down first: the sum never passes the limit. Ramps are on top
// of the base's (P1-155).

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

class GivenMotion;

class SuperimposedMotion {
public:
    SuperimposedMotion(AxisBody& body, AxisMotion& motion, const GivenMotion& given) noexcept
        : body_(body), motion_(motion), given_(given) {}

    /// u/s in `sense` that the superimposed motion cannot help having from here on: what its acceleration still brings while it runs out.
    [[nodiscard]] double reach(double sense) const noexcept;
    /// False: the planner refused.
    [[nodiscard]] bool run() noexcept;
    /// True: it is done.
    [[nodiscard]] bool complete() noexcept;
    /// Another command takes the axis, but the base goes on for now: a coupling may wait for its master. What moves on top of it comes to rest along
    /// its own ramps, and its way so far stays (P1-281: the former motion goes on).
    void abandon() noexcept;
    /// Nobody commands it any more, and it has not come to rest yet.
    [[nodiscard]] bool abandoned_moves() const noexcept;
    /// From here on there is one motion again. A goal must follow where it moves.
    void end(Outcome outcome, ErrorId error = ErrorId::none) noexcept;
    /// Takes the place of the one before.
    void begin(const AcceptedCommand& accepted) noexcept;

    static constexpr double least_speed = 1e-6;  ///< of the limit: as good as none
    static constexpr double room_grain = 1e-9;   ///< of the limit: rounding

    [[nodiscard]] bool pending() const noexcept { return superimposed_.pending; }
    [[nodiscard]] const AxisCommand& command() const noexcept { return superimposed_.accepted.command; }
    /// u/s3, which the present profile was planned with.
    [[nodiscard]] double jerk() const noexcept { return superimposed_.jerk; }
    /// u since its start.
    [[nodiscard]] double covered() const noexcept { return covered_; }
    void plan_anew() noexcept { superimposed_.pending = true; }
    void update(const AxisCommand& command) noexcept {
        superimposed_.accepted.command = command;
        superimposed_.distance = command.position;
        superimposed_.pending = true;
    }

private:
    [[nodiscard]] bool ramps_of_two() const noexcept;
    [[nodiscard]] double room_beside_base(double sense) const noexcept;
    [[nodiscard]] double wanted() const noexcept;
    [[nodiscard]] bool room_has_grown() const noexcept;
    [[nodiscard]] Plan plan_addition(const MotionState& part, const MotionLimits& limits) noexcept;

    AxisBody& body_;
    AxisMotion& motion_;
    const GivenMotion& given_;
    struct Superimposed {
        AcceptedCommand accepted;
        double distance = 0;   // u, since its start
        double covered = 0;    // u, before the present profile
        double jerk = 0;       // u/s3, which the present profile was planned with
        bool pending = false;  // has no profile yet, or one made for another base
        bool begun = false;
        bool waiting = false;  // the base uses the whole velocity limit in the sense that it needs
        double sense = 1;      // of the way that the present profile has to go, once it has braked
        double room = 0;       // u/s that the present profile may have in that sense
    };
    Superimposed superimposed_;
    double covered_ = 0;  // u, shown
};

}  // namespace taktwerk::axes
