#include "axes/kinematics/planar_arms.hpp"

#include "axes/kinematics/level_turn.hpp"
#include "axes/kinematics/two_links.hpp"

namespace taktwerk::axes {

ArmSolutions Scara::solve(const Frame<double>& flange, const Joints& near) const noexcept {
    ArmSolutions found;
    double tilt = 0, lacking = 0;
    const double turn = turn_about(2, flange, tilt);
    TwoLinks ways[2];
    if (tilt > tilt_rounding) found.missed(KinematicFault::orientation, tilt);
    else if (!links_reach(l_.first, l_.second, flange.origin[0], flange.origin[1], near[0], ways, lacking))
        found.missed(KinematicFault::out_of_reach, lacking);
    else
        for (const TwoLinks& way : ways) {
            const double first = way.angle(), second = way.between();
            found.add({first, second, flange.origin[2] - l_.height, principal(turn - first - second)},
                      {.elbow = flag<Elbow>(&way == &ways[0] ? 1 : -1)});
        }
    return found;
}

Branch Scara::branch(const Joints& joints) const noexcept { return {.elbow = flag<Elbow>(std::sin(joints[1]))}; }

Singularity Scara::singularity(const Joints& joints) const noexcept { return {SingularityKind::elbow, std::abs(std::sin(joints[1]))}; }

ArmSolutions Palletizer::solve(const Frame<double>& flange, const Joints& near) const noexcept {
    ArmSolutions found;
    double tilt = 0;
    const double turn = turn_about(2, flange, tilt);
    if (tilt > tilt_rounding) {
        found.missed(KinematicFault::orientation, tilt);
        return found;
    }
    const double distance = std::hypot(flange.origin[0], flange.origin[1]);
    const double height = flange.origin[2] - l_.height + l_.drop;
    const double facing = distance < edge_rounding * reach() ? near[0] : std::atan2(flange.origin[1], flange.origin[0]);
    for (const double side : {1.0, -1.0}) {
        // Where joint 1 is free, both sides are looked at from where it stands.
        const double first = side > 0 || distance < edge_rounding * reach() ? facing : principal(facing + std::numbers::pi);
        TwoLinks ways[2];
        double lacking = 0;
        if (!links_reach(l_.upper, l_.fore, height, side * distance - l_.shoulder - l_.wrist, near[1], ways, lacking)) {
            found.missed(KinematicFault::out_of_reach, lacking);
            continue;
        }
        for (const TwoLinks& way : ways) {
            // Both from the vertical here; the forearm's joint counts from the horizon.
            const TwoLinks fore = way.with_end_turned();
            const Joints joints{first, way.angle(), std::atan2(-fore.cosine, fore.sine), principal(turn - first)};
            found.add(joints, {.shoulder = flag<Shoulder>(side), .elbow = flag<Elbow>(&way == &ways[0] ? 1 : -1)});
        }
    }
    return found;
}

Branch Palletizer::branch(const Joints& joints) const noexcept {
    return {.shoulder = flag<Shoulder>(radius(joints)), .elbow = flag<Elbow>(std::cos(joints[2] - joints[1]))};
}

Singularity Palletizer::singularity(const Joints& joints) const noexcept {
    Singularity s;
    s.consider(SingularityKind::shoulder, std::abs(radius(joints)) / reach());
    s.consider(SingularityKind::elbow, std::abs(std::cos(joints[2] - joints[1])));
    return s;
}

}  // namespace taktwerk::axes
