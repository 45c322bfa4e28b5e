#include "axes/group/arm_reach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t drawn = 4096;
/// Where an arm closes, or its joints are inside their limits, in few of them: so many more, until there are some.
constexpr std::size_t drawn_at_most = 65536, some_points = 500;
constexpr std::size_t beam_gantry = ArmDescription{BeamGantryShape{}}.index();

using Shares = std::array<double, max_joints>;
using Point = std::array<double, 3>;

/// Even in all axes together, and in no step with the turns of an axis that goes round thousands of times: multiples of powers of one irrational number,
/// the root of x^7 = x + 1.
double evenly_drawn(std::size_t n, std::size_t axis) noexcept {
    static const auto steps = [] {
        constexpr double root = 1.1127756842787055;
        Shares of{};
        for (std::size_t i = 0; i < of.size(); ++i) of[i] = std::pow(root, -static_cast<double>(i + 1));
        return of;
    }();
    const double at = 0.5 + static_cast<double>(n) * steps[axis];
    return at - std::floor(at);
}

/// First the corners of the travels, then places between.
double drawn_share(std::size_t place, std::size_t axis, std::size_t corners) noexcept {
    return place < corners ? static_cast<double>((place >> axis) & 1U) : evenly_drawn(place - corners + 1, axis);
}

/// What the limits of the joints leave an axis, in its unit; with gears between them: of all that go into it.
AxisTravel by_joints(const AxisMap& map, std::size_t axis, std::size_t joints) noexcept {
    AxisTravel out{0, 0};
    for (std::size_t k = 0; k < joints; ++k) {
        const double for_one = map.to_axes()(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(k));
        if (for_one == 0) continue;
        const double low = for_one * map.settings(k).low, high = for_one * map.settings(k).high;
        out.least += std::min(low, high);
        out.most += std::max(low, high);
    }
    return out;
}

}  // namespace

/// The arm over its axes' travels, each of which goes from 0 to 1.
class ArmPlaces {
public:
    /// false: a straight axis has no ends.
    bool set_up(const AxisGroupConfig& group, std::span<const AxisTravel> travels) {
        arm_ = group.kinematics;
        tool_ = group.equipment.tool_pose();
        for (std::size_t i = 0; i < joints(); ++i) {
            auto& of = of_[i];
            of = travels[i];
            const auto joint = by_joints(arm_->map(), i, joints());
            if (!std::isfinite(of.least)) of.least = joint.least;
            if (!std::isfinite(of.most)) of.most = joint.most;
            const double turn = 2 * std::numbers::pi / arm_->map().settings(i).unit;
            if (!std::isfinite(of.least) && arm_->rotary()[i]) of.least = std::isfinite(of.most) ? of.most - turn : -turn / 2;
            if (!std::isfinite(of.most) && arm_->rotary()[i]) of.most = of.least + turn;
            if (!std::isfinite(of.least) || !std::isfinite(of.most)) return false;
            step_[i] = arm_->rotary()[i] ? std::min(1.0, turn / std::max(of.most - of.least, turn)) : 1;
        }
        return true;
    }

    [[nodiscard]] std::size_t joints() const noexcept { return arm_->joint_count(); }

    [[nodiscard]] std::optional<Point> point_at(const Shares& shares) const noexcept {
        Joints axes{};
        for (std::size_t i = 0; i < joints(); ++i) axes[i] = std::lerp(of_[i].least, of_[i].most, shares[i]);
        if (arm_->kind() == beam_gantry && !square(axes)) return std::nullopt;
        const auto at = arm_->forward(axes, tool_);
        if (!at.miss.ok() || !arm_->limits_of(axes).ok()) return std::nullopt;
        return at.pose.position;
    }

    /// From a place on to where `cost` of the point is least near it: a step along an axis, or askew (what does not close any more ends the travels askew), half as long where none leads on.
    template <class Cost>
    [[nodiscard]] double descended(Shares at, double least, const Cost& cost) const {
        constexpr double first = 0.1, last = 1e-6;
        constexpr std::size_t askew = 8, most_tries = 6000;
        const std::size_t ways = 2 * joints() + askew;
        std::size_t tries = 0, failed = 0;
        for (double length = first; length > last && tries < most_tries; ++tries) {
            Shares next = at;
            if (const std::size_t way = tries % ways; way < 2 * joints())
                next[way / 2] += (way % 2 == 0 ? length : -length) * step_[way / 2];
            else
                for (std::size_t i = 0; i < joints(); ++i) next[i] += (2 * evenly_drawn(tries, i) - 1) * length * step_[i];
            for (auto& share : next) share = std::clamp(share, 0.0, 1.0);
            if (const auto point = point_at(next); point && cost(*point) < least) {
                least = cost(*point);
                at = next;
                failed = 0;
                length = std::min(first, length * 1.2);
            } else if (++failed >= ways) {
                failed = 0;
                length /= 2;
            }
        }
        return least;
    }

private:
    /// Both masters at one X, as every command has them. false: the second one does not come to there.
    bool square(Joints& axes) const noexcept {
        const auto& map = arm_->map();
        auto joints = map.arm_of(map.joints_of(axes));
        joints[1] = joints[0];
        axes = map.axes_of(map.joints_of_arm(joints));
        const double hair = (of_[1].most - of_[1].least) * 1e-9;
        return axes[1] >= of_[1].least - hair && axes[1] <= of_[1].most + hair;
    }

