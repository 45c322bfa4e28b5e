// From a description to an arm: what cannot be one is said here, once, so that nothing in the cycle has to ask.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include <Eigen/LU>

#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {
namespace {

struct NamedLength {
    std::string_view name;
    double value;
    bool above_zero;
};

std::optional<Error> check_lengths(std::string_view kind, std::initializer_list<NamedLength> lengths) {
    for (const NamedLength& l : lengths)
        if (!std::isfinite(l.value) || (l.above_zero && l.value <= 0))
            return Error{"kinematics.length", fmt::format("{}.{}", kind, l.name),
                         fmt::format("{} where it must be {}", l.value, l.above_zero ? "above 0" : "a number"),
                         "Give the length as the arm's data sheet has it, in the machine's unit"};
    return std::nullopt;
}

struct Checks {
    std::string_view kind;

    std::optional<Error> operator()(const CartesianAxes& a) const {
        const auto count = std::count(a.linear.begin(), a.linear.end(), true);
        if (count >= 2 && a.turn_about >= -1 && a.turn_about <= 2) return std::nullopt;
        return Error{"kinematics.geometry", std::string(kind), fmt::format("{} linear axes and a turn about {}", count, a.turn_about),
                     "Give two or three linear axes, and a turn about X (0), Y (1), Z (2) or none (-1)"};
    }
    std::optional<Error> operator()(const BeamGantryShape& s) const { return check_lengths(kind, {{"span", s.span, true}}); }
    std::optional<Error> operator()(const CoreXyAxes&) const { return std::nullopt; }
    std::optional<Error> operator()(const ScaraLengths& l) const {
        return check_lengths(kind, {{"first", l.first, true}, {"second", l.second, true}, {"height", l.height, false}});
    }
    std::optional<Error> operator()(const PalletizerLengths& l) const {
        return check_lengths(kind, {{"shoulder", l.shoulder, false},
                                    {"height", l.height, false},
                                    {"upper", l.upper, true},
                                    {"fore", l.fore, true},
                                    {"wrist", l.wrist, false},
                                    {"drop", l.drop, false}});
    }
    std::optional<Error> operator()(const RotaryDeltaLengths& l) const {
        if (auto error = check_lengths(kind, {{"base_radius", l.base_radius, true},
                                              {"platform_radius", l.platform_radius, true},
                                              {"upper", l.upper, true},
                                              {"rod", l.rod, true},
                                              {"first_arm_at", l.first_arm_at, false}}))
            return error;
        return check_lengths(kind, {{"rod and upper arm less both radii's difference",
                                     l.rod + l.upper - std::abs(l.base_radius - l.platform_radius), true}});
    }
    std::optional<Error> operator()(const LinearDeltaLengths& l) const {
        if (auto error = check_lengths(kind, {{"base_radius", l.base_radius, true},
                                              {"platform_radius", l.platform_radius, true},
                                              {"rod", l.rod, true},
                                              {"first_arm_at", l.first_arm_at, false}}))
            return error;
        return check_lengths(kind, {{"base_radius less platform_radius", l.base_radius - l.platform_radius, true},
                                    {"rod less both radii's difference", l.rod - l.base_radius + l.platform_radius, true}});
    }
    std::optional<Error> operator()(const SixJoints& six) const {
        for (const LinkDeviation& d : six.deviations)
            for (std::size_t i = 0; i < 3; ++i)
                if (auto error =
                        check_lengths(kind, {{"a deviation's shift", d.shift[i], false}, {"a deviation's turn", d.turn[i], false}}))
                    return error;
        if (const auto* table = std::get_if<SixJoints::Table>(&six.geometry)) {
            for (std::size_t i = 0; i < table->rows.size(); ++i) {
                const DhRow& row = table->rows[i];
                if (auto error =
                        check_lengths(fmt::format("{}.rows.{}", kind, i),
                                      {{"a", row.a, false}, {"alpha", row.alpha, false}, {"d", row.d, false}, {"theta", row.theta, false}}))
                    return error;
            }
            return std::nullopt;
        }
        const auto& l = std::get<WristArmLengths>(six.geometry);
        return check_lengths(kind, {{"a1", l.a1, false},
                                    {"a2", l.a2, false},
                                    {"b", l.b, false},
                                    {"c1", l.c1, false},
                                    {"c2", l.c2, true},
                                    {"c3", l.c3, true},
                                    {"c4", l.c4, false}});
    }
};

SixArm six_arm(const SixJoints& six) {
    const auto* table = std::get_if<SixJoints::Table>(&six.geometry);
    const JointChain nominal =
        table != nullptr ? chain_of(table->rows, table->convention) : chain_of(std::get<WristArmLengths>(six.geometry));
    const bool as_written = six.deviations == LinkDeviations{};
    return {as_written ? nominal : deviated(nominal, six.deviations), nominal};
}

std::optional<Error> check_joint(std::string_view kind, std::size_t number, const JointSettings& s) {
    const auto error = [&](std::string what, std::string remedy) {
        return Error{"kinematics.joint", fmt::format("{}, joint {}", kind, number), std::move(what), std::move(remedy)};
    };
    if (s.sign != 1 && s.sign != -1) return error(fmt::format("sign is {}", s.sign), "Give 1, or -1 to count the other way");
    if (!std::isfinite(s.zero)) return error(fmt::format("zero is {}", s.zero), "Give a number");
    if (!std::isfinite(s.unit) || s.unit <= 0)
        return error(fmt::format("unit is {}", s.unit), "Give the axis' unit in rad, or in the unit of length, above 0");
    if (!(s.low < s.high))
        return error(fmt::format("its limits are {} to {}", s.low, s.high), "Give a lower limit that is below the upper one");
    return std::nullopt;
}

/// What is no joint must couple to nothing.
bool couples_only_joints(const Coupling& c, std::size_t joints) {
    for (std::size_t i = 0; i < max_joints; ++i)
        for (std::size_t k = 0; k < max_joints; ++k)
            if ((i >= joints || k >= joints) && c[i][k] != (i == k ? 1 : 0)) return false;
    return true;
}

/// Whether the axes say where the joints are, and not only just: of gears that nearly cancel the rest would be rounding. Its determinant, which no unit
/// changes; 1 where each axis is a joint.
bool tells_joints(const Coupling& c) noexcept {
    constexpr double least = 1e-6;
    JointMatrix m;
    for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index k = 0; k < 6; ++k) m(i, k) = c[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    return std::abs(m.determinant()) >= least;
}

/// The belt's, and then what the description says on top: axes = given * belt * joints.
Coupling with_belt(const Coupling& given) {
    Coupling c = given;
    for (auto& row : c) {
        const double first = row[0], second = row[1];
        row[0] = first + second;
        row[1] = first - second;
    }
    return c;
}

}  // namespace

