#pragma once
// A program of one to two hundred moves, drawn for an arm: lines, arcs given in three ways, moves of the axes, with every way to round a corner; and
// where each of them has to lead, by formulas of the test's own. Everything it asks for can be gone, so nothing of it may end in an error.

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "axes/group/written_pose.hpp"
#include "axes/pose_math.hpp"
#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::axes::test {

/// jog_arms.hpp's, and one that only Newton's method knows: the IRB 120 as calibration may find it, tenths of a millimetre and of a degree.
inline std::vector<JogArm> arms_of_programs() {
    auto arms = every_kind_of_arm();
    for (const auto& arm : every_kind_of_arm()) {
        if (arm.name != "six_with_wrist") continue;
        JogArm numeric = arm;
        numeric.name = "six_calibrated";
        std::get<SixJoints>(numeric.description.arm).deviations = {{{{.3, -.2, .1}, {.0015, -.0008, .0011}},
                                                                    {{-.1, .4, .2}, {-.0021, .0013, -.0009}},
                                                                    {{.2, .1, -.3}, {.0007, .0018, -.0016}},
                                                                    {{-.4, .2, .1}, {-.0012, -.0006, .0022}},
                                                                    {{.1, -.3, .2}, {.0009, .0014, .0005}},
                                                                    {{.2, .3, -.1}, {-.0005, .0011, -.0017}}}};
        arms.push_back(numeric);
    }
    return arms;
}

/// Where a command leads, from its beginning to its end. Shares go with its length.
struct Way {
    enum class Kind : unsigned char { joints, line, arc } kind = Kind::line;
    std::size_t members = 0;
    JointVector from{}, to{};      // joints
    Eigen::Vector3d begin, end;    // line
    Eigen::Vector3d centre, u, v;  // arc: centre + r (cos f u + sin f v), f from 0 to angle
    double radius = 0, angle = 0;
    Eigen::Quaterniond start{1, 0, 0, 0};
    Eigen::Vector3d turn{0, 0, 0};  // rad, seen from `start`
    double length = 0;

    struct Place {
        double share = 0;       // of the way
        double off = 0;         // u, from the nearest place of it
        double turned_off = 0;  // rad, from the orientation that belongs to it
    };
    [[nodiscard]] Place nearest(const JointVector& q, const Pose& pose) const {
        Place place;
        if (kind == Kind::joints) {
            double along = 0, square = 0;
            for (std::size_t k = 0; k < members; ++k) {
                along += (q[k] - from[k]) * (to[k] - from[k]);
                square += (to[k] - from[k]) * (to[k] - from[k]);
            }
            place.share = square > 0 ? along / square : 0;
            const double t = std::clamp(place.share, 0.0, 1.0);
            for (std::size_t k = 0; k < members; ++k) place.off += std::pow(q[k] - from[k] - t * (to[k] - from[k]), 2);
            place.off = std::sqrt(place.off);
            return place;
        }
        const Eigen::Vector3d p = position_of(pose);
        if (kind == Kind::line) {
            place.share = (p - begin).dot(end - begin) / (end - begin).squaredNorm();
            place.off = (p - begin - std::clamp(place.share, 0.0, 1.0) * (end - begin)).norm();
        } else {
            const Eigen::Vector3d out = p - centre;
            double f = std::atan2(out.dot(v), out.dot(u));
            const double outside = 2 * std::numbers::pi - angle;
            if (f < -outside / 2) f += 2 * std::numbers::pi;
            place.share = f / angle;
            const double inside = std::clamp(f, 0.0, angle);
            place.off = (out - radius * (std::cos(inside) * u + std::sin(inside) * v)).norm();
        }
        const double t = std::clamp(place.share, 0.0, 1.0), whole = turn.norm();
        const Eigen::Quaterniond should =
            start * (whole > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(t * whole, turn / whole)) : Eigen::Quaterniond::Identity());
        place.turned_off = 2 * (should.conjugate() * orientation_of(pose)).vec().norm();
        return place;
    }
};

struct DrawnMove {
    GroupCommand command;
    Way way;
};

class ProgramDraws {
public:
    ProgramDraws(std::uint64_t seed, const JogArm& arm, const Arm& kinematics) : random_(seed), arm_(arm), kinematics_(kinematics) {
        q_ = arm.start;
        pose_ = pose_at(q_);
        const auto can = kinematics->commands();
        upright_ = can[5], free_ = can[3] && can[4] && can[5];
    }

    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    double between_decades(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }

    /// From 1 to 200, as often as n^-1.5: 32 % have one move, 14 % more than 25, 3 % more than 100; 13.7 in the mean.
    int how_many() {
        const double least = 1 / std::sqrt(201.0);
        return static_cast<int>(std::pow(1 - uniform(0, 1) * (1 - least), -2));
    }

