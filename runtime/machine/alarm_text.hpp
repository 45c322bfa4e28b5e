#pragma once
// The words of the alarm tables: their placeholders filled in, reactions and resets by name. Outside the cycle.

#include <string>
#include <string_view>

#include "core/alarm.hpp"

namespace taktwerk::runtime {

/// For people: whole numbers without a point, large ones without an exponent.
[[nodiscard]] std::string number_text(double value);

/// {a:ns}: a time. {a:mode}: a mode of operation by name. {a}, {b} and, in so many hexadecimal digits as codes of that kind are written,
/// {a:x2}, {b:x4}, ... in a text of an alarm table.
[[nodiscard]] std::string fill_in(std::string_view text, double a, double b);

/// The tables say `u` for the unit of the axis whose alarm it is: {a} u, {b} u/s.
[[nodiscard]] std::string in_units_of(std::string_view text, const std::string& unit);

[[nodiscard]] std::string_view text_of(Reaction reaction);
[[nodiscard]] std::string_view text_of(ResetRule rule);

}  // namespace taktwerk::runtime
