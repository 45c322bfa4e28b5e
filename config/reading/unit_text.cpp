#include "config/reading/unit_text.hpp"

#include <optional>

#include <fmt/format.h>

#include "config/reading/quantity.hpp"

namespace taktwerk::config {

namespace {

/// As people write one unit in several ways: "mm/s^2", "mm / s2", "r/min".
std::string plain(std::string_view unit) {
    std::string out;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        const auto rest = unit.substr(i);
        if (rest.starts_with("²")) out += '2', i += 1;
        else if (rest.starts_with("³")) out += '3', i += 1;
        else if (rest.starts_with("°")) out += "deg", i += 1;
        else if (rest[0] != ' ' && rest[0] != '^') out += rest[0];
    }
    return out == "r/min" || out == "1/min" || out == "rev/min" ? "rpm" : out;
}

}  // namespace

std::vector<UnitValue> in_every_unit(std::string_view text) {
    std::vector<UnitValue> out;
    const auto read = [&](Dimension dimension, std::string_view axis_unit) -> std::optional<double> {
        const auto quantity = parse_quantity(text, dimension, axis_unit);
        return quantity.problem == QuantityProblem::none ? std::optional(quantity.value) : std::nullopt;
    };
    for (const auto& unit : axis_units())
        for (const auto dimension : {Dimension::position, Dimension::velocity, Dimension::acceleration, Dimension::jerk}) {
            const auto value = read(dimension, unit);
            if (!value) continue;
            out.push_back({unit_of(dimension, unit), *value});
            if (dimension != Dimension::velocity) continue;
            out.push_back({unit == "rev" ? std::string("rpm") : unit + "/min", *value * 60});
        }
    if (const auto seconds = read(Dimension::time, ""))
        for (const auto& [unit, factor] : {std::pair{"s", 1.0}, std::pair{"ms", 1e3}, std::pair{"us", 1e6}, std::pair{"min", 1.0 / 60}})
            out.push_back({unit, *seconds * factor});
    if (const auto hertz = read(Dimension::frequency, ""))
        for (const auto& [unit, factor] : {std::pair{"Hz", 1.0}, std::pair{"kHz", 1e-3}}) out.push_back({unit, *hertz * factor});
    if (const auto torque = read(Dimension::torque, ""))
        for (const auto& [unit, factor] : {std::pair{"Nm", 1.0}, std::pair{"mNm", 1e3}}) out.push_back({unit, *torque * factor});
    const auto mark = text.find('%');
    if (mark != std::string_view::npos && plain(text.substr(mark)) == "%")
        if (const auto number = parse_number(text.substr(0, mark))) out.push_back({"%", *number});
    return out;
}

std::optional<UnitValue> number_and_unit(std::string_view text) {
    std::size_t end = 0;  // the longest beginning that is a number: `1e3 bar`, and `5 eV` is not 5e
    std::optional<double> number;
    for (std::size_t length = 1; length < text.size(); ++length)
        if (const auto read = parse_number(text.substr(0, length))) number = read, end = length;
    if (!number) return std::nullopt;
    auto unit = text.substr(end);
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    while (!unit.empty() && unit.back() == ' ') unit.remove_suffix(1);
    if (unit.empty()) return std::nullopt;
    return UnitValue{std::string(unit), *number};
}

Result<double> value_in(std::string_view text, std::string_view unit) {
    if (const auto number = parse_number(text)) return *number;
    const auto shown = unit.empty() ? std::string("5") : fmt::format("5 {}", unit);
    const auto all = in_every_unit(text);
    for (const auto& one : all)
        if (plain(one.unit) == plain(unit)) return one.value;
    // The unit's own spelling behind a number is right even where it is none that is known here ("3 parts").
    const auto last = text.find_last_of("0123456789.");
    if (last != std::string_view::npos && !unit.empty() && plain(text.substr(last + 1)) == plain(unit))
        if (const auto number = parse_number(text.substr(0, last + 1))) return *number;
    if (!all.empty())
        return Error{"unit.other", std::string(text),
                     unit.empty() ? "a number without a unit is wanted" : fmt::format("{} is wanted", unit),
                     fmt::format("write it as `{}`", shown)};
    return Error{"unit.not_a_number", std::string(text), "is no number with a unit that is known", fmt::format("write it as `{}`", shown)};
}

}  // namespace taktwerk::config
