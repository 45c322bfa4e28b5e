#include "axes/kinematics/six_arm.hpp"

#include <algorithm>

#include <Eigen/SVD>

#include "axes/kinematics/refine.hpp"

namespace taktwerk::axes {
namespace {

/// Two ways whose joints are nearer than this are one.
constexpr double same_way = 1e-7;

double distance(const Joints& a, const Joints& b) noexcept {
    double most = 0;
    for (std::size_t i = 0; i < 6; ++i) most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)));
    return most;
}

/// Whether they are one way: that of two joints which differ says it already.
bool same(const Joints& a, const Joints& b) noexcept {
    for (std::size_t i = 0; i < 6; ++i)
        if (!(std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)) < same_way)) return false;
    return true;
}

Joints principal_of(Joints joints) noexcept {
    for (double& j : joints) j = principal(std::remainder(j, 2 * std::numbers::pi));
    return joints;
}

}  // namespace

SixArm::SixArm(const JointChain& real, const JointChain& nominal) noexcept : chain_{real} {
    const auto at = nominal.frames({});
    const bool parallel = std::abs(dot(at[1].axis[2], at[3].axis[2])) > std::numbers::sqrt2 / 2;
    if (parallel) nominal_ = ParallelArm{nominal};
    else nominal_ = WristArm{nominal};
    reach_ = std::visit([](const auto& arm) { return arm.reach_of_links(); }, nominal_);
    const bool crossed = std::abs(dot(at[0].axis[2], at[1].axis[2])) < 0.99;
    const bool lengths = std::isfinite(reach_) && reach_ > 0;
    sound_ = crossed && lengths;
    if (!sound_) return;
    // In closed form if the closed form says so: some stands, away from what is singular in the usual arms, come back to rounding.
    exact_ = true;
    for (const Joints& stand :
         {Joints{0.3, -0.7, 0.9, 0.4, 0.8, -1.1}, Joints{-1.9, 0.5, -1.2, -2.3, -0.6, 0.2}, Joints{2.7, 1.3, 0.4, 1.7, 1.9, 2.8}}) {
        const Frame<double> flange = chain_.forward(stand);
        const ArmSolutions ways = solve_nominal(flange, stand);
        exact_ = exact_ && ways.count > 0;
        for (int i = 0; i < ways.count; ++i) {
            const Frame<double> back = chain_.forward(ways.at[static_cast<std::size_t>(i)].joints);
            exact_ = exact_ && (vector_of(back.origin) - vector_of(flange.origin)).norm() < 1e-12 * reach_;
            for (std::size_t k = 0; k < 3; ++k) exact_ = exact_ && (vector_of(back.axis[k]) - vector_of(flange.axis[k])).norm() < 1e-12;
        }
    }
}

ArmSolutions SixArm::solve_nominal(const Frame<double>& flange, const Joints& near) const noexcept {
    return std::visit([&](const auto& arm) { return arm.solve(flange, near); }, nominal_);
}

ArmSolutions SixArm::solve(const Frame<double>& flange, const Joints& near) const noexcept {
    const ArmSolutions seeds = solve_nominal(flange, near);
    if (exact_) return seeds;
    ArmSolutions found;
    found.miss = seeds.miss;
    const auto add = [&](const Joints& seed) {
        const Refined r = refine(chain_, flange, seed, reach_);
        if (!r.ok()) return found.missed(KinematicFault::no_convergence, r.left);
        const Joints joints = principal_of(r.joints);
        for (int k = 0; k < found.count; ++k)
            if (same(joints, found.at[static_cast<std::size_t>(k)].joints)) return;
        found.add(joints, branch(joints));
    };
    add(near);
    for (int i = 0; i < seeds.count && found.count < 8; ++i) add(seeds.at[static_cast<std::size_t>(i)].joints);
    return found;
}

ArmSolutions SixArm::solve_one(const Frame<double>& flange, const Branch& wanted, const Joints& near) const noexcept {
    if (exact_) return solve_nominal(flange, near);
    const ArmSolutions seeds = solve_nominal(flange, near);
    const auto rank = [&](const ArmSolution& s) { return distance(s.joints, near) + (answers(s.branch, wanted) ? 0 : 10); };
    struct Ranked {
        double rank = 0;
        const ArmSolution* way = nullptr;
    };
    std::array<Ranked, std::tuple_size_v<decltype(seeds.at)>> ranked;
    for (std::size_t i = 0; i < static_cast<std::size_t>(seeds.count); ++i) ranked[i] = {rank(seeds.at[i]), &seeds.at[i]};
    std::sort(ranked.begin(), ranked.begin() + seeds.count, [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
    ArmSolutions found;
    found.miss = seeds.miss;
    int steps = max_refine_steps_in_all;
    const auto add = [&](const Joints& seed) {
        const Refined r = refine(chain_, flange, seed, reach_, std::min(steps, max_refine_steps));
        steps -= r.steps;
        if (!r.ok()) return found.missed(KinematicFault::no_convergence, r.left), false;
        const Joints joints = principal_of(r.joints);
        found.add(joints, branch(joints));
        return answers(branch(joints), wanted);
    };
    // The joints that it comes from first, as long as the neighbour's nearest way is not far from them: then they are the better seed.
    const bool close = seeds.count == 0 || distance(ranked[0].way->joints, near) < 0.2;
    if (close && answers(branch(near), wanted) && add(near)) return found;
    for (int i = 0; i < seeds.count && found.count < 8 && steps > 0; ++i)
        if (add(ranked[static_cast<std::size_t>(i)].way->joints)) break;
    return found;
}

Branch SixArm::branch(const Joints& joints) const noexcept {
    return std::visit([&](const auto& arm) { return arm.branch(joints); }, nominal_);
}

Singularity SixArm::singularity(const Joints& joints) const noexcept {
    if (exact_) return std::visit([&](const auto& arm) { return arm.singularity(joints); }, nominal_);
    Jacobian j = jacobian(joints);
    j.topRows<3>() /= reach_;
    const Eigen::Matrix<double, 6, 1> values = Eigen::JacobiSVD<Jacobian>{j}.singularValues();
    return {SingularityKind::numeric, values[5] / values[0]};
}

}  // namespace taktwerk::axes