std::string_view kind_of(const ArmDescription& arm) noexcept {
    constexpr std::string_view kinds[] = {"cartesian",  "beam_gantry",  "core_xy",      "scara",
                                          "palletizer", "rotary_delta", "linear_delta", "six_joints"};
    static_assert(std::size(kinds) == std::variant_size_v<ArmDescription>);
    return kinds[arm.index()];
}

Result<Kinematics> Kinematics::make(const KinematicsDescription& description) {
    const std::string_view kind = kind_of(description.arm);
    if (auto error = std::visit(Checks{kind}, description.arm)) return *error;

    Kinematics k;
    Coupling coupling = description.coupling;
    if (const auto* a = std::get_if<CartesianAxes>(&description.arm)) k.arm_ = Cartesian{*a};
    if (const auto* a = std::get_if<BeamGantryShape>(&description.arm)) k.arm_ = BeamGantry{*a};
    if (const auto* a = std::get_if<ScaraLengths>(&description.arm)) k.arm_ = Scara{*a};
    if (const auto* a = std::get_if<PalletizerLengths>(&description.arm)) k.arm_ = Palletizer{*a};
    if (const auto* a = std::get_if<RotaryDeltaLengths>(&description.arm)) k.arm_ = RotaryDelta{*a};
    if (const auto* a = std::get_if<LinearDeltaLengths>(&description.arm)) k.arm_ = LinearDelta{*a};
    if (const auto* a = std::get_if<SixJoints>(&description.arm)) k.arm_ = six_arm(*a);
    if (const auto* a = std::get_if<CoreXyAxes>(&description.arm)) {
        k.arm_ = Cartesian{{{true, true, a->lift}, a->turns ? 2 : -1}};
        coupling = with_belt(description.coupling);
    }

    k.kind_ = static_cast<std::uint8_t>(description.arm.index());
    if (const auto* six = std::get_if<SixJoints>(&description.arm)) {
        const auto* table = std::get_if<SixJoints::Table>(&six->geometry);
        k.rows_ = table != nullptr ? *table : SixJoints::Table{table_of(std::get<WristArmLengths>(six->geometry)), DhConvention::classic};
    }

    k.joint_count_ = std::visit([](const auto& arm) { return arm.joint_count(); }, k.arm_);
    k.rotary_ = std::visit([](const auto& arm) { return arm.rotary(); }, k.arm_);
    if (const auto* six = std::get_if<SixArm>(&k.arm_); six != nullptr && !six->sound())
        return Error{"kinematics.geometry", std::string(kind), "axes 1 and 2 are parallel, or two joints are one",
                     "Give an arm whose first axis crosses the second one, with links that have a length; check the convention of the "
                     "table, and that `a` and `d` are not swapped"};
    for (std::size_t i = 0; i < k.joint_count(); ++i)
        if (auto error = check_joint(kind, i + 1, description.joints[i])) return *error;
    k.map_ = AxisMap{description.joints, coupling};
    if (!k.map_.sound() || !tells_joints(description.coupling) || !couples_only_joints(description.coupling, k.joint_count()))
        return Error{"kinematics.coupling", std::string(kind), "the matrix has no inverse, or couples axes that this arm does not have",
                     "Give in row i how far axis i moves for one unit of each joint"};
    const double length = orientation_of(description.base).norm();
    if (!(std::abs(length - 1) < 1e-6) ||
        !std::all_of(description.base.position.begin(), description.base.position.end(), [](double v) { return std::isfinite(v); }))
        return Error{"kinematics.base", std::string(kind), fmt::format("the base's orientation has the length {}", length),
                     "Give a unit quaternion"};
    k.base_pose_ = pose_of(position_of(description.base), orientation_of(description.base).normalized());
    k.base_ = frame_of(k.base_pose_);
    k.to_base_ = inverse_of(k.base_);
    k.reach_ = std::visit([](const auto& arm) { return arm.reach(); }, k.arm_);
    return k;
}

}  // namespace taktwerk::axes
