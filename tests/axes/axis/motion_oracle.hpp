#pragma once
// What must hold of every axis in every cycle, whatever was asked of it. One oracle for rigs, walks and campaigns: it knows no command, it
// looks at the view and at what the drive was told, and compares each with the cycle before.
//
//   place with velocity          what is left of the way when the mean velocity is taken off is bounded by acceleration and jerk
//   velocity with acceleration   likewise; never more than acceleration * period: a stop in one cycle is a breach
//   acceleration with jerk       where it is limited
//   drive with view              the target in counts is the set position, but for a rounding and what compensation adds
//   limits                       velocity, acceleration, jerk, software limits
//   stops                        from its first cycle on the velocity keeps its sign, and 0 stays 0, whoever stops the axis and whatever it did before
//   state with motion            Standstill stands and holds nothing; a command that waits for nothing begins
//
// Where it looks away, and why:
//   * the drive takes no set-point from here (no power, homing by itself, torque, its own profiles, a slow line): the set-point follows the motor
//   * tables over time have corners, and a slave keeps no jerk (docs/motion/decisions.md): there no jerk is asked for
//   * a slave held at its limits keeps its place within acceleration * period^2 / 2; a fed set-point within acceleration * period^2, and its
//     acceleration is the feeder's
//   * a stop's jerk may be as high as it takes not to reverse: a^2 / (2 |v|) while v and a differ in sign. What takes no cycle longer than it lasts
//     (2 |v| / |a|) may come to rest at once
//   * of an addition that is halted, or of the base that stops beside one, the view does not say how fast it is: there no jerk is asked for
//   * while something is superimposed the sum may change its sign in a stop: the addition is a motion of its own
//   * while something is superimposed, and after it was given up until the axis rests, ramps add up: twice acceleration and jerk (clause 155 of Part 1)
//   * coordinates may change (homing, MC_SetPosition) where the drive sees nothing of it and the actual position changes alike; where it comes
//     with the first feedback after a gap, by what the axis was told meanwhile as well
//   * a software limit that comes over a moving axis, or is moved with its coordinates, holds once the axis has rested

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/axis/parameters.hpp"
#include "axes/axis/state_machine.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::test {

class MotionOracle {
public:
    /// `config` as configured: limits of the system. `settling`: how long the drive shows a mode before it gets set-points in it.
    MotionOracle(const AxisConfig& config, Duration cycle, Duration settling = {})
        : config_(config), period_(to_seconds(cycle)), settling_(2 + settling / cycle) {
        counts_ = config.gearing.counts_per_unit();
        double slope = 0;
        const auto& pitch = config.compensation.pitch;
        for (std::size_t i = 1; i < pitch.size(); ++i)
            slope =
                std::max(slope, std::abs((pitch[i].correction - pitch[i - 1].correction) / (pitch[i].position - pitch[i - 1].position)));
        pitch_slope_ = slope;
        compensates_ = config.compensation.backlash > 0 || !pitch.empty();
    }

    /// After encode(). `now`: the limits that hold at present, as parameters have made them.
    void observe(const AxisView& view, const DriveCommand& command, const AxisLimits& now) {
        told_ = tells_velocity_ = true;
        look(view, command, now);
    }
    /// Where what the drive is told cannot be seen beside the view (behind a bus: tests/runtime/drive_oracle.hpp).
    void observe(const AxisView& view) {
        told_ = tells_velocity_ = false;
        DriveCommand unseen;
        unseen.power = view.state != AxisState::Disabled ? PowerRequest::on : PowerRequest::off;
        unseen.mode = view.state == AxisState::Homing && !view.homing_procedure && config_.homing.kind == HomingKind::drive
                          ? DriveMode::homing
                          : view.drive_mode;
        look(view, unseen, shown_limits(view));
    }

    /// `command` was read back from process data, which has a position in modes of position only; of the limits what the view shows.
    void observe(const AxisView& view, const DriveCommand& command) {
        told_ = command.mode != DriveMode::cyclic_velocity;
        tells_velocity_ = true;
        look(view, command, shown_limits(view));
    }
    /// How coarse a velocity is told [counts/s]; without it to the last digit.
    void velocity_grain(double grain) { velocity_grain_ = grain; }