    std::shared_ptr<const Kinematics> arm_;
    Pose tool_;
    std::array<AxisTravel, max_joints> of_{};
    Shares step_{};  ///< of a way that is long: 1, or a turn's share of more than one
};

namespace {

/// The least cost of all points. The search begins in several of them, each the best of its part, so that one that ends in a dead end does not count.
template <class Cost>
double least_of(const ArmReach& reach, std::size_t parts, const Cost& cost, double good_enough = -std::numeric_limits<double>::infinity()) {
    constexpr double nothing = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, std::size_t>> best(parts, {nothing, 0});
    for (std::size_t i = 0; i < reach.points.size(); ++i) best[i % parts] = std::min(best[i % parts], std::pair{cost(reach.points[i]), i});
    std::sort(best.begin(), best.end());
    double least = best[0].first;
    for (const auto& [at, i] : best)
        if (at < nothing && least > good_enough) least = std::min(least, reach.places->descended(reach.stood_at[i], at, cost));
    return least;
}
/// Of an end of the reach; to a room, which is convex; to what several rooms leave, which may be far from where each of them is least in the way.
constexpr std::size_t parts_of_an_end = 12, parts_of_a_room = 24, parts_of_rooms = 64;

}  // namespace

namespace {

/// How many behind the point make so many of that length, and one; never finer than a millionth.
int digits_of(double length, int many) noexcept {
    return length > 1e-9 ? std::min(many - static_cast<int>(std::floor(std::log10(length))), 6) : many;
}

/// `digits`: behind the point; below 0 in front of it. No zeros that say nothing.
std::string rounded(double length, int digits) {
    const double unit = std::pow(10.0, -digits);
    std::string out = fmt::format("{:.{}f}", std::round(length / unit) * unit, std::max(digits, 0));
    if (digits > 0) out.erase(std::max(out.find_last_not_of('0'), out.find('.') - 1) + 1);
    if (out.back() == '.') out.pop_back();
    return out == "-0" ? "0" : out;
}

}  // namespace

double ArmReach::size() const noexcept { return std::hypot(most[0] - least[0], most[1] - least[1], most[2] - least[2]); }

double ArmReach::distance_to(const WorkspaceRoom& room) const {
    return std::max(least_of(
                        *this, parts_of_a_room, [&](const Point& point) { return place_at(room, point).distance; }, 0.0),
                    0.0);
}

bool ArmReach::outside_of(const Workspace& space) const {
    return least_of(
               *this, parts_of_rooms, [&](const Point& point) { return -space.clearance(point); }, 0.0) > size() * most_error;
}

std::string ArmReach::shown(double length) const { return rounded(length, digits_of(size(), 3)); }

std::string ArmReach::text() const {
    std::string out;
    for (std::size_t i = 0; i < 3; ++i) {
        // What is flat beside the whole, as the lift of a long portal is, keeps two digits of its own.
        const double extent = most[i] - least[i];
        const int of_all = digits_of(size(), 3);
        const int digits = extent > 1e-6 * size() ? std::max(of_all, digits_of(extent, 2)) : of_all;
        out +=
            fmt::format("{}{} {} to {}", i == 0 ? "" : ", ", pose_component_names[i], rounded(least[i], digits), rounded(most[i], digits));
    }
    return out;
}

std::optional<ArmReach> arm_reach(const AxisGroupConfig& group, std::span<const AxisTravel> travels) {
    if (!group.kinematics || travels.size() < group.kinematics->joint_count()) return std::nullopt;
    const auto places = std::make_shared<ArmPlaces>();
    if (!places->set_up(group, travels)) return std::nullopt;
    ArmReach out;
    out.places = places;
    const std::size_t corners = std::size_t{1} << places->joints();
    for (; out.looked_at < corners + (out.points.size() < some_points ? drawn_at_most : drawn); ++out.looked_at) {
        Shares shares{};
        for (std::size_t i = 0; i < places->joints(); ++i) shares[i] = drawn_share(out.looked_at, i, corners);
        const auto point = places->point_at(shares);
        if (!point) continue;
        out.points.push_back(*point);
        out.stood_at.push_back(shares);
    }
    if (out.points.empty()) return out;
    for (std::size_t i = 0; i < 3; ++i) {
        out.least[i] = least_of(out, parts_of_an_end, [i](const Point& point) { return point[i]; });
        out.most[i] = -least_of(out, parts_of_an_end, [i](const Point& point) { return -point[i]; });
    }
    return out;
}

}  // namespace taktwerk::axes
