#pragma once
// The profile modes of the fake drive, small enough to check by eye: PP runs at its speed until the target and stops there dead, PV ramps, a halt
// ramps by the deceleration of its command. It takes a set-point some cycles after it was announced.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::test {

class FakeProfile {
public:
    // what a test turns
    bool takes_setpoints = true;
    int taking = 3;            ///< cycles from the announcement to the acceptance
    bool ramps_first = false;  ///< out of PV it stops along its ramp before it changes (SV33-E 3.4.3 (7))
    bool stuck = false;        ///< keeps its profile mode whatever it is told, and knows no halt
    double overshoot = 1;      ///< factor on the speed it was given

    // what a test reads
    std::vector<DriveCommand> taken;  ///< with the set-point of each
    std::uint32_t accepted = 0;
    double velocity = 0;  ///< counts/s
    bool reached = false;

    void enter() {
        waiting_.clear();
        velocity = 0;
        reached = false;
        announced_ = 0;
    }
    /// The mode is still its own, although another is asked for.
    [[nodiscard]] bool holds(DriveMode mode) const {
        if (stuck) return mode == DriveMode::profile_velocity || mode == DriveMode::profile_position;
        return ramps_first && mode == DriveMode::profile_velocity && velocity != 0;
    }
    /// One cycle; where the motor is afterwards.
    [[nodiscard]] double step(DriveMode mode, const DriveCommand& command, double position, double period) {
        take(command, position);
        if (ramps_first && command.mode != mode) brake(ramp_, period);
        else if (command.halt && !stuck) brake(command.deceleration, period);
        else if (mode == DriveMode::profile_velocity) ramp_to(waiting_.empty() ? 0 : overshoot * waiting_.back().velocity, period);
        else return position_step(position, period);
        return position + velocity * period;
    }

private:
    void take(const DriveCommand& command, double position) {
        if (command.profile.sequence != announced_) {
            announced_ = command.profile.sequence;
            age_ = 0;
        }
        if (announced_ == 0 || announced_ == accepted || !takes_setpoints || ++age_ < taking) return;
        accepted = announced_;
        taken.push_back(command);
        auto mine = command;
        if (mine.profile.relative) mine.position += std::llround(position);
        if (mine.profile.immediately || command.mode != DriveMode::profile_position) waiting_.clear();
        waiting_.push_back(mine);
        reached = false;
        ramp_ = mine.deceleration;
    }
    void brake(double deceleration, double period) {
        velocity -= std::copysign(std::min(std::abs(velocity), deceleration * period), velocity);
        reached = velocity == 0;
    }
    void ramp_to(double target, double period) {
        const double rate = waiting_.empty() ? 0 : waiting_.back().acceleration;
        velocity += std::clamp(target - velocity, -rate * period, rate * period);
        reached = velocity == target;
    }
    double position_step(double position, double period) {
        velocity = 0;
        if (waiting_.empty()) return position;
        const auto& front = waiting_.front();
        const double way = static_cast<double>(front.position) - position;
        const double most = front.velocity * period * overshoot;
        if (std::abs(way) > most) {
            velocity = std::copysign(most / period, way);
            return position + std::copysign(most, way);
        }
        const double end = static_cast<double>(front.position);
        reached = waiting_.size() == 1;
        if (!reached) waiting_.pop_front();
        return end;
    }

    std::deque<DriveCommand> waiting_;
    std::uint32_t announced_ = 0;
    int age_ = 0;
    double ramp_ = 0;
};

}  // namespace taktwerk::axes::test