    [[nodiscard]] bool clean() const { return breaches_ == 0; }
    [[nodiscard]] const std::string& report() const { return report_; }
    /// Cycles in which place, velocity and acceleration were compared: the positive control.
    [[nodiscard]] long compared() const { return compared_; }
    [[nodiscard]] long cycles() const { return cycle_; }
    /// The newest cycle was compared, and its coordinates are those of the cycle before.
    [[nodiscard]] bool continues() const { return continues_; }
    /// From here on nothing is said any more; for what a test does to an axis from outside, with the reason.
    void look_away(const char* reason) { away_ = reason; }

private:
    [[nodiscard]] AxisLimits shown_limits(const AxisView& view) const {
        auto limits = config_.limits;
        limits.position_min = view.parameters[place_of(enable_limit_negative)] != 0 ? view.parameters[place_of(software_limit_negative)]
                                                                                    : -std::numeric_limits<double>::infinity();
        limits.position_max = view.parameters[place_of(enable_limit_positive)] != 0 ? view.parameters[place_of(software_limit_positive)]
                                                                                    : std::numeric_limits<double>::infinity();
        return limits;
    }
    void look(const AxisView& view, const DriveCommand& command, const AxisLimits& now) {
        ++cycle_;
        Sample next;
        next.at = {view.set_position + static_cast<double>(view.turns) * view.modulo, view.set_velocity, view.set_acceleration};
        next.actual = view.actual_position;
        next.counts = command.position;
        next.state = view.state;
        next.kind = view.active_kind;
        next.stops = stops(view);
        next.covered = view.superimposed_covered;
        next.layer = view.side[static_cast<std::size_t>(SideSlot::superimposed)];
        next.homed = view.homed;
        next.modulo = view.modulo;
        next.driven = takes_setpoints(view, command);
        check_state(view, next.driven);
        if (next.driven && tells_velocity_) check_told(view, command);
        continues_ = false;
        if (seen_ && last_.driven && next.driven) {
            check_motion(view, next, now);
        } else {
            summed_ = false;
            most_ = now.velocity_towards(1);
            most_backwards_ = now.velocity_towards(-1);
            unseen_ = 0;
            loose_ = true;
        }
        last_ = next;
        seen_ = true;
    }

    struct Place {
        double position = 0, velocity = 0, acceleration = 0;
    };
    struct Sample {
        Place at;
        double actual = 0, modulo = 0, covered = 0;
        std::int64_t counts = 0;
        AxisState state = AxisState::Disabled;
        CommandKind kind = CommandKind::none;
        CommandId layer = 0;  // the superimposed command
        bool driven = false, homed = false, stops = false;
    };

    template <class... Args>
    void breach(fmt::format_string<Args...> text, Args&&... args) {
        if (away_) return;
        if (++breaches_ > 5) return;
        report_ += fmt::format("cycle {}, axis {} {} ({}): ", cycle_, config_.name, name(last_.state), static_cast<int>(last_.kind));
        report_ += fmt::format(text, std::forward<Args>(args)...);
        report_ += '\n';
    }

    [[nodiscard]] bool takes_setpoints(const AxisView& view, const DriveCommand& command) {
        const bool cyclic = command.mode == DriveMode::cyclic_position || command.mode == DriveMode::cyclic_velocity;
        const bool takes = !config_.encoder && view.drive_state == PowerState::enabled && cyclic && view.drive_mode == command.mode &&
                           (command.power == PowerRequest::on || last_.driven);
        steady_ = takes ? steady_ + 1 : 0;
        return steady_ > settling_;
    }

