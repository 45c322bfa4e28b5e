#include "config/reading/quantity.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace taktwerk::config {

namespace {

constexpr double pi = 3.14159265358979323846;

struct UnitScale {
    std::string_view name;
    double factor;
};

// Within a family the ratio of two factors is the conversion; integers keep it exact.
constexpr std::array<UnitScale, 4> lengths{{{"um", 1}, {"mm", 1e3}, {"cm", 1e4}, {"m", 1e6}}};
constexpr std::array<UnitScale, 3> angles{{{"deg", 1}, {"rev", 360}, {"rad", 180 / pi}}};
constexpr std::array<UnitScale, 5> times{{{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}}};

template <std::size_t N>
const UnitScale* find(const std::array<UnitScale, N>& units, std::string_view name) {
    for (const auto& unit : units)
        if (unit.name == name) return &unit;
    return nullptr;
}

std::string_view trim(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// "mm/s^2", "kg m2", "µs" -> "mm/s2", "kgm2", "us".
std::string normalised(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto rest = text.substr(i);
        const auto replace = [&](std::string_view from, std::string_view to) {
            if (rest.substr(0, from.size()) != from) return false;
            out += to;
            i += from.size() - 1;
            return true;
        };
        if (text[i] == ' ' || text[i] == '\t' || text[i] == '^' || text[i] == '*') continue;
        if (replace("²", "2") || replace("³", "3") || replace("µ", "u") || replace("μ", "u") || replace("·", "") || replace("°", "deg"))
            continue;
        out += text[i];
    }
    return out;
}

int order_of(Dimension dimension) {
    switch (dimension) {
        case Dimension::position: return 0;
        case Dimension::velocity: return 1;
        case Dimension::acceleration: return 2;
        case Dimension::jerk: return 3;
        default: return -1;
    }
}

constexpr std::array<std::string_view, 4> per_second{"", "/s", "/s2", "/s3"};

/// value * up / down, in this order: whole conversions stay exact.
struct Scale {
    enum class Fit : std::uint8_t { good, not_a_unit, other_quantity } fit = Fit::not_a_unit;
    double up = 1, down = 1;
};

Scale motion_scale(std::string_view unit, int order, std::string_view axis_unit) {
    std::string base(unit);
    int found_order = 0;
    double per_minute = 1;
    if (unit == "rpm") {
        base = "rev";
        found_order = 1;
        per_minute = 60;
    } else if (const auto slash = unit.find('/'); slash != std::string_view::npos) {
        base = std::string(unit.substr(0, slash));
        const auto rest = unit.substr(slash);
        if (rest == "/min") {
            found_order = 1;
            per_minute = 60;
        } else {
            for (int n = 1; n < 4; ++n)
                if (rest == per_second[static_cast<std::size_t>(n)]) found_order = n;
            if (found_order == 0) return {};
        }
    }
    const auto in = [&](const auto& family) -> Scale {
        const auto* from = find(family, base);
        const auto* to = find(family, axis_unit);
        if (!from) return {};
        if (!to || found_order != order) return {Scale::Fit::other_quantity, 1, 1};
        return {Scale::Fit::good, from->factor, to->factor * per_minute};
    };
    const auto length = in(lengths);
    return length.fit != Scale::Fit::not_a_unit ? length : in(angles);
}

bool is_any_unit(std::string_view unit) {
    if (find(times, unit)) return true;
    for (const auto* known : {"Hz", "kHz", "MHz", "Nm", "kgm2", "kg", "Nms/rad", "ppm", "V", "mV", "cycle", "cycles", "%"})
        if (unit == known) return true;
    return motion_scale(unit, 0, "mm").fit != Scale::Fit::not_a_unit;
}

Scale plain_scale(std::string_view unit, Dimension dimension) {
    const auto is = [&](std::string_view name, double up = 1, double down = 1) {
        return unit == name ? Scale{Scale::Fit::good, up, down} : Scale{};
    };
    const auto either = [](const Scale& a, const Scale& b) { return a.fit == Scale::Fit::good ? a : b; };
    switch (dimension) {
        case Dimension::time:
            if (const auto* time = find(times, unit)) return {Scale::Fit::good, time->factor, 1e9};
            return {};
        case Dimension::angle:
            if (const auto* angle = find(angles, unit)) return {Scale::Fit::good, angle->factor, 1};
            return {};
        case Dimension::frequency: return either(is("Hz"), either(is("kHz", 1e3), is("MHz", 1e6)));
        case Dimension::torque: return either(is("Nm"), is("mNm", 1, 1e3));
        case Dimension::inertia: return either(is("kgm2"), is("kgcm2", 1, 1e4));
        case Dimension::mass: return either(is("kg"), is("g", 1, 1e3));
        case Dimension::friction: return either(is("Nms/rad"), is("Nms"));
        case Dimension::ratio_ppm: return is("ppm");
        case Dimension::voltage: return either(is("V"), is("mV", 1, 1e3));
        case Dimension::cycles: return either(is("cycles"), is("cycle"));
        default: return {};
    }
}

template <class T>
std::optional<T> whole(std::string_view text, int base) {
    T value{};
    const auto* end = text.data() + text.size();
    if (text.empty()) return std::nullopt;
    const auto result = std::from_chars(text.data(), end, value, base);
    if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
    return value;
}

}  // namespace

const std::vector<std::string>& axis_units() {
    static const std::vector<std::string> units{"um", "mm", "cm", "m", "deg", "rad", "rev"};
    return units;
}

