#pragma once
// What must hold of a slave that catches up with its master, in every cycle from MC_GearIn to InGear. It knows neither follower nor planner: it sees
// how the slave moves and what its gear asks for.
//
//   sense      while the master keeps its sense, the slave that has it too, or rests, never runs against it
//   range      it leaves the velocities met since the command (its own at the start, the gear's ever since) only
//                * while it takes away, with all of its jerk, the acceleration that leads it further out, or
//                * towards a gear that is on its way there: would be there, went it on like that, in the time that the slave needs
//   limits     acceleration, deceleration and jerk are those of the command; the master's own change of acceleration is no jerk of the slave's
//
// Where it looks away, and why:
//   * what the slave brings along from its former motion: an acceleration beyond the command's until it is inside, and the way in which it is lost; a jerk
//     as high as it takes to lose it before the velocity is 0, or the limit (axes/axis/stop_ramp.hpp)
//   * of a measured master what its filter adds: noise, and the overshoot of a place that is extrapolated over a corner. Never in the other sense

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "axes/planner/motion.hpp"

namespace taktwerk::axes::test {

class GearOracle {
public:
    /// u/s, u/s2. Of a master: times the ratio.
    struct Motion {
        double velocity = 0, acceleration = 0;
    };
    /// Of a measured master, times the ratio.
    struct Measured {
        double noise = 0;          ///< u/s
        double overshoot = 0;      ///< share of a change of velocity by which the filter goes too far
        double unrest = 0;         ///< share of a change of velocity by which the filter's acceleration changes in a cycle, 1/s
        double low = 0, high = 0;  ///< velocities that the filter may still answer to at the command, u/s
    };

    /// `limits`: of the command, its velocity the axis'.
    GearOracle(const MotionLimits& limits, double period, const Measured& measured, const Motion& slave, const Motion& master)
        : limits_(limits), period_(period), measured_(measured), slave_(slave), master_(master) {
        low_ = std::min(slave.velocity, master.velocity);
        high_ = std::max(slave.velocity, master.velocity);
        meet(released(slave));
        look_at_sense(master.velocity);
        ahead_ = slave.velocity * sense_ >= 0;
    }

    void observe(const Motion& slave, const Motion& master, bool in_gear) {
        ++cycles_;
        low_ = std::min(low_, master.velocity);
        high_ = std::max(high_, master.velocity);
        look_at_sense(master.velocity);
        if (!in_gear) {
            check_sense(slave);
            check_range(slave, master);
            check_acceleration(slave);
        }
        check_jerk(slave, master, in_gear);
        if (std::abs(slave.acceleration) <= std::min(limits_.acceleration, limits_.deceleration) * (1 + 1e-9)) inside_ = true;
        slave_ = slave;
        master_ = master;
    }

    [[nodiscard]] bool clean() const { return report_.empty(); }
    [[nodiscard]] const std::string& report() const { return report_; }
    /// Cycles in which the slave was beyond the range for one of the two reasons.
    [[nodiscard]] long outside() const { return outside_; }
    [[nodiscard]] bool reversed() const { return reversed_; }

private:
    template <class... Args>
    void breach(fmt::format_string<Args...> text, Args&&... args) {
        if (report_.size() > 1000) return;
        report_ += fmt::format("{} cycles after the command: ", cycles_);
        report_ += fmt::format(text, std::forward<Args>(args)...);
        report_ += '\n';
    }
    /// Of a measured master, u/s.
    [[nodiscard]] double change() const { return std::max(high_, measured_.high) - std::min(low_, measured_.low); }
    [[nodiscard]] double grain() const { return 1e-9 * limits_.velocity; }

    /// Where the velocity comes to while the jerk takes the acceleration away.
    [[nodiscard]] double released(const Motion& at) const {
        const double there = at.velocity + at.acceleration * std::abs(at.acceleration) / (2 * limits_.jerk);
        if (at.velocity * at.acceleration < 0 && there * at.velocity < 0) return 0;
        return std::clamp(there, -std::max(limits_.velocity, std::abs(at.velocity)), std::max(limits_.velocity, std::abs(at.velocity)));
    }
    void meet(double velocity) {
        low_ = std::min(low_, velocity);
        high_ = std::max(high_, velocity);
    }
    void look_at_sense(double velocity) {
        if (std::abs(velocity) <= measured_.noise + grain()) {
            if (sense_ == 0) sense_ = slave_.velocity > 0 ? 1 : slave_.velocity < 0 ? -1 : 0;
            return;
        }
        const double now = velocity > 0 ? 1 : -1;
        if (!known_) ahead_ = ahead_ || slave_.velocity * now >= 0;
        else if (now != sense_) reversed_ = true;
        if (!known_ && now != sense_) ahead_ = slave_.velocity * now >= 0;
        sense_ = now;
        known_ = true;
    }