    void check_state(const AxisView& view, bool driven) {
        // In torque mode without a command the set-point follows a motor that may be pushed.
        const bool still = view.set_velocity == 0 && view.set_acceleration == 0;
        const bool rests = still || !driven;
        const bool layered = view.side[static_cast<std::size_t>(SideSlot::superimposed)] != 0;
        if (view.state == AxisState::Standstill && !(rests && view.active == 0 && view.queued_count == 0 && !layered))
            breach("stands still with velocity {}, active {}, {} waiting, superimposed {}", view.set_velocity, view.active,
                   view.queued_count, layered);
        if (view.state == AxisState::Disabled && !(rests && view.active == 0 && !layered))  // while power comes up commands may wait
            breach("is disabled with velocity {}, active {}, superimposed {}", view.set_velocity, view.active, layered);
        if ((view.state == AxisState::ErrorStop) != (view.error != 0)) breach("is in {} with error {}", name(view.state), view.error);
        if (view.state != AxisState::Disabled && view.state != AxisState::ErrorStop && !view.powered && view.online)
            breach("is in {} without power", name(view.state));
        // What waits for nothing begins: commands wait behind nobody only for power, and while the axis brakes.
        const bool nobody = view.active == 0 && view.lock == 0;
        const bool brakes = !still && (view.limiter == VelocityLimiter::stopping || view.state == AxisState::Stopping);
        const bool awaited = view.state == AxisState::Disabled || brakes || layered;
        abandoned_ = nobody && view.queued_count > 0 && !awaited ? abandoned_ + 1 : 0;
        if (abandoned_ == patience) breach("{} commands wait behind nobody", view.queued_count);
        const bool busy = view.state == AxisState::DiscreteMotion || view.state == AxisState::Stopping;
        done_ = busy && nobody && !layered && still && driven ? done_ + 1 : 0;
        if (done_ == patience) breach("is in {} although it stands and nothing is commanded", name(view.state));
        for (const double value : {view.set_position, view.set_velocity, view.set_acceleration})
            if (!std::isfinite(value)) breach("has a set value {}", value);
        if (view.modulo > 0 && !(view.set_position >= 0 && view.set_position < view.modulo))
            breach("shows position {} in a modulo of {}", view.set_position, view.modulo);
    }

    /// The other values that go to the drive with its position.
    void check_told(const AxisView& view, const DriveCommand& command) {
        const auto& control = config_.control;
        const double grain = velocity_grain_ + 1e-9 * config_.limits.velocity * std::abs(counts_);
        if (command.mode == DriveMode::cyclic_position) {
            const double velocity = control.feed_forward * view.set_velocity * counts_;
            if (std::abs(command.velocity - velocity) > grain)
                breach("tells the drive {} counts/s beside its position, the view {} u/s", command.velocity, view.set_velocity);
            return;
        }
        const double limit = (control.output_limit > 0 ? control.output_limit : 1.2 * config_.limits.velocity) * std::abs(counts_);
        const double open = control.feed_forward * view.set_velocity * counts_;
        const double closed = std::clamp(open + control.kv * view.following_error * counts_, -limit, limit);
        // An I part adds no more than its limit.
        const auto& integral = control.integral;
        const double added = integral.used() ? (integral.limit > 0 ? integral.limit : config_.limits.velocity / 10) * std::abs(counts_) : 0;
        // The loop is open without feedback, and from the command on that takes the axis into another mode.
        const bool may_be_open = !view.online || changes_mode(view.active_kind) || changes_mode(last_.kind) || last_.state != view.state;
        if (std::abs(command.velocity - closed) > grain + added && !(may_be_open && std::abs(command.velocity - open) <= grain))
            breach("tells the drive {} counts/s; feed-forward and loop make {}", command.velocity, closed);
    }

