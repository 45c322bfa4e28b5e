// A stop out of any state of a motion, with a deceleration and a jerk of its own, against a twin that goes on: wherever within the time in which a stop is planned the braking
// begins, the way is no longer than that deceleration and that jerk ask for from there. Who is in a corner by then has the corner's way to begin in, for there the bend itself needs
// what the axes have.

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/axes/group/group_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double longest_lead = 0.07;  // s, docs/motion/groups.md

/// Way of a stop from velocity v and acceleration a: the deceleration comes with the jerk, and goes with it so that both end at once.
double least_way(double v, double a, double deceleration, double jerk) {
    constexpr double dt = 2e-5;
    double way = 0;
    while (v > 0) {
        const double gone = a < 0 ? a * a / (2 * jerk) : 0;  // velocity that is lost while the deceleration goes
        a = std::max(a + (v <= gone ? jerk : -jerk) * dt, -deceleration);
        if (v <= gone && a >= 0) break;
        v += a * dt;
        way += v * dt;
    }
    return way;
}

struct Shape {
    int kind = 0;  // a line, a polygon, there and back with corners
    double length = 0, first = 0, second = 0, third = 0;
    int cycles = 0;
    double deceleration = 0, jerk = 0;
};

void begin(GroupRig& rig, const Shape& s) {
    rig.enable();
    const auto with = [&](GroupCommand g) {
        g.frame = mcMCS;
        g.transition = mcTMCornerDistance;
        g.transition_parameter = s.length / 3;
        return g;
    };
    rig.step([&] {
        (void)rig.submit(with(line({s.length, 0, 0}, s.first)));
        if (s.kind == 0) return;
        (void)rig.submit(with(line({s.length, s.length, 0}, s.second, mcBlendingHigh)));
        (void)rig.submit(with(line({0, s.length, 0}, s.third, mcBlendingLow)));
    });
    rig.run(s.cycles);
}

TEST(GroupStopWays, OutOfEveryStateAreNoLongerThanAskedFor) {
    std::mt19937_64 random(5);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    const auto decades = [&](double a, double b) { return std::exp(between(std::log(a), std::log(b))); };
    constexpr double most_on_lines = 1.05, most_with_corners = 2;
    int stopped = 0;
    double worst_on_lines = 0, worst_with_corners = 0;
    for (std::size_t c = 0; c < property_cases(30); ++c) {
        Shape s;
        s.kind = static_cast<int>(c % 3);
        s.length = decades(2, 60);
        s.first = between(20, 100);
        s.second = between(20, 100);
        s.third = between(20, 100);
        s.cycles = static_cast<int>(between(5, 60 + s.length * 20));
        s.deceleration = decades(100, 1000);
        s.jerk = decades(1500, 10000);
        GroupRig rig(3, cartesian_arm()), twin(3, cartesian_arm());
        begin(rig, s);
        begin(twin, s);
        if (rig.view().state != GroupState::GroupMoving) continue;
        const double v = rig.view().path_velocity, a = rig.view().path_acceleration, gone = rig.view().path_gone;
        double bound = 0;
        bool bends = false;
        JointVector before = twin.point();
        double x_before = 0, y_before = 0;
        for (double t = 0; t < longest_lead || bends; t += 1e-3) {
            const auto now = twin.view();
            if (now.state != GroupState::GroupMoving) break;
            bound = std::max(bound, now.path_gone - gone + least_way(now.path_velocity, now.path_acceleration, s.deceleration, s.jerk));
            twin.step();
            const double x = twin.point()[0] - before[0], y = twin.point()[1] - before[1];
            bends = std::fabs(x * y_before - y * x_before) > 1e-9 * std::hypot(x, y) * std::hypot(x_before, y_before);
            before = twin.point();
            x_before = x;
            y_before = y;
        }
        (void)rig.give(simply(GroupCommandKind::stop, {.deceleration = s.deceleration, .jerk = s.jerk}));
        for (int k = 0; rig.view().path_velocity != 0 && k < 20000; ++k) rig.step();
        const double part = (rig.view().path_gone - gone) / bound;
        ++stopped;
        double& worst = s.kind == 0 ? worst_on_lines : worst_with_corners;
        worst = std::max(worst, part);
        EXPECT_LE(part, s.kind == 0 ? most_on_lines : most_with_corners)
            << "case " << c << ", kind " << s.kind << ", length " << s.length << ", from " << v << " and " << a << " with "
            << s.deceleration << " and " << s.jerk;
    }
    EXPECT_GT(stopped, 20);
    std::printf("%d stops: at most %.3f times the way on lines, %.3f with corners\n", stopped, worst_on_lines, worst_with_corners);
}

}  // namespace
}  // namespace taktwerk::axes::test