std::string unit_of(Dimension dimension, std::string_view axis_unit) {
    switch (dimension) {
        case Dimension::time: return "ms";
        case Dimension::frequency: return "Hz";
        case Dimension::angle: return "deg";
        case Dimension::torque: return "Nm";
        case Dimension::inertia: return "kg m2";
        case Dimension::mass: return "kg";
        case Dimension::friction: return "Nm s/rad";
        case Dimension::ratio_ppm: return "ppm";
        case Dimension::voltage: return "V";
        case Dimension::cycles: return "cycles";
        default: return std::string(axis_unit) + std::string(per_second[static_cast<std::size_t>(order_of(dimension))]);
    }
}

std::string example_of(Dimension dimension, std::string_view axis_unit) {
    const char* number = "1";
    switch (dimension) {
        case Dimension::time: number = "10"; break;
        case Dimension::frequency: number = "50"; break;
        case Dimension::angle: number = "90"; break;
        case Dimension::inertia: number = "2e-4"; break;
        case Dimension::mass: number = "1.2"; break;
        case Dimension::friction: number = "1e-3"; break;
        case Dimension::ratio_ppm: number = "20"; break;
        case Dimension::voltage: number = "0.1"; break;
        case Dimension::cycles: number = "4"; break;
        case Dimension::position: number = "10"; break;
        case Dimension::velocity: number = "100"; break;
        case Dimension::acceleration: number = "1000"; break;
        case Dimension::jerk: number = "10000"; break;
        case Dimension::torque: break;
    }
    return fmt::format("{} {}", number, unit_of(dimension, axis_unit));
}

Quantity parse_quantity(std::string_view text, Dimension dimension, std::string_view axis_unit) {
    text = trim(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc{} || !std::isfinite(value)) return {QuantityProblem::not_a_number, 0};
    const auto unit = normalised(text.substr(static_cast<std::size_t>(result.ptr - text.data())));
    if (unit.empty()) return {QuantityProblem::no_unit, value};

    const int order = order_of(dimension);
    const auto scale = order >= 0 ? motion_scale(unit, order, axis_unit) : plain_scale(unit, dimension);
    if (scale.fit == Scale::Fit::good) {
        const double scaled = value * scale.up / scale.down;
        if (!std::isfinite(scaled)) return {QuantityProblem::not_a_number, 0};
        return {QuantityProblem::none, scaled};
    }
    return {scale.fit == Scale::Fit::other_quantity || is_any_unit(unit) ? QuantityProblem::wrong_unit : QuantityProblem::unknown_unit,
            value};
}

std::optional<double> parse_number(std::string_view text) {
    text = trim(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (text.empty() || result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
    text = trim(text);
    const bool negative = !text.empty() && text.front() == '-';
    if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
    if (text.empty() || text.front() == '-' || text.front() == '+') return std::nullopt;
    std::optional<std::int64_t> value;
    if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) value = whole<std::int64_t>(text.substr(2), 16);
    else if (text.back() == 'h' || text.back() == 'H') value = whole<std::int64_t>(text.substr(0, text.size() - 1), 16);
    else value = whole<std::int64_t>(text, 10);
    if (value && negative) *value = -*value;
    return value;
}

std::optional<Fraction> parse_fraction(std::string_view text) {
    const auto slash = text.find_first_of("/:");
    const auto above = parse_integer(text.substr(0, slash));
    const auto below = slash == std::string_view::npos ? std::optional<std::int64_t>(1) : parse_integer(text.substr(slash + 1));
    if (!above || !below) return std::nullopt;
    return Fraction{*above, *below};
}

std::optional<ObjectAddress> parse_object(std::string_view text) {
    text = trim(text);
    ObjectAddress out;
    if (const auto slash = text.find('/'); slash != std::string_view::npos) {
        const auto bits = whole<std::uint8_t>(trim(text.substr(slash + 1)), 10);
        if (!bits || *bits == 0 || *bits > 64) return std::nullopt;
        out.bits = *bits;
        text = trim(text.substr(0, slash));
    }
    const auto colon = text.find(':');
    const auto index_text = trim(text.substr(0, colon));
    const bool manual_style = !index_text.empty() && (index_text.back() == 'h' || index_text.back() == 'H');
    const bool c_style = index_text.size() > 2 && index_text[0] == '0' && (index_text[1] == 'x' || index_text[1] == 'X');
    if (!manual_style && !c_style) return std::nullopt;
    const auto index = parse_integer(index_text);
    if (!index || *index < 1 || *index > 0xFFFF) return std::nullopt;
    out.index = static_cast<std::uint16_t>(*index);
    if (colon != std::string_view::npos) {
        auto sub_text = trim(text.substr(colon + 1));
        const bool hex = sub_text.size() > 2 && (sub_text.substr(0, 2) == "0x" || sub_text.substr(0, 2) == "0X");
        if (hex) sub_text.remove_prefix(2);
        const auto sub = whole<std::uint8_t>(sub_text, hex || manual_style ? 16 : 10);
        if (!sub) return std::nullopt;
        out.sub = *sub;
    }
    return out;
}

std::string show_object(std::uint16_t index, std::uint8_t sub) { return fmt::format("{:04X}h:{:02X}", index, sub); }

std::string show_number(double value) {
    if (std::isinf(value)) return value > 0 ? "none" : "-none";
    return fmt::format("{}", value);
}

}  // namespace taktwerk::config
