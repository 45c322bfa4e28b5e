#include "axes/planner/extremal.hpp"

#include <limits>

namespace taktwerk::axes {

namespace {

double sign_of(Curve c) noexcept { return c == Curve::peak_down || c == Curve::trough_down || c == Curve::early_trough_down ? -1 : 1; }

/// The problem in the frame in which the curve is a push upwards.
Problem in_frame(const Problem& p, Curve c) noexcept {
    switch (c) {
        case Curve::peak_up:
        case Curve::trough_up: return p;
        case Curve::peak_down:
        case Curve::trough_down: return p.mirrored();
        case Curve::early_trough_up: return p.reversed();
        case Curve::early_trough_down: break;
    }
    return p.reversed().mirrored();
}

bool is_peak(Curve c) noexcept { return c == Curve::peak_up || c == Curve::peak_down; }

/// A trough exists only where an end has an acceleration of the curve's sign.
bool may_exist(const Problem& p, Curve c) noexcept {
    switch (c) {
        case Curve::trough_up: return p.a1 > 0;
        case Curve::trough_down: return p.a1 < 0;
        case Curve::early_trough_up: return p.a0 > 0;
        case Curve::early_trough_down: return p.a0 < 0;
        case Curve::peak_up:
        case Curve::peak_down: break;
    }
    return true;
}

/// A peak, and a trough whose other end has the other sign, pass acceleration 0.
bool keeps_limits_on(const Problem& p, Curve c, const Ends& ends) noexcept {
    if (is_peak(c)) return ends.start_releases && ends.end_releases;
    if (p.a0 * p.a1 > 0) return true;
    return c == Curve::trough_up || c == Curve::trough_down ? ends.start_releases : ends.end_releases;
}

/// From the reversed frame: accelerations stay, jerks change their sign.
void add_reversed(Chain& chain, std::span<const Stretch> stretches, double sign) noexcept {
    for (std::size_t i = stretches.size(); i-- > 0;) {
        const Stretch& s = stretches[i];
        if (s.duration > 0) chain.add({s.duration, s.end_acceleration(), -s.jerk, 0}, sign);
    }
}

/// The member that was found.
void write(const PeakFamily& family, const Extremal& extremal, Motion& motion) noexcept {
    const double sign = sign_of(extremal.curve);
    const PeakFamily::Motion m = family.at(extremal.found.parameter);
    motion.clear();
    add_climb(motion.forward, m.up, sign);
    // The cruise keeps its velocity to the last bit: over a long one the least difference would add up.
    const bool cruises = extremal.found.cruise > 0;
    if (cruises) motion.forward.add({extremal.found.cruise, 0, 0, m.peak_velocity - m.up.end_velocity()}, sign);
    add_descent(motion.backward, m.back, sign);
    // Both halves have no acceleration where they meet.
    if (!cruises && family.falls_gradually()) motion.forward.join(motion.backward);
}

void write(const TroughFamily& family, const Extremal& extremal, Motion& motion) noexcept {
    const double sign = sign_of(extremal.curve);
    const TroughFamily::Motion m = family.at(extremal.found.parameter);
    motion.clear();
    if (extremal.curve == Curve::trough_up || extremal.curve == Curve::trough_down) {
        add_climb(motion.forward, m.up, sign);
        motion.backward.add(m.last, sign);
    } else {
        add_reversed(motion.forward, std::array{m.last}, sign);
        add_reversed(motion.backward, m.up.stretches(), sign);
    }
}

constexpr std::array up_first{Curve::peak_up,     Curve::peak_down,       Curve::trough_up,
                              Curve::trough_down, Curve::early_trough_up, Curve::early_trough_down};
constexpr std::array down_first{Curve::peak_down, Curve::peak_up,           Curve::trough_down,
                                Curve::trough_up, Curve::early_trough_down, Curve::early_trough_up};

/// Is the way longer than that of the plain change of velocity? Roughly: it only says where to look first.
bool likely_up(const Problem& p) noexcept {
    const double change = p.v1 - p.released0;
    if (change == 0) return p.way >= 0;
    const double bound = change > 0 ? p.limits.up.speeding_up : p.limits.down.slowing_down;
    const double time = std::abs(change) / bound + bound * (p.limits.up.ease + p.limits.down.ease) / 2;
    return p.way >= (p.released0 + p.v1) / 2 * time;
}

Extremal in_time(const Problem& problem, double time, double slack, std::span<const Curve> curves) noexcept {
    for (const Curve c : curves) {
        if (!may_exist(problem, c)) continue;
        const Problem p = in_frame(problem, c);
        const Found found = is_peak(c) ? PeakFamily{p}.in_time(time, slack) : TroughFamily{p}.in_time(time, slack);
        if (found.found) return {c, found};
    }
    return {};
}

/// Between two curves that meet rounding may leave a gap: the end of a curve that comes closest.
Extremal nearest(const Problem& problem, std::span<const Curve> curves) noexcept {
    Extremal best;
    double least = std::numeric_limits<double>::infinity();
    for (const Curve c : curves) {
        if (!may_exist(problem, c)) continue;
        const Problem p = in_frame(problem, c);
        double miss = least;
        double duration = 0;
        if (is_peak(c)) {
            const auto m = PeakFamily{p}.measured(0);
            miss = std::abs(m.travel() - p.way);
            duration = m.duration();
        } else if (const TroughFamily family{p}; family.exists()) {
            const auto m = family.at(0);
            miss = std::abs(m.travel() - p.way);
            duration = m.duration();
        }
        if (miss >= least) continue;
        least = miss;
        best = {c, {true, 0, 0, duration}};
    }
    return best;
}

}  // namespace

void add_climb(Chain& chain, const Ramp& ramp, double sign) noexcept {
    for (const Stretch& s : ramp.stretches()) chain.add(s, sign);
}

void add_descent(Chain& chain, const Ramp& back, double sign) noexcept {
    // Mirrored and reversed: jerks and velocity steps keep their sign, accelerations do not.
    double step = 0;
    const auto stretches = back.stretches();
    for (std::size_t i = stretches.size(); i-- > 0;) {
        const Stretch& s = stretches[i];
        if (s.duration > 0) chain.add({s.duration, -s.end_acceleration(), s.jerk, step}, sign);
        else if (step != 0) chain.add({0, 0, 0, step}, sign);
        step = -s.velocity_step;
    }
    if (step != 0) chain.add({0, 0, 0, step}, sign);
}

FastestMotion fastest(const Problem& problem, double rounding, const Ends& ends) noexcept {
    // With one end at rest the ends of the curves follow each other: the first root found is the only one.
    const bool only_one = (problem.v1 == 0 && problem.a1 == 0) || (problem.v0 == 0 && problem.a0 == 0);
    FastestMotion best;
    int looked_at = 0;
    const auto search = [&](const auto& family, Curve c) noexcept {
        const Found found = family.over_way(rounding, best.found.duration);
        looked_at += found.looked_at;
        if (!found.found || found.duration >= best.found.duration) return;
        best.found = found;
        write(family, {c, found}, best.motion);
    };
    for (const Curve c : likely_up(problem) ? up_first : down_first) {
        if (!may_exist(problem, c) || !keeps_limits_on(problem, c, ends)) continue;
        const Problem p = in_frame(problem, c);
        if (is_peak(c)) search(PeakFamily{p}, c);
        else search(TroughFamily{p}, c);
        if (only_one && best.found.found && best.found.parameter > 0) break;  // at its very end a curve meets the next one
    }
    if (!best.found.found && ends.start_releases && ends.end_releases) {
        const Extremal e = nearest(problem, up_first);
        best.found = e.found;
        if (e.found.found) best.motion = motion_of(problem, e);
    }
    best.found.looked_at = looked_at;
    return best;
}

Extremal furthest(const Problem& problem, double time, double slack) noexcept {
    constexpr std::array curves{Curve::peak_up, Curve::trough_up, Curve::early_trough_down};
    return in_time(problem, time, slack, curves);
}

Extremal least_far(const Problem& problem, double time, double slack) noexcept {
    constexpr std::array curves{Curve::peak_down, Curve::trough_down, Curve::early_trough_up};
    return in_time(problem, time, slack, curves);
}

Motion motion_of(const Problem& problem, const Extremal& extremal) noexcept {
    const Problem p = in_frame(problem, extremal.curve);
    Motion motion;
    if (is_peak(extremal.curve)) write(PeakFamily{p}, extremal, motion);
    else write(TroughFamily{p}, extremal, motion);
    return motion;
}

}  // namespace taktwerk::axes
