#include "runtime/retain/value_type.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace taktwerk::runtime {

namespace {

using Kind = fb::PinKind;

// Holds every value of every type exactly.
using Number = long double;
static_assert(std::numeric_limits<Number>::digits >= 64);

struct Entry {
    Kind kind;
    std::string_view word;
    std::uint8_t size;
    bool is_signed;
};
constexpr std::array<Entry, 15> types{{
    {Kind::BOOL, "BOOL", 1, false},
    {Kind::SINT, "SINT", 1, true},
    {Kind::INT, "INT", 2, true},
    {Kind::DINT, "DINT", 4, true},
    {Kind::LINT, "LINT", 8, true},
    {Kind::USINT, "USINT", 1, false},
    {Kind::UINT, "UINT", 2, false},
    {Kind::UDINT, "UDINT", 4, false},
    {Kind::ULINT, "ULINT", 8, false},
    {Kind::REAL, "REAL", 4, true},
    {Kind::LREAL, "LREAL", 8, true},
    {Kind::WORD, "WORD", 2, false},
    {Kind::DWORD, "DWORD", 4, false},
    {Kind::TIME, "TIME", 8, true},
    {Kind::ENUM, "ENUM", 1, false},
}};

const Entry* entry(Kind kind) noexcept {
    for (const auto& type : types)
        if (type.kind == kind) return &type;
    return nullptr;
}
bool real(Kind kind) noexcept { return kind == Kind::REAL || kind == Kind::LREAL; }

std::int64_t sign_extended(const Entry& type, std::uint64_t bits) noexcept {
    const unsigned shift = 64 - 8 * type.size;
    return static_cast<std::int64_t>(bits << shift) >> shift;
}
std::uint64_t cut(const Entry& type, std::uint64_t bits) noexcept {
    return type.size == 8 ? bits : bits & ((std::uint64_t{1} << (8 * type.size)) - 1);
}
Number number_of(const Entry& type, std::uint64_t bits) noexcept {
    if (type.kind == Kind::LREAL) return std::bit_cast<double>(bits);
    if (type.kind == Kind::REAL) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    return type.is_signed ? static_cast<Number>(sign_extended(type, bits)) : static_cast<Number>(bits);
}
std::uint64_t real_bits(Kind kind, Number number) noexcept {
    return kind == Kind::LREAL ? std::bit_cast<std::uint64_t>(static_cast<double>(number))
                               : std::bit_cast<std::uint32_t>(static_cast<float>(number));
}
/// Whole numbers.
bool holds(const Entry& type, Number number) noexcept {
    if (number != std::floor(number)) return false;  // nor is a NaN
    if (type.kind == Kind::BOOL) return number == 0 || number == 1;
    const int bits = 8 * type.size - (type.is_signed ? 1 : 0);
    const Number end = std::ldexp(Number{1}, bits);
    return number < end && number >= (type.is_signed ? -end : Number{0});
}
std::uint64_t whole_bits(const Entry& type, Number number) noexcept {
    return cut(type, type.is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(number)) : static_cast<std::uint64_t>(number));
}

template <class T>
std::string shortest(T value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
template <class T>
std::optional<T> parsed(std::string_view text) noexcept {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::size_t size_of(Kind kind) noexcept {
    const auto* type = entry(kind);
    return type == nullptr ? 0 : type->size;
}

std::string_view word(Kind kind) noexcept {
    const auto* type = entry(kind);
    return type == nullptr ? std::string_view{"HANDLE"} : type->word;
}

std::optional<Kind> find_type(std::string_view text) noexcept {
    for (const auto& type : types)
        if (type.word == text) return type.kind;
    return std::nullopt;
}

std::string text_of(Kind kind, std::uint64_t bits) {
    const auto* type = entry(kind);
    if (type == nullptr) return "?";
    if (kind == Kind::LREAL || kind == Kind::REAL) {
        const auto number = number_of(*type, bits);
        if (std::isnan(number)) return "nan";  // whatever its sign and payload
        return kind == Kind::LREAL ? shortest(static_cast<double>(number)) : shortest(static_cast<float>(number));
    }
    return type->is_signed ? shortest(sign_extended(*type, bits)) : shortest(bits);
}

std::optional<std::uint64_t> bits_of(Kind kind, std::string_view text) noexcept {
    const auto* type = entry(kind);
    if (type == nullptr) return std::nullopt;
    if (kind == Kind::LREAL) {
        const auto number = parsed<double>(text);
        return number ? std::optional(real_bits(kind, *number)) : std::nullopt;
    }
    if (kind == Kind::REAL) {
        const auto number = parsed<float>(text);
        return number ? std::optional(real_bits(kind, *number)) : std::nullopt;
    }
    if (type->is_signed) {
        const auto number = parsed<std::int64_t>(text);
        return number && holds(*type, static_cast<Number>(*number)) ? std::optional(cut(*type, static_cast<std::uint64_t>(*number)))
                                                                    : std::nullopt;
    }
    const auto number = parsed<std::uint64_t>(text);
    return number && holds(*type, static_cast<Number>(*number)) ? std::optional(*number) : std::nullopt;
}

std::optional<Converted> converted(Kind from, std::uint64_t bits, Kind to) noexcept {
    const auto *source = entry(from), *target = entry(to);
    if (source == nullptr || target == nullptr) return std::nullopt;
    if (from == to) return Converted{cut(*target, bits), false};
    // A time is no number, and what the numbers of an enumeration mean only its own type knows.
    for (const auto kind : {Kind::TIME, Kind::ENUM})
        if (from == kind || to == kind) return std::nullopt;
    const auto number = number_of(*source, bits);
    if (!real(to)) return holds(*target, number) ? std::optional(Converted{whole_bits(*target, number), false}) : std::nullopt;
    const Converted out{real_bits(to, number), false};
    const auto back = number_of(*target, out.bits);
    if (back == number || (std::isnan(back) && std::isnan(number))) return out;
    // A count must stay itself; a measure may lose its last digits, but not become infinite or nothing.
    if (!real(from) || std::isinf(back) || back == 0) return std::nullopt;
    return Converted{out.bits, true};
}

}  // namespace taktwerk::runtime