    void check_sense(const Motion& slave) {
        if (reversed_) return;
        if (ahead_ && slave.velocity * sense_ < -grain() - measured_.noise)
            breach("runs at {} after {} u/s, against a master that never reversed", slave.velocity, slave_.velocity);
        if (slave.velocity * sense_ >= 0) ahead_ = true;
    }

    void check_range(const Motion& slave, const Motion& master) {
        const double more = measured_.noise + measured_.overshoot * change() + grain();
        const double out = slave.velocity > high_ + more ? 1 : slave.velocity < low_ - more ? -1 : 0;
        if (out == 0) return;
        ++outside_;
        if ((slave.velocity - slave_.velocity) * out <= grain()) return;  // on its way back
        const double lost = (slave_.acceleration - slave.acceleration) * out;
        if (std::isfinite(limits_.jerk) && (lost >= limits_.jerk * period_ * (1 - 1e-6) || slave.acceleration * out <= 0)) return;
        const double apart = std::abs(master.velocity - slave.velocity), most = std::min(limits_.acceleration, limits_.deceleration);
        const double left = std::max(0.2 * most, most - std::abs(master.acceleration));
        const double time = apart / left + 2 * std::sqrt(2 * apart / limits_.jerk) +
                            2 * std::abs(slave.acceleration - master.acceleration) / limits_.jerk + period_;
        if (master.acceleration * out > 0 && (master.velocity + master.acceleration * time - slave.velocity) * out >= 0) return;
        breach("goes on to {} after {} u/s ({} u/s2) beyond {} to {}; the gear asks for {} u/s, {} u/s2", slave.velocity, slave_.velocity,
               slave.acceleration, low_, high_, master.velocity, master.acceleration);
    }

    void check_acceleration(const Motion& slave) {
        const double change = std::abs(slave.velocity - slave_.velocity);
        double most = std::abs(slave.velocity) > std::abs(slave_.velocity) ? limits_.acceleration : limits_.deceleration;
        if (slave.velocity * slave_.velocity <= 0) most = std::max(limits_.acceleration, limits_.deceleration);
        if (!inside_) most = std::max({most, std::abs(slave_.acceleration), std::abs(slave.acceleration)});
        // Where it goes over from one to the other, the jerk gives back what is too much.
        if (std::isfinite(limits_.jerk)) most = std::max(most, std::abs(slave_.acceleration));
        if (change > most * period_ * (1 + 1e-6) + grain())
            breach("goes from {} to {} u/s in a cycle; {} u/s2 allow {}", slave_.velocity, slave.velocity, most, most * period_);
    }

    void check_jerk(const Motion& slave, const Motion& master, bool in_gear) {
        if (!std::isfinite(limits_.jerk)) return;
        if (in_gear && measured_.noise > 0) return;  // its noise is the slave's now
        double jerk = limits_.jerk;
        const double v = std::abs(slave_.velocity), a = slave_.acceleration;
        const double room = slave_.velocity * a < 0 ? v : limits_.velocity - v;
        if (room > 0) jerk = std::max(jerk, a * a / (2 * room));
        if (2 * room <= std::abs(a) * period_) jerk = std::max(jerk, std::abs(a) / period_);
        const double masters = std::abs(master.acceleration - master_.acceleration) + measured_.unrest * (change() + measured_.noise);
        const double most = jerk * period_ * (1 + 1e-6) + 2 * masters + 1e-9 * limits_.acceleration;
        if (std::abs(slave.acceleration - a) > most)
            breach("accelerates with {} after {} u/s2; the jerk {} allows {}; at {} u/s", slave.acceleration, a, jerk, most,
                   slave_.velocity);
        else if (std::abs(slave.velocity - slave_.velocity - (slave.acceleration + a) / 2 * period_) > most * period_ + grain())
            breach("goes from {} to {} u/s with {} and {} u/s2", slave_.velocity, slave.velocity, a, slave.acceleration);
    }

    MotionLimits limits_;
    double period_;
    Measured measured_;
    Motion slave_, master_;  // one cycle ago
    double low_ = 0, high_ = 0, sense_ = 0;
    bool known_ = false;  // the sense is the master's
    bool reversed_ = false, ahead_ = false, inside_ = false;
    long cycles_ = 0, outside_ = 0;
    std::string report_;
};

}  // namespace taktwerk::axes::test
