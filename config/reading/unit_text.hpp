#pragma once
// A number with a unit where only somebody else knows the unit that is wanted: a parameter of a program, a velocity on the command line.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::config {

struct UnitValue {
    std::string unit;
    double value = 0;
};
/// "60 mm" in every unit it can be told in: 60000 um, 60 mm, 6 cm, 0.06 m; "600 mm/min": 10 mm/s, 600 mm/min, ... Empty: no number with
/// a unit that is known here.
[[nodiscard]] std::vector<UnitValue> in_every_unit(std::string_view text);

/// "7.5 bar", "-10V", "20 %": a number and whatever stands behind it. Nothing where one of them is missing.
[[nodiscard]] std::optional<UnitValue> number_and_unit(std::string_view text);

/// What `text` is in `unit`: "20mm/s", "1.2 m/min" and "20" for "mm/s"; a bare number is taken as it is. Errors (subject: the text):
/// unit.not_a_number, unit.other (with the form that is wanted).
[[nodiscard]] Result<double> value_in(std::string_view text, std::string_view unit);

}  // namespace taktwerk::config
