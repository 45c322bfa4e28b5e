#pragma once
// The transcendental functions of the control path. glibc picks variants of sin, exp, ... by CPU (with or without FMA),
// which differ in the last bits; a recording must replay to the same bytes on another machine. These use only
// + - * / and sqrt, which IEEE 754 fixes to the last bit (compiled without contraction).
//
// All functions: real-time safe, bounded work, any thread, no errno. NaN in gives NaN out.

#include <cmath>
#include <cstdint>
#include <limits>

namespace taktwerk::math {

/// IEEE 754 square root: correctly rounded on every CPU. Negative: NaN.
[[nodiscard]] inline double sqrt(double x) noexcept { return std::sqrt(x); }

/// Cube root, within 1 ulp. Sign and zero are kept.
[[nodiscard]] double cbrt(double x) noexcept;

/// Angles in rad. Within 1 ulp for |x| <= 2^20 rad (160 000 turns). Beyond that the angle is first reduced by fmod with
/// the double nearest to 2 pi, an error below |x| * 2^-54: what the last bit of the argument means anyway. Infinite: NaN.
[[nodiscard]] double sin(double x) noexcept;
[[nodiscard]] double cos(double x) noexcept;

/// e^x within 2 ulp; infinity above 709.78, 0 below -708.39 (no subnormal results: stepping threads flush them).
[[nodiscard]] double exp(double x) noexcept;

/// Natural logarithm within 2 ulp. 0: -infinity; negative: NaN; subnormal arguments count as 0.
[[nodiscard]] double log(double x) noexcept;

/// Nearest integer, halves away from zero; saturates at the ends of int64; NaN gives 0. Independent of the rounding mode.
[[nodiscard]] constexpr std::int64_t round_to_int64(double x) noexcept {
    constexpr double limit = 9223372036854775808.0;  // 2^63
    if (x >= limit) return std::numeric_limits<std::int64_t>::max();
    if (x < -limit) return std::numeric_limits<std::int64_t>::min();
    if (!(x == x)) return 0;
    const auto whole = static_cast<std::int64_t>(x);
    const double rest = x - static_cast<double>(whole);  // exact: beyond 2^52 it is 0
    return whole + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0);
}

/// Round to nearest, flush subnormals to zero: the floating-point environment of every thread that steps the machine.
/// Called once as such a thread starts (it is per thread, and a library may have changed it).
void set_stepping_thread_float_environment() noexcept;

/// The same for a scope, then back to what was set before: for tests and for virtual time on a borrowed thread.
class SteppingFloatEnvironment {
public:
    SteppingFloatEnvironment() noexcept;
    ~SteppingFloatEnvironment();
    SteppingFloatEnvironment(const SteppingFloatEnvironment&) = delete;
    SteppingFloatEnvironment& operator=(const SteppingFloatEnvironment&) = delete;

private:
    std::uint64_t before_;
};

}  // namespace taktwerk::math
