#pragma once
// How the axis gets into and out of ErrorStop, Stopping and Disabled, and what a stop ends.

#include "axes/axis/alarms.hpp"
#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/state_machine.hpp"

namespace taktwerk::axes {

class Aim;
class BaseMotion;
class SuperimposedMotion;

class Conduct {
public:
    Conduct(AxisBody& body, AxisMotion& motion, SuperimposedMotion& addition, Aim& aim, BaseMotion& base, HomingRuns& runs) noexcept
        : body_(body), motion_(motion), addition_(addition), aim_(aim), base_(base), runs_(runs) {}

    [[nodiscard]] bool moves() const noexcept;
    void fire(AxisEvent event) noexcept;
    void fail(AxisAlarm alarm, double a = 0, double b = 0) noexcept;
    /// One that is only shown, where a milder reaction is chosen, goes with its cause.
    void warning_is_over(AxisAlarm alarm) noexcept {
        if (body_.config.reactions.chosen(alarm) == ErrorReaction::warn) body_.alarms.clear(alarm);
    }
    /// True: it stops now.
    [[nodiscard]] bool stop_for_error(AlarmId reason, bool then_power_off) noexcept;
    void stop_on_own_account(bool then_power_off) noexcept;
    /// A command could not go on, which is an error of its instance and none of the axis: it comes to rest as by MC_Halt, and may be moved again at
    /// once. Stopping is for MC_Stop (figure 2), for power that goes, and for a change of hands.
    void halt_on_own_account() noexcept;
    void shut_down() noexcept;
    /// True: what waits behind the stop has its turn.
    [[nodiscard]] bool leave_stopping() noexcept;
    void run_goal(double late) noexcept;
    /// The active command cannot go on; the axis comes to rest.
    void end_with(ErrorId error) noexcept;
    /// Holds in each cycle in which somebody demands it.
    void obey_emergency() noexcept;
    /// What a command that does not wait takes the place of.
    void give_way(const AxisCommand& command) noexcept;
    /// The new owner has the axis at once, but it stops before it takes motion.
    void change_hands(Owner owner) noexcept;

    [[nodiscard]] ErrorId reset_error() const noexcept { return reset_error_; }
    void reset_error(ErrorId error) noexcept { reset_error_ = error; }
    [[nodiscard]] bool off_after_error() const noexcept { return off_after_error_; }
    /// Its errors since it was reset took the power at once, ...
    [[nodiscard]] bool off_at_once() const noexcept { return hardest_ == ErrorReaction::power_off; }
    /// ... or made the drive stop it.
    [[nodiscard]] bool drive_stops() const noexcept { return hardest_ == ErrorReaction::quick_stop; }
    void error_is_over() noexcept {
        off_after_error_ = false;
        hardest_ = ErrorReaction::by_table;
    }
    [[nodiscard]] bool off_when_stopped() const noexcept { return off_when_stopped_; }
    [[nodiscard]] bool power_dropping() const noexcept { return power_dropping_; }
    void power_is_off() noexcept { power_dropping_ = false; }

private:
    void enter_error_stop(AlarmId reason, ErrorReaction how) noexcept;
    void switch_off() noexcept;

    AxisBody& body_;
    AxisMotion& motion_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    BaseMotion& base_;
    HomingRuns& runs_;

    bool off_when_stopped_ = false;                    // Stopping on the way to Disabled
    bool power_dropping_ = false;                      // Disabled, but the drive has not let go yet
    bool off_after_error_ = false;                     // ErrorStop whose reaction is power off
    ErrorReaction hardest_ = ErrorReaction::by_table;  // of the errors since the last reset
    ErrorId reset_error_ = ErrorId::none;              // what the last reset came to
};

}  // namespace taktwerk::axes
