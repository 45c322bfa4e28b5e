#pragma once
// How single values are read: each reports what it wanted, with an example, and leaves the member alone on a problem.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/reading/collections.hpp"
#include "config/reading/field_table.hpp"
#include "core/time.hpp"

namespace taktwerk::config {

/// Any text, not empty.
[[nodiscard]] Codec<std::string> text();
/// A name: letters, digits, `_`, `-`; starts with a letter.
[[nodiscard]] Codec<std::string> name();
[[nodiscard]] Codec<bool> boolean();
/// A number without a unit.
[[nodiscard]] Codec<double> number(double minimum = -std::numeric_limits<double>::max(),
                                   double maximum = std::numeric_limits<double>::max());
[[nodiscard]] Codec<double> quantity(Dimension dimension, double minimum = -std::numeric_limits<double>::max());
/// A quantity above 0, or `none` for infinity.
[[nodiscard]] Codec<double> quantity_or_none(Dimension dimension);
[[nodiscard]] Codec<Duration> duration(Duration minimum = Duration::zero(), Duration maximum = std::chrono::hours{24});
[[nodiscard]] Codec<ObjectAddress> object_address();
[[nodiscard]] Codec<Fraction> fraction();
/// [low, high] of an axis quantity, low < high.
[[nodiscard]] Codec<std::pair<double, double>> interval(Dimension dimension);

/// The integer in [minimum, maximum], decimal, 0x.. or ..h.
[[nodiscard]] std::optional<std::int64_t> read_integer(Reader& reader, const Node& node, std::int64_t minimum, std::int64_t maximum);

/// The largest values of unsigned objects, for `integer`.
inline constexpr std::int64_t u8 = 0xFF, u16 = 0xFFFF, u32 = 0xFFFFFFFF;

template <class M>
Codec<M> integer(std::int64_t minimum, std::int64_t maximum) {
    Codec<M> c;
    c.shape.kind = Shape::Kind::integer;
    c.shape.minimum = static_cast<double>(minimum);
    c.shape.maximum = static_cast<double>(maximum);
    c.read = [minimum, maximum](Reader& reader, const Node& node, M& out) {
        const auto value = read_integer(reader, node, minimum, maximum);
        if (value) out = static_cast<M>(*value);
        return value.has_value();
    };
    c.show = [](const M& v) { return std::to_string(static_cast<std::int64_t>(v)); };
    return c;
}

/// Index of the word among `words`; reports with a suggestion otherwise.
[[nodiscard]] std::optional<std::size_t> read_choice(Reader& reader, const Node& node, const std::vector<std::string>& words);

template <class E>
Codec<E> choice(std::vector<std::pair<std::string, E>> options) {
    Codec<E> c;
    c.shape.kind = Shape::Kind::choice;
    for (const auto& [word, value] : options) c.shape.choices.push_back(word);
    c.read = [words = c.shape.choices, options](Reader& reader, const Node& node, E& out) {
        const auto index = read_choice(reader, node, words);
        if (index) out = options[*index].second;
        return index.has_value();
    };
    c.show = [options](const E& value) {
        for (const auto& [word, v] : options)
            if (v == value) return word;
        return std::string{};
    };
    return c;
}

}  // namespace taktwerk::config
