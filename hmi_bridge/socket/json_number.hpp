#pragma once
// Numbers that JSON has no word for: not a number and the infinities. Programs make them (0/0, an unlimited range), and a state that
// carries one must still reach everybody. They go as the texts "NaN", "Infinity" and "-Infinity": what JavaScript's Number() and
// Python's float() read. Not real-time.

#include <cmath>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

namespace taktwerk::hmi {

/// Writer's side: every such number in `json` and below it becomes its text.
template <class Json>
void spell_out_numbers(Json& json) {
    if (json.is_structured()) {
        for (auto& element : json) spell_out_numbers(element);
    } else if (json.is_number_float()) {
        const double value = json.template get<double>();
        if (std::isnan(value)) json = "NaN";
        else if (std::isinf(value)) json = value > 0 ? "Infinity" : "-Infinity";
    }
}

/// Reader's side: the number of what spell_out_numbers() has left; anything else is not a number. Throws nothing.
template <class Json>
[[nodiscard]] double number_of(const Json& json) {
    if (json.is_number()) return json.template get<double>();
    if (json.is_string()) {
        const auto& text = json.template get_ref<const std::string&>();
        if (text == "Infinity") return std::numeric_limits<double>::infinity();
        if (text == "-Infinity") return -std::numeric_limits<double>::infinity();
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace taktwerk::hmi
