#pragma once
// Motion laws of cam segments after VDI 2143, Part 1: pure functions, real-time safe, in constant time. A law is two changes of velocity, one
// behind the other: from that of the first point to one in the middle, and from there to that of the second point. They meet at the inflection,
// where the acceleration changes its sign. What differs between the laws is the form of a change:
//
//   quadratic parabola      constant acceleration
//   inclined sine           half a wave of sine (Bestehorn)
//   modified trapezoid      a quarter of a wave up, constant, a quarter down
//   simple sine             a quarter of a wave of cosine: begins and ends with acceleration, so it turns back without a rest
//   modified sine           up within an eighth of the segment, down over three eighths
//   harmonic combination    a modified sine where it rests or passes on, a quarter of a wave where it turns back
//
// Motion tasks: rest, velocity and turning point as the points say it. See docs/motion/cam-laws.md.

#include <cstdint>

namespace taktwerk::axes {

/// How the way from a point to the next one is filled.
enum class CamSegment : std::uint8_t {
    linear,              ///< straight: the velocity jumps at the points
    spline,              ///< cubic spline through a run of such points: position, velocity and acceleration continuous inside the run
    quintic,             ///< polynomial of fifth order with the velocity and acceleration given at both of its points (3-4-5 between rests)
    quadratic_parabola,  ///< from here on: the velocity given at both points
    simple_sine,
    inclined_sine,
    modified_trapezoid,
    modified_sine,
    harmonic_combination,  ///< turning points are those with an acceleration and no velocity; at least one of the two is one
};

/// Slave position and its derivatives with respect to the master's position.
struct CamValue {
    double position = 0;
    double first = 0;   ///< du/dM
    double second = 0;  ///< d2u/dM2
};

struct LawValue {
    double position = 0, velocity = 0, acceleration = 0, jerk = 0;
};

/// The law from rest to rest over a unit of both: 0 <= z <= 1. Where the acceleration steps the jerk is that beside the step. Of a spline, which
/// is no law, and of harmonic_combination, which cannot rest at both ends, nothing but zeros.
[[nodiscard]] LawValue normalised_law(CamSegment law, double z) noexcept;

/// The largest velocity, acceleration and jerk of normalised_law: Cv, Ca, Cj. A slave that goes the way H while its master goes B at the velocity V
/// reaches Cv H/B V, Ca H/B^2 V^2 and Cj H/B^3 V^3. Infinite where it steps; zeros where there is no such law.
struct LawPeaks {
    double velocity = 0, acceleration = 0, jerk = 0;
};
[[nodiscard]] LawPeaks peaks_of(CamSegment law) noexcept;

/// One end of a segment: u, and its derivatives with respect to the master.
struct LawEnd {
    double slave = 0, velocity = 0, acceleration = 0;
};

/// A law between two points. The velocities at the ends may be any; laws other than the harmonic combination ignore the accelerations. Where the form of
/// the change allows it (parabola, inclined sine, trapezoid) the inflection lies where the peak of the acceleration is least; else in the middle.
class CamLawCurve {
public:
    /// False where the law cannot join these ends, or is none of these laws. `width`: of the master, > 0.
    [[nodiscard]] bool set(CamSegment law, double width, const LawEnd& from, const LawEnd& to) noexcept;
    /// False before set().
    [[nodiscard]] explicit operator bool() const noexcept { return width_ > 0; }

    /// 0 <= x <= width.
    [[nodiscard]] LawValue at(double x) const noexcept;
    /// Where the acceleration changes its sign, as a part of the width: 0..1.
    [[nodiscard]] double inflection() const noexcept { return inflection_; }

    friend bool operator==(const CamLawCurve&, const CamLawCurve&) = default;

private:
    /// How a velocity changes.
    enum class Form : std::uint8_t { constant, half_wave, trapezoid, quarter_wave, skewed };
    struct Change {
        Form form = Form::constant;
        double from = 0;  // the velocity at the outer end
        double by = 0;    // what the middle has more than it
        double rate = 0;  // `by` over the part of the width
        friend bool operator==(const Change&, const Change&) = default;
    };
    struct Course {
        double way, velocity, acceleration, jerk;
    };
    [[nodiscard]] static Course course(Form form, double x) noexcept;
    [[nodiscard]] static double mean_of(Form form) noexcept;
    [[nodiscard]] bool turn(double mean, const LawEnd& from, const LawEnd& to) noexcept;
    void join(double mean) noexcept;
    void join_with_least_peak(double mean) noexcept;

    double width_ = 0;
    double begin_ = 0, end_ = 0;  // slave
    double inflection_ = 0.5;
    Change first_, second_;  // the second one backwards, from the last point
};

}  // namespace taktwerk::axes
