#include "axes/kinematics/refine.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace taktwerk::axes {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A step turns no joint further than this: beyond it the tangent says nothing.
constexpr double longest_step = 0.5;
/// What is aimed at: below it is rounding. A last step from refine_rounding gets there, and keeps noise out of what is differentiated twice.
constexpr double aim = 3e-15;

struct Guess {
    std::array<Frame<double>, 7> frames;
    Vector6 error;  ///< position over reach; half the sum of what the axes lack, which is the rotation vector up to its third order
    double left = 0;
};

Guess guess_at(const JointChain& chain, const Frame<double>& flange, const Joints& joints, double reach) noexcept {
    Guess s;
    s.frames = chain.frames(joints);
    const Frame<double>& at = s.frames[6];
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    double agreement = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        turn += 0.5 * vector_of(cross(at.axis[k], flange.axis[k]));
        agreement += dot(at.axis[k], flange.axis[k]);
    }
    // Beyond a right angle the sine falls again: there its direction counts, at full length.
    if (agreement < 1 && turn.norm() > 0) turn *= (2 - turn.norm()) / turn.norm();
    s.error << (vector_of(flange.origin) - vector_of(at.origin)) / reach, turn;
    s.left = s.error.norm();
    return s;
}

}  // namespace

Refined refine(const JointChain& chain, const Frame<double>& flange, const Joints& seed, double reach, int steps) noexcept {
    Refined best{seed, 0, 0};
    Guess now = guess_at(chain, flange, seed, reach);
    best.left = now.left;
    double damping = 0;
    while (best.left > aim && best.steps < steps) {
        ++best.steps;
        Jacobian j = JointChain::jacobian(now.frames);
        j.topRows<3>() /= reach;
        Vector6 step;
        if (damping == 0) {
            step = j.partialPivLu().solve(now.error);
        } else {
            Jacobian normal = j.transpose() * j;
            normal.diagonal().array() += damping;
            step = normal.ldlt().solve(j.transpose() * now.error);
        }
        const double longest = step.cwiseAbs().maxCoeff();
        if (longest > longest_step) step *= longest_step / longest;
        Joints next = best.joints;
        for (std::size_t i = 0; i < 6; ++i) next[i] += step[static_cast<Eigen::Index>(i)];
        const Guess then = guess_at(chain, flange, next, reach);
        if (then.left < best.left) {
            // A damped step that gains most of the way says that the tangent is good again.
            damping = damping > 0 && then.left < 0.1 * best.left ? 0 : 0.2 * damping;
            if (damping < 1e-20) damping = 0;
            best.joints = next;
            best.left = then.left;
            now = then;
        } else if (best.left <= refine_rounding) {
            break;
        } else {
            damping = damping == 0 ? std::max(1e-18, best.left * best.left) : 10 * damping;
        }
    }
    return best;
}

}  // namespace taktwerk::axes
