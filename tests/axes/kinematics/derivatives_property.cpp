// Jacobians against a complex step through the forward formulas and against differences; derivatives of the axes along a path against
// differences of the inverse.

#include <complex>

#include <gtest/gtest.h>

#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/random_stands.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

using Complex = std::complex<double>;
constexpr double complex_step = 1e-40;  // no difference is taken, so nothing cancels

/// The Jacobian of an arm's flange in its base, from its forward formulas alone: the imaginary parts are the derivatives.
template <class Arm>
Jacobian by_complex_step(const Arm& arm, const Joints& q, std::size_t joints) {
    Jacobian j = Jacobian::Zero();
    for (std::size_t i = 0; i < joints; ++i) {
        std::array<Complex, max_joints> z;
        for (std::size_t k = 0; k < max_joints; ++k) z[k] = {q[k], k == i ? complex_step : 0};
        const Frame<Complex> f = arm.forward(z);
        Eigen::Vector3d turn = Eigen::Vector3d::Zero();
        for (const auto& axis : f.axis) {
            const Triple<double> real{axis[0].real(), axis[1].real(), axis[2].real()};
            const Triple<double> imaginary{axis[0].imag(), axis[1].imag(), axis[2].imag()};
            turn += 0.5 * vector_of(cross(real, imaginary));
        }
        const auto column = static_cast<Eigen::Index>(i);
        j.block<3, 1>(0, column) = Eigen::Vector3d{f.origin[0].imag(), f.origin[1].imag(), f.origin[2].imag()} / complex_step;
        j.block<3, 1>(3, column) = turn / complex_step;
    }
    return j;
}

/// The arms without their signs, zeros and couplings: the facade then counts as the formulas do.
template <class Arm>
void expect_complex_step(const Arm& arm, PublishedArm published) {
    SCOPED_TRACE(published.name);
    published.description.joints = {};
    published.description.coupling = uncoupled;
    const Kinematics kinematics = made(published);
    RandomStands random{3};
    const std::size_t cases = property_cases(200);
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < cases; ++i) {
        const Joints q = random.next(published, kinematics.rotary());
        if (!kinematics.forward(q, {}).miss.ok() || kinematics.singularity(q).measure < 1e-3) continue;
        ++looked_at;
        const Jacobian difference = kinematics.jacobian(q, {}) - by_complex_step(arm, q, kinematics.joint_count());
        ASSERT_LT(difference.cwiseAbs().maxCoeff(), 1e-11) << ::testing::PrintToString(q);
    }
    EXPECT_GT(looked_at, cases / 4);
}

JointChain chain_of_arm(const PublishedArm& arm) {
    const auto& six = std::get<SixJoints>(arm.description.arm);
    const auto* table = std::get_if<SixJoints::Table>(&six.geometry);
    return deviated(table != nullptr ? chain_of(table->rows, table->convention) : chain_of(std::get<WristArmLengths>(six.geometry)),
                    six.deviations);
}

TEST(DerivativesProperty, JacobianIsThatOfTheComplexStep) {
    for (const PublishedArm& arm : {irb_120(), irb_2400(), tx40(), ur5e(), crx_10ia(), calibrated(irb_120())})
        expect_complex_step(chain_of_arm(arm), arm);
    expect_complex_step(Scara{std::get<ScaraLengths>(epson_g10().description.arm)}, epson_g10());
    expect_complex_step(Palletizer{std::get<PalletizerLengths>(irb_460().description.arm)}, irb_460());
    expect_complex_step(RotaryDelta{std::get<RotaryDeltaLengths>(flexpicker().description.arm)}, flexpicker());
    expect_complex_step(LinearDelta{std::get<LinearDeltaLengths>(linear_delta().description.arm)}, linear_delta());
    expect_complex_step(Cartesian{std::get<CartesianAxes>(cartesian().description.arm)}, cartesian());
    expect_complex_step(BeamGantry{std::get<BeamGantryShape>(beam_gantry().description.arm)}, beam_gantry());
}

PublishedArm mounted(PublishedArm arm) {
    arm.description.base = posed(.4, -.3, 1.1, 2.1, -.7, .5);
    return arm;
}

/// Wrist couplings, degrees, and a sense against the arm's: everything that stands between axes and joints.
PublishedArm coupled_kr6() {
    PublishedArm arm = mounted(kr6_r900());
    arm.description.coupling[4][3] = .02;
    arm.description.coupling[5][3] = -.015;
    arm.description.coupling[5][4] = .08;
    for (JointSettings& j : arm.description.joints) j.unit = degree;
    for (std::size_t i = 0; i < 6; ++i) arm.low[i] /= degree, arm.high[i] /= degree;
    return arm;
}

