#include "core/math.hpp"

#include <bit>
#include <initializer_list>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace taktwerk::math {
namespace {

constexpr double quiet_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The sum of two doubles, exactly: high is the rounded sum, low what rounding lost (Knuth's two-sum).
struct Exact {
    double high, low;
};

Exact sum(double a, double b) noexcept {
    const double s = a + b;
    const double part = s - a;
    return {s, (a - (s - part)) + (b - part)};
}

/// The product of two doubles, exactly, without FMA (Dekker). |a|, |b| < 2^996.
Exact product(double a, double b) noexcept {
    constexpr double splitter = 134217729.0;  // 2^27 + 1
    const double p = a * b;
    const double ca = splitter * a, cb = splitter * b;
    const double a1 = ca - (ca - a), a2 = a - a1;
    const double b1 = cb - (cb - b), b2 = b - b1;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

/// 2^n for -1022 <= n <= 1023.
double power_of_two(int n) noexcept { return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52); }

/// Nearest integer of a number well below 2^51, in round-to-nearest mode.
double nearest(double x) noexcept {
    constexpr double magic = 6755399441055744.0;  // 1.5 * 2^52: adding it leaves no fraction bits
    return (x + magic) - magic;
}

struct Reduced {
    double high, low;  ///< |high + low| <= pi/4
    unsigned quadrant;
};

/// x - n pi/2 with pi/2 in three pieces; n times the first two (33 bits each) is exact for n < 2^20 (Cody and Waite).
Reduced reduce(double x) noexcept {
    constexpr double two_pi = 0x1.921fb54442d18p+2;
    constexpr double pi_half_1 = 0x1.921fb54400000p+0;
    constexpr double pi_half_2 = 0x1.0b4611a600000p-34;
    constexpr double pi_half_3 = 0x1.3198a2e037073p-69;
    constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
    if (std::fabs(x) > 1048576.0) x = std::fmod(x, two_pi);  // fmod is exact, so the same everywhere
    const double n = nearest(x * two_over_pi);
    const double rest = x - n * pi_half_1;  // exact: the two are close or n is 0
    const Exact second = sum(rest, -(n * pi_half_2));
    const Exact third = sum(second.high, second.low - n * pi_half_3);
    return {third.high, third.low, static_cast<unsigned>(static_cast<int>(n)) & 3u};
}

// Taylor series: on |r| <= pi/4 the first term left out is below 2^-63 (sine) and 2^-58 (cosine) of the result.
double sine_kernel(double r, double low) noexcept {
    const double z = r * r;
    double p = 1.0 / 355687428096000.0;  // 1/17!
    p = p * z - 1.0 / 1307674368000.0;
    p = p * z + 1.0 / 6227020800.0;
    p = p * z - 1.0 / 39916800.0;
    p = p * z + 1.0 / 362880.0;
    p = p * z - 1.0 / 5040.0;
    p = p * z + 1.0 / 120.0;
    p = p * z - 1.0 / 6.0;
    return r + (r * z * p + low * (1.0 - 0.5 * z));
}

double cosine_kernel(double r, double low) noexcept {
    const double z = r * r;
    double p = 1.0 / 20922789888000.0;  // 1/16!
    p = p * z - 1.0 / 87178291200.0;
    p = p * z + 1.0 / 479001600.0;
    p = p * z - 1.0 / 3628800.0;
    p = p * z + 1.0 / 40320.0;
    p = p * z - 1.0 / 720.0;
    p = p * z + 1.0 / 24.0;
    const Exact head = sum(1.0, -0.5 * z);
    return head.high + (head.low + (z * z * p - r * low));
}

double of_quadrant(const Reduced& r, unsigned quadrant) noexcept {
    const double value = (quadrant & 1u) != 0 ? cosine_kernel(r.high, r.low) : sine_kernel(r.high, r.low);
    return (quadrant & 2u) != 0 ? -value : value;
}

}  // namespace

double sin(double x) noexcept {
    if (!std::isfinite(x)) return quiet_nan;
    if (x == 0) return x;  // keeps -0
    const Reduced r = reduce(x);
    return of_quadrant(r, r.quadrant);
}

double cos(double x) noexcept {
    if (!std::isfinite(x)) return quiet_nan;
    const Reduced r = reduce(x);
    return of_quadrant(r, (r.quadrant + 1) & 3u);
}

double cbrt(double x) noexcept {
    if (x == 0 || !std::isfinite(x)) return x;
    double a = std::fabs(x);
    double scale = 1.0;
    if (a < 0x1p-1000) a *= 0x1p+150, scale = 0x1p-50;      // away from subnormals,
    else if (a > 0x1p+900) a *= 0x1p-150, scale = 0x1p+50;  // and from the splitter's overflow
    // A third of the exponent (and, linearly, of the mantissa): within 6 %.
    double t = std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) / 3 + (std::uint64_t{682} << 52));
    for (int i = 0; i < 3; ++i) {  // Halley: 0.06 -> 2e-4 -> 5e-12 -> below rounding
        const double cube = t * t * t;
        t *= (cube + 2 * a) / (2 * cube + a);
    }
    // One Newton step whose residual t^3 - a is computed exactly enough to correct the last bit.
    const Exact square = product(t, t);
    const Exact cube = product(square.high, t);
    const double residual = ((cube.high - a) + cube.low) + square.low * t;
    t -= residual / (3 * square.high);
    return std::copysign(t * scale, x);
}