    void check_motion(const AxisView& view, const Sample& next, const AxisLimits& now) {
        ++compared_;
        const auto& a = last_.at;
        const auto& b = next.at;
        const bool stopping = either(last_, next, AxisState::Stopping) || either(last_, next, AxisState::ErrorStop);
        const auto& system = config_.limits;
        if (last_.layer != 0 && next.layer == 0 && view.status(last_.layer) != CommandStatus::done) summed_ = true;
        const bool layered = last_.layer != 0 || next.layer != 0 || summed_;
        double most_slowing = system.deceleration;
        double most_jerk = system.jerk;
        if (stopping) {
            most_slowing = std::max(most_slowing, system.stop_deceleration);
            most_jerk = std::max(most_jerk, system.stop_jerk);
        }
        // Which of the two holds says the velocity, as long as there is one motion and it keeps its sense.
        const double least = 1e-9 * system.velocity;
        const bool either_way = layered || a.velocity * b.velocity <= 0 || std::abs(a.velocity) <= least || std::abs(b.velocity) <= least;
        const double most_acceleration = std::max(system.acceleration, most_slowing) * (layered ? 2 : 1);
        // Limits of one direction hold for one motion, but for a stop that is harder than the axis itself.
        const double speeding = system.acceleration_towards(b.velocity);
        const double slowing = most_slowing > system.deceleration ? most_slowing : system.deceleration_towards(b.velocity);
        const auto most_of = [&](bool faster) {
            return std::max(either_way ? most_acceleration : faster ? speeding : slowing, std::abs(a.acceleration));
        };
        most_jerk *= layered ? 2 : 1;
        constexpr double rounding = 1 + 1e-6;
        const double T = period_;
        bool rests_now = false;
        const bool rests = b.velocity == 0 && b.acceleration == 0;
        // What begins and ends in one cycle shows no limiter: by what may have been a stop, as that in front of another mode of the drive.
        const bool stops = next.stops || last_.stops ||
                           (rests && (view.active == 0 || overridden_to_rest(view) || runs_at_velocity(next.kind) ||
                                      changes_mode(next.kind) || next.kind == CommandKind::halt));
        if (stops && a.velocity * a.acceleration <= 0) {
            rests_now = rests && 2 * std::abs(a.velocity) <= std::abs(a.acceleration) * T * rounding;
            if (a.velocity != 0) most_jerk = std::max(most_jerk, a.acceleration * a.acceleration / (2 * std::abs(a.velocity)));
        }
        const bool fed = last_.kind == CommandKind::external || next.kind == CommandKind::external;
        const bool coupled = either(last_, next, AxisState::SynchronizedMotion);
        const bool by_table = is_table(last_.kind) || is_table(next.kind);
        // How fast an addition is, the view says by its way; of one that is halted it does not, nor of the base beside it.
        const bool beside = last_.layer != 0 || next.layer != 0;
        // In the cycle in which the base comes to rest the view shows no limiter any more, nor its command, which may have had one cycle to stop in.
        const bool base_ends = last_.stops || (last_.kind != CommandKind::none && next.kind == CommandKind::none);
        // One that was halted in the scan in which it came has covered nothing, whatever the one before it had.
        const bool never_moved = next.layer != last_.layer && next.covered == 0;
        const bool addition_stops = beside && (next.stops || base_ends || next.covered == last_.covered || never_moved);
        const bool jerked = std::isfinite(most_jerk) && !fed && !coupled && !by_table && !rests_now && !addition_stops;
        const double speed_grain = 1e-9 * system.velocity;

        // Acceleration and jerk.
        const double bound = std::max(most_acceleration, std::abs(a.acceleration));
        const double most_now = most_of(b.acceleration * b.velocity > 0);
        if (!fed && std::abs(b.acceleration) > most_now * rounding)
            breach("accelerates with {} u/s2 at {} u/s, {} before; {} is the most", b.acceleration, b.velocity, a.acceleration, most_now);
        if (jerked && std::abs(b.acceleration - a.acceleration) > most_jerk * T * rounding + 1e-9 * most_acceleration)
            breach("acceleration {} after {} u/s2 in a cycle; the jerk {} allows {}; {} after {} u/s", b.acceleration, a.acceleration,
                   most_jerk, most_jerk * T, b.velocity, a.velocity);

        // A stop turns nothing round and begins no motion.
        if (next.stops && !beside && std::abs(b.velocity) > speed_grain && a.velocity * b.velocity <= 0)
            breach("runs at {} after {} u/s ({} u/s2) while it stops", b.velocity, a.velocity, a.acceleration);

        // Velocity with acceleration.
        const double change = b.velocity - a.velocity;
        const double most_change = fed ? most_acceleration : most_of(std::abs(b.velocity) > std::abs(a.velocity));
        if (std::abs(change) > most_change * T * rounding + speed_grain)
            breach("velocity {} after {} u/s in a cycle; the acceleration {} allows {}", b.velocity, a.velocity, most_change,
                   most_change * T);
        else if (jerked && std::abs(change - (a.acceleration + b.acceleration) / 2 * T) > most_jerk * T * T / 4 * rounding + speed_grain)
            breach("velocity {} after {} u/s does not agree with accelerations {} and {}", b.velocity, a.velocity, a.acceleration,
                   b.acceleration);
        // Also of base and addition together, whatever either is about to do.
        double& most = b.velocity < 0 ? most_backwards_ : most_;
        most = std::max(most, now.velocity_towards(b.velocity));
        const double before = a.velocity * b.velocity >= 0 ? std::abs(a.velocity) : 0;
        if (std::abs(b.velocity) > std::max(most, before) * (1 + 1e-8)) breach("runs at {} u/s; {} is the most", b.velocity, most);

        // Place with velocity: at the drive, and in the view as long as its coordinates are the same.
        const double mean = (a.velocity + b.velocity) / 2 * T;
        double left = bound * T * T / 4;
        double correction = 0;
        if (fed) left = most_acceleration * T * T;
        else if (coupled) left = bound * T * T / 2;
        else if (jerked) {
            // The trapezoid with its end correction: what the jerk can add is 1/2 * integral |t (T - t) - T^2 / 6|, times itself.
            correction = -(b.acceleration - a.acceleration) * T * T / 12;
            left = 0.0321 * most_jerk * T * T * T;
        }
        // The last digits: of the place, and of where a modulo axis counts from.
        const double grain = 1e-12 * (1 + std::abs(b.position) + std::abs(a.position)) +
                             (next.modulo > 0 ? 4e-13 * (next.modulo + 1024 * config_.gearing.feed) : 0);
        const double expected = mean + correction;
        const double told = static_cast<double>(next.counts - last_.counts) / counts_;
        double told_grain = 1.01 / std::abs(counts_);
        if (compensates_) told_grain += 2 * config_.compensation.velocity * T + pitch_slope_ * std::abs(expected) * 1.5;
        if (told_ && std::abs(told - expected) > left * rounding + told_grain + grain)
            breach("the drive is told a way of {} u at a set velocity of {} after {} u/s", told, b.velocity, a.velocity);
        const double way = b.position - a.position;
        // Before and after at rest, with the drive told nothing new: more than a rounding is other coordinates then, however little it is.
        const bool untouched = rests && a.velocity == 0 && a.acceleration == 0 && told_ && told == 0;
        // So is less, where the actual position has changed by just that: a reference found again, a count beside the one before.
        const bool alike_to_the_digit =
            untouched && std::abs(way) > 8 * grain && std::abs(modulo_of(next.actual - last_.actual - way, next.modulo)) <= 4 * grain;
        // And beside a motor that comes to rest in the very cycle in which its reference is found, by a count as well.
        const bool referenced = untouched && std::abs(way) > grain && next.homed && !last_.homed;
        const bool rested = untouched && (std::abs(way) > told_grain + grain || alike_to_the_digit || referenced);
        const bool follows = std::abs(way - expected) <= left * rounding + grain && !rested;
        bool renumbered = false;
        double shown = next.actual - last_.actual;  // what the motor did, as far as anybody saw
        if (!follows) {
            const double shift = way - expected;
            // An actual value that was missing comes with the way that the axis was told meanwhile.
            const double late = shown != 0 ? unseen_ : 0;
            shown = modulo_of(shown - shift, next.modulo);
            const double moved = shown - std::clamp(shown, std::min(late, 0.0), std::max(late, 0.0));
            // A way that a motor makes anyway proves nothing of a shift that is shorter: at rest it has to be nearly the whole of what the motor did.
            const bool alike =
                rested && std::abs(shift) <= 2 * system.velocity * T
                    ? std::abs(moved) <= std::max(std::abs(modulo_of(next.actual - last_.actual, next.modulo)), referenced ? told_grain : 0)
                    : std::abs(moved) <= 2 * system.velocity * T + told_grain;
            renumbered = (std::abs(shift) > told_grain || alike_to_the_digit || referenced) && alike &&
                         (!told_ || std::abs(told - expected) <= left * rounding + told_grain + grain);
            // Not again and again: that is a view that stands still while the drive is led on.
            again_ = renumbered ? again_ + 1 : 0;
            if (!renumbered || again_ == 4)
                breach("set position {} after {} u: a way of {} at a set velocity of {} after {} u/s, off by {}", b.position, a.position,
                       way, b.velocity, a.velocity, way - expected);
        } else again_ = 0;
        unseen_ = std::abs(shown) <= grain ? unseen_ + expected : 0;
        // Drive with view: the same place ever since, but for the rounding to counts.
        if (!compensates_ && told_) {
            const double offset = b.position - static_cast<double>(next.counts) / counts_;
            if (renumbered || loose_) lowest_ = highest_ = offset;
            lowest_ = std::min(lowest_, offset);
            highest_ = std::max(highest_, offset);
            if (highest_ - lowest_ > (1.01 / std::abs(counts_)) + 4 * grain) {
                breach("view and drive differ by {} u more than once", highest_ - lowest_);
                lowest_ = highest_ = offset;
            }
        }
        check_software_limits(view, next, now, renumbered);
        continues_ = !renumbered;
        loose_ = false;
        if (rests && next.layer == 0) {
            summed_ = false;
            most_ = now.velocity_towards(1);
            most_backwards_ = now.velocity_towards(-1);
        }
    }