// With tool, base, senses, units and couplings: the Jacobian foretells where the tool goes when an axis moves a little.
TEST(DerivativesProperty, JacobianIsThatOfDifferences) {
    const Pose tool = posed(.05, -.02, .11, .3, -.2, .9);
    std::vector<PublishedArm> arms = published_arms();
    for (PublishedArm& arm : arms) arm = mounted(arm);
    arms.push_back(coupled_kr6());
    for (const PublishedArm& arm : arms) {
        SCOPED_TRACE(arm.name);
        const Kinematics kinematics = made(arm);
        RandomStands random{5};
        const std::size_t cases = property_cases(50);
        std::size_t looked_at = 0;
        for (std::size_t i = 0; i < cases; ++i) {
            const Joints q = random.next(arm, kinematics.rotary());
            if (!kinematics.forward(q, tool).miss.ok() || kinematics.singularity(q).measure < 1e-2) continue;
            ++looked_at;
            const Jacobian j = kinematics.jacobian(q, tool);
            for (std::size_t k = 0; k < max_joints; ++k) {
                const auto column = static_cast<Eigen::Index>(k);
                if (k >= kinematics.joint_count()) {
                    ASSERT_EQ(j.col(column).norm(), 0);
                    continue;
                }
                const double h = 1e-6 / kinematics.map().settings(k).unit;
                Joints before = q, after = q;
                before[k] -= h;
                after[k] += h;
                const Pose a = kinematics.forward(before, tool).pose, b = kinematics.forward(after, tool).pose;
                const Eigen::Quaterniond turn = orientation_of(b) * orientation_of(a).conjugate();
                const Eigen::Vector3d speed = (position_of(b) - position_of(a)) / (2 * h),
                                      spin = (turn.w() < 0 ? -2 : 2) * turn.vec() / (2 * h);
                ASSERT_LT((j.block<3, 1>(0, column) - speed).norm(), 1e-8);
                ASSERT_LT((j.block<3, 1>(3, column) - spin).norm(), 1e-8);
            }
        }
        EXPECT_GT(looked_at, cases / 4);
    }
}

/// A way that bends and turns: polynomials of the third degree, two rotations about axes that do not agree.
struct BentPath {
    Pose start;
    Eigen::Vector3d v, a, j;        // m
    Eigen::Vector3d first, second;  // unit vectors
    std::array<double, 3> by_first, by_second;

    static double at(const std::array<double, 3>& d, double s) { return d[0] * s + d[1] * s * s / 2 + d[2] * s * s * s / 6; }
    Pose pose(double s) const {
        const Eigen::Quaterniond turn{Eigen::AngleAxisd(at(by_first, s), first) * Eigen::AngleAxisd(at(by_second, s), second)};
        return pose_of(position_of(start) + v * s + a * s * s / 2 + j * s * s * s / 6, turn * orientation_of(start));
    }
    /// At s = 0. With R = E1 E2 R0 the angular velocity is a t1' + E1 b t2'; E1' = [a t1'] E1 gives the rest.
    PathDerivatives derivatives() const {
        const auto& [p, p1, p2] = by_first;
        const auto& [q, q1, q2] = by_second;
        const Eigen::Vector3d across = first.cross(second);
        const Eigen::Vector3d w = first * p + second * q, w1 = first * p1 + second * q1 + across * (p * q);
        const Eigen::Vector3d w2 = first * p2 + second * q2 + across * (2 * p * q1 + p1 * q) + first.cross(across) * (p * p * q);
        return {{triple_of(v), triple_of(a), triple_of(j)}, {triple_of(w), triple_of(w1), triple_of(w2)}};
    }
};

/// Central differences over seven points, wrong in the sixth (fourth) order: first, second, third derivative.
Joints differentiated(const std::array<Joints, 7>& q, double h, int order) {
    constexpr double weights[3][7] = {{-1. / 60, 3. / 20, -3. / 4, 0, 3. / 4, -3. / 20, 1. / 60},
                                      {1. / 90, -3. / 20, 3. / 2, -49. / 18, 3. / 2, -3. / 20, 1. / 90},
                                      {1. / 8, -1, 13. / 8, 0, -13. / 8, 1, -1. / 8}};
    Joints d{};
    for (std::size_t k = 0; k < 7; ++k)
        for (std::size_t i = 0; i < max_joints; ++i) d[i] += weights[order - 1][k] * q[k][i] / std::pow(h, order);
    return d;
}