    std::vector<DrawnMove> program(int moves) {
        std::vector<DrawnMove> all;
        for (int tries = 0; static_cast<int>(all.size()) < moves && tries < 50 * moves; ++tries) {
            DrawnMove move;
            JointVector q{};
            Pose pose;
            if (!draw(move, q, pose)) continue;
            q_ = q;
            pose_ = pose;
            all.push_back(move);
        }
        return all;
    }

private:
    [[nodiscard]] static Joints first_of(const JointVector& q) {
        Joints joints{};
        for (std::size_t i = 0; i < max_joints; ++i) joints[i] = q[i];
        return joints;
    }
    [[nodiscard]] Pose pose_at(const JointVector& q) const { return kinematics_->forward(first_of(q), {}).pose; }
    [[nodiscard]] bool within(const JointVector& q) const {
        constexpr double room = 40;  // from where the program begins, degrees or u
        for (std::size_t k = 0; k < arm_.turning.size(); ++k)
            if (std::abs(q[k] - arm_.start[k]) > room) return false;
        return kinematics_->singularity(first_of(q)).measure > 0.05;
    }
    /// The members at this pose, near `near`; false: there is no such stand inside the room.
    [[nodiscard]] bool stand(const Pose& pose, JointVector& near) const {
        const auto found = kinematics_->inverse(pose, {}, {}, first_of(near));
        if (!found.ok()) return false;
        for (std::size_t k = 0; k < max_joints; ++k) near[k] = found.axes[k];
        return within(near);
    }
    /// Can all of it be gone? And one way of the arm lead through.
    [[nodiscard]] bool can_be_gone(const Way& way, JointVector& q) const {
        constexpr int steps = 24;
        q = q_;
        for (int i = 0; i <= steps; ++i) {
            const double t = static_cast<double>(i) / steps, f = t * way.angle, whole = way.turn.norm();
            if (way.kind == Way::Kind::joints) {
                for (std::size_t k = 0; k < way.members; ++k) q[k] = way.from[k] + t * (way.to[k] - way.from[k]);
                if (!within(q)) return false;
                continue;
            }
            const Eigen::Vector3d p = way.kind == Way::Kind::line
                                          ? Eigen::Vector3d(way.begin + t * (way.end - way.begin))
                                          : Eigen::Vector3d(way.centre + way.radius * (std::cos(f) * way.u + std::sin(f) * way.v));
            const Eigen::Quaterniond turned = way.start * (whole > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(t * whole, way.turn / whole))
                                                                     : Eigen::Quaterniond::Identity());
            const JointVector before = q;
            if (!stand(pose_of(p, turned), q)) return false;
            for (std::size_t k = 0; k < arm_.turning.size(); ++k)
                if (std::abs(q[k] - before[k]) > 10) return false;
        }
        return true;
    }

    Eigen::Vector3d direction() {
        Eigen::Vector3d d;
        do d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        while (d.norm() < 0.1 || d.norm() > 1);
        return d.normalized();
    }
    /// How the tool turns on the way, seen in the machine: not at all, or as the arm can.
    Eigen::Quaterniond turning() {
        if (!upright_ || chance(0.5)) return Eigen::Quaterniond::Identity();
        const Eigen::Vector3d axis = free_ ? direction() : Eigen::Vector3d(0, 0, 1);
        return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(-0.25, 0.25), axis));
    }

    bool draw(DrawnMove& move, JointVector& q, Pose& pose) {
        GroupCommand& c = move.command;
        Way& w = move.way;
        w.members = arm_.turning.size();
        w.start = orientation_of(pose_);
        w.begin = position_of(pose_);
        const double size = between_decades(0.2, 40), kind = uniform(0, 1);
        const Eigen::Quaterniond by = turning();
        pose = pose_;
        c.frame = mcMCS;
        if (kind < 0.45) line(c, w, size, by, pose);
        else if (kind < 0.75) arc(c, w, size, by, pose);
        else axes(c, w, size, pose);
        if (w.kind != Way::Kind::joints) {
            w.end = position_of(pose);
            const Eigen::Quaterniond turned = w.start.conjugate() * orientation_of(pose);
            const double sine = turned.vec().norm();
            w.turn = sine > 0 ? Eigen::Vector3d(2 * std::atan2(sine, turned.w()) / sine * turned.vec()) : Eigen::Vector3d::Zero();
            const double linear = w.kind == Way::Kind::line ? (w.end - w.begin).norm() : w.radius * w.angle;
            w.length = std::hypot(linear, w.turn.norm());
        }
        if (!can_be_gone(w, q)) return false;
        if (w.kind == Way::Kind::joints) q = w.to;
        c.dynamics.velocity = std::clamp(w.length / between_decades(0.03, 1), 2.0, 500.0);
        if (chance(0.3)) c.dynamics.acceleration = between_decades(100, 5000);
        if (chance(0.3)) c.dynamics.deceleration = between_decades(100, 5000);
        if (chance(0.3)) c.dynamics.jerk = between_decades(3000, 100'000);
        c.buffer_mode = static_cast<MC_BufferMode>(whole(1, 5));
        c.transition = static_cast<MC_TransitionMode>(whole(0, 4));
        const bool by_velocity = c.transition == mcTMStartVelocity || c.transition == mcTMConstantVelocity;
        c.transition_parameter = by_velocity ? uniform(0, 1) : between_decades(1e-3, 1) * w.length;
        return true;
    }

    static void put(GroupCommand& c, const Pose& pose) {
        const auto six = numbers_of(pose);
        for (std::size_t k = 0; k < six.size(); ++k) c.target[k] = six[k];
    }
    void line(GroupCommand& c, Way& w, double size, const Eigen::Quaterniond& by, Pose& pose) {
        w.kind = Way::Kind::line;
        const Eigen::Vector3d distance = size * direction();
        const bool relative = chance(0.3);
        pose = pose_of(w.begin + distance, by * w.start);
        if (relative) {
            c.kind = GroupCommandKind::linear_relative;
            put(c, pose_of(distance, by));
        } else {
            c.kind = GroupCommandKind::linear_absolute;
            put(c, pose);
        }
    }
    void arc(GroupCommand& c, Way& w, double size, const Eigen::Quaterniond& by, Pose& pose) {
        w.kind = Way::Kind::arc;
        const auto mode = static_cast<MC_CIRC_MODE>(whole(0, 2));
        w.angle = mode == mcRADIUS ? uniform(0.3, 3) : uniform(0.3, 5.8);
        w.radius = size / w.angle;
        w.u = direction();
        if (mode == mcCENTER) w.u = Eigen::Vector3d(w.u.x(), w.u.y(), 0).normalized();  // in the plane XY of the frame
        const Eigen::Vector3d normal = mode == mcCENTER ? Eigen::Vector3d(0, 0, chance(0.5) ? 1 : -1) : w.u.cross(direction()).normalized();
        w.v = normal.cross(w.u);
        w.centre = w.begin - w.radius * w.u;
        const auto at = [&](double f) { return Eigen::Vector3d(w.centre + w.radius * (std::cos(f) * w.u + std::sin(f) * w.v)); };
        pose = pose_of(at(w.angle), by * w.start);
        const bool relative = chance(0.3);
        c.kind = relative ? GroupCommandKind::circular_relative : GroupCommandKind::circular_absolute;
        put(c, relative ? pose_of(position_of(pose) - w.begin, by) : pose);
        c.circle.mode = mode;
        Eigen::Vector3d aux = at(uniform(0.2, 0.8) * w.angle);
        if (mode == mcCENTER) {
            aux = w.centre;
            c.circle.clockwise = normal.z() < 0;
        }
        if (relative) aux -= w.begin;
        if (mode == mcRADIUS) {
            c.circle.clockwise = chance(0.5);
            aux = (c.circle.clockwise ? -w.radius : w.radius) * normal;
        }
        c.circle.aux = {aux.x(), aux.y(), aux.z()};
    }
    /// A line of the axes: to a place of theirs, by a distance, or to where the tool shall be.
    void axes(GroupCommand& c, Way& w, double size, Pose& pose) {
        w.kind = Way::Kind::joints;
        w.from = w.to = q_;
        for (std::size_t k = 0; k < w.members; ++k) w.to[k] += uniform(-0.5, 0.5) * size;
        if (arm_.askew) w.to[1] = w.from[1] + w.to[0] - w.from[0];
        pose = pose_at(w.to);
        const int how = whole(0, 4);
        if (how == 0) {
            c.kind = GroupCommandKind::direct_absolute;
            put(c, pose);
        } else {
            c.frame = mcACS;
            const bool relative = how == 1 || how == 3;
            c.kind = how <= 2 ? (relative ? GroupCommandKind::direct_relative : GroupCommandKind::direct_absolute)
                              : (relative ? GroupCommandKind::linear_relative : GroupCommandKind::linear_absolute);
            for (std::size_t k = 0; k < w.members; ++k) c.target[k] = relative ? w.to[k] - w.from[k] : w.to[k];
        }
        for (std::size_t k = 0; k < w.members; ++k) w.length += std::pow(w.to[k] - w.from[k], 2);
        w.length = std::sqrt(w.length);
    }

    std::mt19937_64 random_;
    const JogArm& arm_;
    Arm kinematics_;
    JointVector q_{};
    Pose pose_;
    bool upright_ = false, free_ = false;
};

}  // namespace taktwerk::axes::test