    void check_software_limits(const AxisView& view, const Sample& next, const AxisLimits& now, bool renumbered) {
        const bool hold = view.homed && view.modulo == 0;
        const bool rests = next.at.velocity == 0 && next.at.acceleration == 0;
        const bool other = now.position_min != low_ || now.position_max != high_ || renumbered || last_.homed != next.homed || loose_;
        low_ = now.position_min;
        high_ = now.position_max;
        const bool moved_until_now = excused_;
        if (either(last_, next, AxisState::Homing) || !hold || (other && !rests)) excused_ = true;
        else if (rests) excused_ = false;
        if (moved_until_now || excused_ || !hold || renumbered) return;  // another number is no way
        constexpr double grain = 1e-9;
        const bool above = next.at.position > high_ + grain && next.at.position > last_.at.position;
        const bool below = next.at.position < low_ - grain && next.at.position < last_.at.position;
        if (above || below) breach("is at {} u, beyond its software limits {} to {}", next.at.position, low_, high_);
    }

    [[nodiscard]] static bool either(const Sample& a, const Sample& b, AxisState state) { return a.state == state || b.state == state; }
    [[nodiscard]] static bool runs_at_velocity(CommandKind kind) { return kind == CommandKind::move_velocity || kind == CommandKind::jog; }
    /// Less than this share is none (Override), also where it is the product of both factors.
    [[nodiscard]] static bool overridden_to_rest(const AxisView& view) {
        return view.override_factors.velocity * view.operators_override < 1e-9;
    }
    [[nodiscard]] static bool stops(const AxisView& view) {
        const bool held = view.limiter == VelocityLimiter::override_factor && overridden_to_rest(view);
        return held || view.limiter == VelocityLimiter::stopping || view.state == AxisState::Stopping || view.state == AxisState::ErrorStop;
    }
    [[nodiscard]] static bool changes_mode(CommandKind kind) {
        return kind == CommandKind::torque || kind == CommandKind::set_controller_mode || kind >= CommandKind::drive_move_absolute;
    }
    [[nodiscard]] static bool is_table(CommandKind kind) {
        return kind == CommandKind::position_profile || kind == CommandKind::velocity_profile || kind == CommandKind::acceleration_profile;
    }
    [[nodiscard]] static double modulo_of(double way, double modulo) { return modulo > 0 ? way - modulo * std::round(way / modulo) : way; }

    static constexpr int patience = 20;  // cycles

    AxisConfig config_;
    double period_;
    long settling_;
    double counts_ = 1, pitch_slope_ = 0, velocity_grain_ = 0;
    bool compensates_ = false;

    Sample last_;
    bool seen_ = false, told_ = true, tells_velocity_ = true, continues_ = false;
    bool loose_ = true;  // the drive has just begun to take set-points
    bool summed_ = false, excused_ = true;
    double most_ = 0, most_backwards_ = 0;  // u/s, the greatest velocity limit of each direction since the axis rested
    double low_ = 0, high_ = 0, lowest_ = 0, highest_ = 0;
    double unseen_ = 0;  // u that the axis was told since its actual position changed last
    long steady_ = 0;
    int abandoned_ = 0, done_ = 0, again_ = 0;

    long cycle_ = 0, compared_ = 0;
    long breaches_ = 0;
    const char* away_ = nullptr;
    std::string report_;
};

}  // namespace taktwerk::axes::test
