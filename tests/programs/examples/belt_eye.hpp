#pragma once
// Looks at the arm and the belt of config/machines/five-drives.yaml from outside of the program: where the gripper really is, by the mechanics of the six
// joints, and where the parts really are, by the mechanics of the belt. And at every set-point of the seven axes.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/axes/axis/motion_oracle.hpp"
#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::testing {

using Place = std::array<double, 3>;

inline Place turned_y(const Place& p, double angle) {
    return {std::cos(angle) * p[0] + std::sin(angle) * p[2], p[1], -std::sin(angle) * p[0] + std::cos(angle) * p[2]};
}
inline Place turned_z(const Place& p, double angle) {
    return {std::cos(angle) * p[0] - std::sin(angle) * p[1], std::sin(angle) * p[0] + std::cos(angle) * p[1], p[2]};
}
inline Place plus(const Place& a, const Place& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// KUKA, KR 6 R900 sixx: 400, 25, 455, 35, 420, 80 mm; axes 1, 4 and 6 count clockwise, axis 2 stands at -90 degrees where the upper arm is upright. From the
/// tool back to the base, link by link. `tool`: seen from the flange. Degrees, mm.
inline Place by_hand(const std::array<double, 6>& q, const Place& tool) {
    const double degree = std::numbers::pi / 180;
    Place p = turned_z(plus(tool, {0, 0, 80}), -q[5] * degree);
    p = turned_z(turned_y(p, q[4] * degree), -q[3] * degree);
    p = turned_y(plus(p, {-35, 0, 420}), q[2] * degree);
    p = turned_y(plus(p, {0, 0, 455}), (q[1] + 90) * degree);
    return turned_z(plus(p, {25, 0, 400}), -q[0] * degree);
}

class BeltEye {
public:
    static constexpr std::array<const char*, 7> axes{"j1", "j2", "j3", "j4", "j5", "j6", "belt"};
    // Of the machine file: parts on the belt; of the program: where the belt lies and the barrier stands. mm
    static constexpr double first = 20, every = 500, forward = 450, height = 300, barrier = -300;
    static constexpr double gripper_length = 120;
    static constexpr double off_belt = 5;  ///< so high, what is in the gripper lies on the belt no more

    explicit BeltEye(ExampleMachine& machine) : m_(machine) {
        for (const char* name : axes)
            for (const auto& binding : m_.config().axes)
                if (binding.axis.name == name) oracles_.emplace_back(binding.axis, m_.config().cycle);
        m_.each_cycle = [this] { look(); };
    }
    ~BeltEye() { m_.each_cycle = {}; }
    BeltEye(const BeltEye&) = delete;
    BeltEye& operator=(const BeltEye&) = delete;

    /// While the gripper is closed around a part that is on the belt.
    struct Grip {
        long part = 0;                         ///< the how manieth of the belt
        double along = 0, across = 0, up = 0;  ///< mm: the worst, of the gripper's point from the part's middle
        double slip = 0;                       ///< mm/s: the worst, of its velocity along the belt from the belt's
        double tilt = 0;                       ///< the worst, of its direction from straight down: the sine
        double belt = 0;                       ///< mm/s, as fast as the belt was at most
        bool lifted = false;
    };
    std::vector<Grip> grips;
    std::vector<Place> placed;  ///< mm: where the gripper opened with a part in it
    std::vector<double> bits;   ///< set positions of the seven, each cycle
    bool keep_bits = false;
    double most_used = 0;  ///< of a joint's limits for velocity and acceleration, as people are told; 1 is the limit
    double most_jerk = 0;  ///< likewise

    [[nodiscard]] const Place& tool() const { return tool_; }
    [[nodiscard]] bool clean() const {
        return std::all_of(oracles_.begin(), oracles_.end(), [](const auto& one) { return one.clean(); });
    }
    [[nodiscard]] std::string report() const {
        std::string all;
        for (const auto& one : oracles_) all += one.report();
        return all;
    }
    /// Cycles in which the set-points of an axis were compared with the ones before, of the axis with the fewest.
    [[nodiscard]] long compared() const {
        long least = oracles_.front().compared();
        for (const auto& one : oracles_) least = std::min(least, one.compared());
        return least;
    }

private:
    void look() {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            oracles_[i].observe(m_.axis(axes[i]));
            if (keep_bits) bits.push_back(m_.axis(axes[i]).set_position);
        }
        std::array<double, 6> q{};
        for (std::size_t i = 0; i < q.size(); ++i) q[i] = m_.place(axes[i]);
        const auto before = tool_;
        const double belt_before = belt_;
        tool_ = by_hand(q, {0, 0, gripper_length});
        const auto flange = by_hand(q, {});
        belt_ = m_.place("belt");
        const double period = to_seconds(m_.config().cycle);
        if (seen_) watch_gripper(flange, (tool_[1] - before[1]) / period, (belt_ - belt_before) / period);
        seen_ = true;
        for (const auto& use : m_.snapshot().groups[0].use) {
            most_used = std::max({most_used, static_cast<double>(use.velocity), static_cast<double>(use.acceleration)});
            most_jerk = std::max(most_jerk, static_cast<double>(use.jerk));
        }
    }
    void watch_gripper(const Place& flange, double speed, double belt_speed) {
        const bool closed = m_.output("gripper");
        if (closed && !closed_) {
            const double passed = belt_ - first + barrier - tool_[1];
            grips.push_back({.part = std::lround(passed / every)});
            on_belt_ = true;
        }
        if (!closed && closed_ && !on_belt_) placed.push_back(tool_);
        on_belt_ = on_belt_ && closed;
        closed_ = closed;
        if (!on_belt_) return;
        auto& grip = grips.back();
        if (tool_[2] > height + off_belt) {
            grip.lifted = true;
            on_belt_ = false;
            return;
        }
        // The program goes by set-points, which are some milliseconds ahead: what it takes for lifted may run on without the belt a little lower.
        if (tool_[2] > height + off_belt - 1) return;
        const auto worst = [](double& so_far, double now) { so_far = std::max(so_far, std::abs(now)); };
        worst(grip.along, tool_[1] - barrier - (belt_ - first - every * static_cast<double>(grip.part)));
        worst(grip.across, tool_[0] - forward);
        worst(grip.up, std::min(tool_[2] - height, 0.0));
        worst(grip.slip, speed - belt_speed);
        worst(grip.tilt, std::hypot(tool_[0] - flange[0], tool_[1] - flange[1]) / gripper_length);
        worst(grip.belt, belt_speed);
    }

    ExampleMachine& m_;
    std::vector<axes::test::MotionOracle> oracles_;
    Place tool_{};
    double belt_ = 0;
    bool seen_ = false, closed_ = false, on_belt_ = false;
};

}  // namespace taktwerk::testing
