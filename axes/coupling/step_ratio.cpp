#include "axes/coupling/step_ratio.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

namespace {

__extension__ using Wide = __int128;

constexpr int wide_bits = 110;     // of each of the two numbers
constexpr int largest_bits = 126;  // of any sum

/// value = digits * 2^exponent, digits odd.
struct Binary {
    std::int64_t digits = 0;
    int exponent = 0;
};

Binary binary(double value) noexcept {
    Binary made;
    made.digits = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &made.exponent), 53));
    made.exponent -= 53;
    while (made.digits != 0 && made.digits % 2 == 0) made.digits /= 2, ++made.exponent;
    return made;
}

Wide magnitude(Wide value) noexcept { return value < 0 ? -value : value; }

int bits(Wide value) noexcept {
    int count = 0;
    for (value = magnitude(value); value != 0; value /= 2) ++count;
    return count;
}

Wide common_divisor(Wide a, Wide b) noexcept {
    a = magnitude(a), b = magnitude(b);
    while (b != 0) {
        const Wide rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

}  // namespace

bool StepRatio::set(double from, std::int64_t numerator, std::int64_t denominator, double to) noexcept {
    *this = {};
    if (!(from > 0) || !(to > 0) || std::isinf(from) || std::isinf(to) || denominator == 0) return false;
    const Binary source = binary(from), target = binary(to);
    Wide grow = static_cast<Wide>(source.digits) * numerator * (denominator < 0 ? -1 : 1);
    Wide step = static_cast<Wide>(target.digits) * (denominator < 0 ? -static_cast<Wide>(denominator) : denominator);
    if (const Wide common = common_divisor(grow, step); common > 1) grow /= common, step /= common;
    const int shift = source.exponent - target.exponent;
    // Odd digits cancel no twos of the shift: what has to be shifted must fit.
    auto& shifted = shift >= 0 ? grow : step;
    if (bits(shifted) + std::abs(shift) > wide_bits || bits(grow) > wide_bits || bits(step) > wide_bits) return false;
    shifted *= static_cast<Wide>(1) << std::abs(shift);
    if (const Wide common = common_divisor(grow, step); common > 1) grow /= common, step /= common;

    grow_ = grow;
    step_ = step;
    to_ = to;
    const int free_bits = largest_bits - std::max(bits(grow), bits(step));
    chunk_ = static_cast<std::int64_t>(1) << std::min(free_bits, 62);
    return true;
}

void StepRatio::advance(std::int64_t steps) noexcept {
    while (steps != 0) {
        const std::int64_t now = std::clamp(steps, -chunk_, chunk_);
        steps -= now;
        const Wide sum = rest_ + grow_ * now;
        Wide carried = sum / step_;
        Wide left = sum % step_;
        if (left < 0) left += step_, --carried;
        rest_ = left;
        whole_ += static_cast<std::int64_t>(carried);
    }
}

}  // namespace taktwerk::axes