// K-06: q', q'' and q''' along a path, against seven stands of the inverse beside it.
TEST(DerivativesProperty, AxesAlongAPathAreThoseOfDifferences) {
    const Pose tool = posed(.05, -.02, .11, 0, 0, 0);
    std::vector<PublishedArm> arms;
    for (const PublishedArm& arm : published_arms()) arms.push_back(mounted(arm));
    arms.push_back(coupled_kr6());
    for (const PublishedArm& arm : arms) {
        SCOPED_TRACE(arm.name);
        const Kinematics kinematics = made(arm);
        const auto commands = kinematics.commands();
        RandomStands random{9};
        const auto vector = [&](double size) {
            return Eigen::Vector3d{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
        };
        const std::size_t cases = property_cases(60);
        std::size_t looked_at = 0;
        for (std::size_t i = 0; i < cases; ++i) {
            Joints q = random.next(arm, kinematics.rotary());
            if (std::holds_alternative<BeamGantryShape>(arm.description.arm)) q[1] = q[0];
            const ForwardResult start = kinematics.forward(q, tool);
            if (!start.miss.ok() || kinematics.singularity(q).measure < (kinematics.closed_form() ? 0.3 : 0.03)) continue;
            // Only what the arm commands moves, in its base; the others stay at 0.
            const Eigen::Quaterniond base = orientation_of(kinematics.base());
            const auto commanded = [&](Eigen::Vector3d m, std::size_t from) {
                for (std::size_t k = 0; k < 3; ++k)
                    if (!commands[from + k]) m[static_cast<Eigen::Index>(k)] = 0;
                return m;
            };
            BentPath path{start.pose,
                          base * commanded(vector(.3), 0),
                          base * commanded(vector(.3), 0),
                          base * commanded(vector(.3), 0),
                          base * Eigen::Vector3d::UnitZ(),
                          base * Eigen::Vector3d::UnitZ(),
                          {},
                          {}};
            if (commands[3] && commands[4]) path.first = vector(1).normalized(), path.second = vector(1).normalized();
            if (commands[5])
                for (std::size_t k = 0; k < 3; ++k) path.by_first[k] = random.uniform(-.5, .5), path.by_second[k] = random.uniform(-.5, .5);

            // First and second derivative want a small step, for what differences leave out; the third a larger one, for their rounding.
            std::array<Joints, 7> close, wide;
            const auto walk = [&](double h, std::array<Joints, 7>& stands) {
                Configuration same = kinematics.configuration(q);
                same.turns.fill(any_turn);
                Joints near = q;
                for (std::size_t k = 0; k < 7; ++k) {
                    const AxisSolution way = kinematics.inverse(path.pose(h * (static_cast<double>(k) - 3)), tool, same, near);
                    if (!way.ok()) return false;  // beyond the reach a little further on
                    stands[k] = near = way.axes;
                }
                return true;
            };
            if (!walk(2e-4, close) || !walk(1e-3, wide)) continue;
            const AxisDerivatives d = kinematics.derivatives(close[3], tool, path.derivatives());

            ++looked_at;
            ASSERT_TRUE(d.miss.ok());
            for (int order = 1; order <= 3; ++order) {
                const Joints expected = order < 3 ? differentiated(close, 2e-4, order) : differentiated(wide, 1e-3, order);
                double size = 1 / kinematics.map().settings(0).unit;
                for (const double v : expected) size = std::max(size, std::abs(v));
                constexpr double left_out[] = {1e-8, 1e-6, 5e-3};  // by differences of the sixth and fourth order, relative
                for (std::size_t k = 0; k < max_joints; ++k)
                    ASSERT_NEAR(d.of[static_cast<std::size_t>(order - 1)][k], expected[k], left_out[order - 1] * size)
                        << "order " << order << " axis " << k;
            }
        }
        EXPECT_GT(looked_at, cases / 10);
    }
}

// In a singularity velocities have no answer, and that is said.
TEST(DerivativesProperty, SingularStandsSaySo) {
    PathDerivatives path;
    path.position[0] = {.1, .2, .3};
    const AxisDerivatives wrist = made(irb_120()).derivatives(degrees({10, 20, 30, 40, 0, 50}), {}, path);
    EXPECT_EQ(wrist.miss.fault, KinematicFault::singular);
    EXPECT_LT(wrist.miss.amount, 1e-15);
    EXPECT_EQ(made(epson_g10()).derivatives(degrees({10, 0, 0, 0, 0, 0}), {}, path).miss.fault, KinematicFault::singular);
    EXPECT_TRUE(made(epson_g10()).derivatives(degrees({10, 5, 0, 0, 0, 0}), {}, path).miss.ok());
}

}  // namespace
}  // namespace taktwerk::axes
