#pragma once
// Numbers with units as people write them: `1 ms`, `100 mm/s`, `2000 mm/s2`, `5/1`, `607Ah`, `2005h:0B`.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::config {

/// What a quantity measures. position .. jerk are in the unit u of the axis (mm, deg, ...).
enum class Dimension : std::uint8_t {
    time,
    frequency,
    angle,  ///< of something that is no axis
    position,
    velocity,
    acceleration,
    jerk,
    torque,
    inertia,
    mass,
    friction,
    ratio_ppm,
    voltage,
    cycles
};

/// Units an axis may have. Lengths convert among each other, angles too; a length never becomes an angle.
[[nodiscard]] const std::vector<std::string>& axis_units();

/// The unit in words for messages: "mm/s" for velocity on an axis in mm; time: "ms".
[[nodiscard]] std::string unit_of(Dimension dimension, std::string_view axis_unit);
/// An example for messages: "100 mm/s".
[[nodiscard]] std::string example_of(Dimension dimension, std::string_view axis_unit);

enum class QuantityProblem : std::uint8_t {
    none,
    not_a_number,  ///< "fast"
    no_unit,       ///< "100"
    unknown_unit,  ///< "100 furlongs"
    wrong_unit,    ///< "100 deg/s" on an axis in mm
};

struct Quantity {
    QuantityProblem problem = QuantityProblem::none;
    double value = 0;  ///< seconds, Hz, degrees, u.., N m, kg m2, kg, N m s/rad, ppm, V, cycles
};

[[nodiscard]] Quantity parse_quantity(std::string_view text, Dimension dimension, std::string_view axis_unit);

/// A finite decimal number and nothing else.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// Decimal, 0x.. or ..h; nothing else around it.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// "5/1", "5".
struct Fraction {
    std::int64_t numerator = 1, denominator = 1;
};
[[nodiscard]] std::optional<Fraction> parse_fraction(std::string_view text);

/// An object of a dictionary: "607Ah", "2005h:0B" (both hexadecimal, as manuals print), "0x2005:11" (sub decimal),
/// with "/16" behind it where a PDO maps so many bits.
struct ObjectAddress {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::uint8_t bits = 0;  ///< 0 = not given
    friend bool operator==(const ObjectAddress&, const ObjectAddress&) = default;
};
[[nodiscard]] std::optional<ObjectAddress> parse_object(std::string_view text);
[[nodiscard]] std::string show_object(std::uint16_t index, std::uint8_t sub);

/// Shortest decimal text that gives the same double.
[[nodiscard]] std::string show_number(double value);

}  // namespace taktwerk::config
