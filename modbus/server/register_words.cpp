#include "modbus/server/register_words.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace taktwerk::modbus::server {

namespace {

/// The nearest whole number of type T, as its bits.
template <class T>
std::uint32_t whole(double number) noexcept {
    using Limits = std::numeric_limits<T>;
    const T nothing = Limits::is_signed ? Limits::min() : Limits::max();
    if (std::isnan(number)) return static_cast<std::uint32_t>(nothing);
    const double bounded = std::clamp(std::round(number), static_cast<double>(Limits::min()), static_cast<double>(Limits::max()));
    return static_cast<std::uint32_t>(static_cast<T>(bounded));
}

RegisterWords two(WordOrder order, std::uint32_t bits) noexcept {
    const auto high = static_cast<std::uint16_t>(bits >> 16), low = static_cast<std::uint16_t>(bits & 0xFFFF);
    return order == WordOrder::high_first ? RegisterWords{high, low} : RegisterWords{low, high};
}

std::uint32_t both(WordOrder order, const RegisterWords& words) noexcept {
    const std::uint32_t first = words[0], second = words[1];
    return order == WordOrder::high_first ? first << 16 | second : second << 16 | first;
}

/// A double beyond the range of a float is infinity; the conversion itself would be undefined.
float nearest_float(double number) noexcept {
    constexpr double most = std::numeric_limits<float>::max();
    if (number > most) return std::numeric_limits<float>::infinity();
    if (number < -most) return -std::numeric_limits<float>::infinity();
    return static_cast<float>(number);
}

}  // namespace

RegisterWords words_of(const ServedRegister& to, double number) noexcept {
    switch (to.type) {
        case NumberType::boolean: {
            const bool set = number != 0 && !std::isnan(number);
            if (!set) return {0, 0};
            return {static_cast<std::uint16_t>(is_bits(to.table) ? 1u : 1u << to.bit), 0};
        }
        case NumberType::uint16: return {static_cast<std::uint16_t>(whole<std::uint16_t>(number) & 0xFFFF), 0};
        case NumberType::int16: return {static_cast<std::uint16_t>(whole<std::int16_t>(number) & 0xFFFF), 0};
        case NumberType::uint32: return two(to.order, whole<std::uint32_t>(number));
        case NumberType::int32: return two(to.order, whole<std::int32_t>(number));
        case NumberType::float32: break;
    }
    return two(to.order, std::bit_cast<std::uint32_t>(nearest_float(number)));
}

double number_of(const ServedRegister& from, const RegisterWords& words) noexcept {
    switch (from.type) {
        case NumberType::boolean: return is_bits(from.table) ? (words[0] != 0 ? 1 : 0) : (words[0] >> from.bit & 1);
        case NumberType::uint16: return words[0];
        case NumberType::int16: return static_cast<std::int16_t>(words[0]);
        case NumberType::uint32: return both(from.order, words);
        case NumberType::int32: return static_cast<std::int32_t>(both(from.order, words));
        case NumberType::float32: break;
    }
    return std::bit_cast<float>(both(from.order, words));
}

}  // namespace taktwerk::modbus::server