double exp(double x) noexcept {
    constexpr double ln2_high = 0x1.62e42fee00000p-1;  // 32 bits: times n it is exact
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    constexpr double one_over_ln2 = 0x1.71547652b82fep+0;
    if (x != x) return x;
    if (x > 709.782712893384) return infinity;
    if (x < -708.3964185322641) return 0.0;  // below the smallest normal number
    const double n = nearest(x * one_over_ln2);
    const double high = x - n * ln2_high;
    const double low = n * ln2_low;
    const double r = high - low;
    const double lost = (high - r) - low;
    // Taylor to r^13: |r| <= 0.347, the next term is below 2^-57.
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    const double value = 1.0 + (r + (r * r * p + (lost + lost * r)));
    const int half = static_cast<int>(n) / 2;  // in two steps: 2^1024 is not a double
    return value * power_of_two(half) * power_of_two(static_cast<int>(n) - half);
}

double log(double x) noexcept {
    constexpr double ln2_high = 0x1.62e42fee00000p-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    if (x != x || x == infinity) return x;
    if (std::fabs(x) < std::numeric_limits<double>::min()) return -infinity;
    if (x < 0) return quiet_nan;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    int exponent = static_cast<int>(bits >> 52) - 1023;
    double m = std::bit_cast<double>((bits & 0xF'FFFF'FFFF'FFFFu) | (std::uint64_t{1023} << 52));
    if (m > 1.4142135623730951) m *= 0.5, ++exponent;
    // log m = 2 artanh s, s = (m-1)/(m+1), |s| <= 0.1716; with f = m-1 (exact) it is f - s (f - 2 s^2 (1/3 + s^2/5 + ...)):
    // the large term stays exact and only small ones are rounded.
    const double f = m - 1.0;
    const double s = f / (2.0 + f);
    const double z = s * s;
    double p = 1.0 / 21.0;
    for (const double odd : {19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0}) p = p * z + 1.0 / odd;
    const double half_square = 0.5 * f * f;
    const double n = exponent;
    // 2 artanh s = f - f^2/2 + s (f^2/2 + 2 z p)
    const double small = s * (half_square + 2.0 * z * p) + n * ln2_low;
    return n * ln2_high - ((half_square - small) - f);
}

namespace {

#if defined(__x86_64__)
constexpr std::uint64_t stepping_bits = 0x8040;  // FTZ and DAZ
constexpr std::uint64_t rounding_bits = 0x6000;  // 00: to nearest
std::uint64_t float_control() noexcept { return _mm_getcsr(); }
void set_float_control(std::uint64_t bits) noexcept { _mm_setcsr(static_cast<unsigned>(bits)); }
#elif defined(__aarch64__)
constexpr std::uint64_t stepping_bits = std::uint64_t{1} << 24;  // FZ
constexpr std::uint64_t rounding_bits = std::uint64_t{3} << 22;  // RMode 00: to nearest
std::uint64_t float_control() noexcept {
    std::uint64_t bits = 0;
    asm volatile("mrs %0, fpcr" : "=r"(bits));
    return bits;
}
void set_float_control(std::uint64_t bits) noexcept { asm volatile("msr fpcr, %0" ::"r"(bits)); }
#else
#error "which control register holds rounding mode and flush-to-zero on this CPU?"
#endif

}  // namespace

void set_stepping_thread_float_environment() noexcept { set_float_control((float_control() & ~rounding_bits) | stepping_bits); }

SteppingFloatEnvironment::SteppingFloatEnvironment() noexcept : before_(float_control()) { set_stepping_thread_float_environment(); }

SteppingFloatEnvironment::~SteppingFloatEnvironment() {
    set_float_control((before_ & (rounding_bits | stepping_bits)) | (float_control() & ~(rounding_bits | stepping_bits)));
}

}  // namespace taktwerk::math
