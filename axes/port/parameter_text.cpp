#include "axes/port/parameter_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/nearest_name.hpp"

namespace taktwerk::axes {

namespace {

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

/// Digits behind the point that show one step: 0.1 has one.
int digits_of(double scale) {
    int digits = 0;
    for (double step = scale; digits < 6 && std::abs(step - std::round(step)) > 1e-9 * std::abs(step); step *= 10) ++digits;
    return digits;
}

/// How many of `to` one of `from` is; nothing: they do not measure the same.
std::optional<double> in_unit(std::string_view from, std::string_view to) {
    struct Unit {
        std::string_view name, measures;
        double factor;
    };
    static constexpr std::array units{
        Unit{"ns", "time", 1e-9},      Unit{"us", "time", 1e-6},     Unit{"ms", "time", 1e-3},  Unit{"s", "time", 1},
        Unit{"min", "time", 60},       Unit{"rpm", "speed", 1},      Unit{"r/min", "speed", 1}, Unit{"mA", "current", 1e-3},
        Unit{"A", "current", 1},       Unit{"mV", "voltage", 1e-3},  Unit{"V", "voltage", 1},   Unit{"Hz", "frequency", 1},
        Unit{"kHz", "frequency", 1e3}, Unit{"W", "power", 1},        Unit{"kW", "power", 1e3},  Unit{"mOhm", "resistance", 1e-3},
        Unit{"ohm", "resistance", 1},  Unit{"Ohm", "resistance", 1},
    };
    const auto find = [](std::string_view name) {
        return std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.name == name; });
    };
    if (from == to) return 1;
    const auto a = find(from), b = find(to);
    if (a == units.end() || b == units.end() || a->measures != b->measures) return std::nullopt;
    return a->factor / b->factor;
}

/// One slip of the keyboard: a digit more, less or other, or the same ones in another order. Numbers that merely look alike are other
/// parameters.
bool is_slip(std::string_view word, std::string_view name) {
    auto a = lower(word), b = lower(name);
    const auto longer = std::max(a.size(), b.size()), shorter = std::min(a.size(), b.size());
    std::size_t front = 0, back = 0;
    while (front < shorter && a[front] == b[front]) ++front;
    while (back < shorter - front && a[a.size() - 1 - back] == b[b.size() - 1 - back]) ++back;
    if (longer - (front + back) <= 1) return true;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
}

Error bad_value(const DriveParameter& parameter, std::string_view text, std::string_view why) {
    return {"drive.value", name_of(parameter), fmt::format("'{}' {}", text, why),
            parameter.unit.empty() ? std::string("give a whole number") : fmt::format("give a number in {}", parameter.unit)};
}

std::optional<std::int64_t> hexadecimal(std::string_view text) {
    if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) text.remove_prefix(2);
    else if (text.size() > 1 && (text.back() == 'h' || text.back() == 'H')) text.remove_suffix(1);
    else return std::nullopt;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return static_cast<std::int64_t>(value);
}

std::int64_t least(const DriveParameter& p) noexcept {
    if (p.minimum) return *p.minimum;
    if (!p.is_signed) return 0;
    return p.bits >= 64 ? std::numeric_limits<std::int64_t>::min() : -(std::int64_t{1} << (p.bits - 1));
}

std::int64_t greatest(const DriveParameter& p) noexcept {
    if (p.maximum) return *p.maximum;
    if (p.bits >= 63) return std::numeric_limits<std::int64_t>::max();
    return (std::int64_t{1} << (p.is_signed ? p.bits - 1 : p.bits)) - 1;
}

}  // namespace

std::string object_text(const ParameterAddress& address) {
    return address.sub == 0 ? fmt::format("{:04X}h", address.index) : fmt::format("{:04X}h:{:02X}", address.index, address.sub);
}

std::string name_of(const DriveParameter& parameter) {
    return parameter.parameter.empty() ? object_text(parameter.address) : parameter.parameter;
}

Result<const DriveParameter*> find_parameter(const DriveProfile& profile, std::string_view word) {
    const auto wanted = lower(trimmed(word));
    std::vector<std::string> names;
    for (const auto& parameter : profile.parameters) {
        const auto object = lower(object_text(parameter.address));
        const bool addressed = parameter.reach == ParameterReach::bus;
        const bool first_entry = addressed && parameter.address.sub == 0 && wanted == object + ":00";
        if (wanted == lower(name_of(parameter)) || (addressed && wanted == object) || first_entry) return &parameter;
        if (is_slip(trimmed(word), name_of(parameter))) names.push_back(name_of(parameter));
    }
    const auto near = nearest_name(std::string(trimmed(word)), names);
    return Error{"drive.no_parameter", std::string(word), fmt::format("{} has no such parameter", profile.name),
                 near.empty() ? "`taktwerk drive params` lists them all" : fmt::format("did you mean {}?", near)};
}

std::string value_text(const DriveParameter& parameter, std::int64_t raw) {
    auto text = parameter.scale == 1 ? fmt::format("{}", raw)
                                     : fmt::format("{:.{}f}", static_cast<double>(raw) * parameter.scale, digits_of(parameter.scale));
    if (!parameter.unit.empty()) text += " " + parameter.unit;
    return text;
}

std::string factory_text(const DriveParameter& parameter) {
    switch (parameter.factory) {
        case FactoryValue::stated: return value_text(parameter, parameter.value);
        case FactoryValue::assumed: return value_text(parameter, parameter.value) + " (assumed)";
        case FactoryValue::unknown: break;
    }
    return "not stated";
}

std::string_view name(FactoryValue factory) noexcept {
    switch (factory) {
        case FactoryValue::unknown: return "unknown";
        case FactoryValue::assumed: return "assumed";
        case FactoryValue::stated: return "stated";
    }
    return "";
}

std::string range_text(const DriveParameter& parameter) {
    if (!parameter.minimum && !parameter.maximum) return {};
    DriveParameter bare = parameter;
    bare.unit.clear();
    if (!bare.minimum && !bare.is_signed) bare.minimum = 0;
    const auto shown = [&](const std::optional<std::int64_t>& bound) { return bound ? value_text(bare, *bound) : std::string("..."); };
    return fmt::format("{} .. {}{}{}", shown(bare.minimum), shown(bare.maximum), parameter.unit.empty() ? "" : " ", parameter.unit);
}

Result<std::int64_t> parse_value(const DriveParameter& parameter, std::string_view text) {
    if (parameter.reach == ParameterReach::maker_tool)
        return Error{"drive.no_address", name_of(parameter), fmt::format("{} has no address on the bus", parameter.name),
                     "set it at the drive's panel or with its maker's tool, and save it there"};
    if (parameter.change == ParameterChange::never)
        return Error{"drive.read_only", name_of(parameter), fmt::format("{} is read-only", parameter.name), "nothing can be written to it"};
    const auto whole = trimmed(text);
    std::int64_t raw = 0;
    if (const auto hex = hexadecimal(whole)) {
        raw = *hex;
    } else {
        double value = 0;
        const char* end = whole.data() + whole.size();
        const char* begin = whole.data() + (!whole.empty() && whole.front() == '+' ? 1 : 0);
        const auto [rest, error] = std::from_chars(begin, end, value);
        if (error != std::errc{} || !std::isfinite(value)) return bad_value(parameter, text, "is no number");
        const auto unit = trimmed({rest, static_cast<std::size_t>(end - rest)});
        const auto factor = unit.empty() ? std::optional<double>{1} : in_unit(unit, parameter.unit);
        if (!factor)
            return bad_value(parameter, text,
                             parameter.unit.empty() ? "has a unit, this parameter has none" : fmt::format("is not in {}", parameter.unit));
        const double steps = value * *factor / parameter.scale;
        if (std::abs(steps) > 9.0e18) return bad_value(parameter, text, "is too large for any parameter");
        if (std::abs(steps - std::round(steps)) > 1e-6 * std::max(1.0, std::abs(steps) * 1e-6))
            return bad_value(parameter, text, fmt::format("lies between two steps of {}", value_text(parameter, 1)));
        raw = std::llround(steps);
    }
    if (raw < least(parameter) || raw > greatest(parameter)) {
        DriveParameter bounded = parameter;
        bounded.minimum = least(parameter), bounded.maximum = greatest(parameter);
        return Error{"drive.out_of_range", name_of(parameter),
                     fmt::format("{} is not in the range of {}", value_text(parameter, raw), parameter.name),
                     fmt::format("give {}", range_text(bounded))};
    }
    return raw;
}

Result<void> check_homing_method(const DriveProfile& profile, const ParameterAddress& object, std::int64_t raw) {
    constexpr std::uint16_t homing_method = 0x6098;
    const auto& known = profile.homing_methods;
    if (object.index != homing_method || raw == 0 || known.empty() || std::find(known.begin(), known.end(), raw) != known.end()) return {};
    std::string all;
    for (const std::int8_t method : known) all += (all.empty() ? "" : ", ") + std::to_string(static_cast<int>(method));
    return Error{"drive.out_of_range", object_text(object), fmt::format("{} does not document homing method {}", profile.name, raw),
                 "choose one of " + all};
}

Result<std::int64_t> parse_value(const DriveProfile& profile, const DriveParameter& parameter, std::string_view text) {
    auto raw = parse_value(parameter, text);
    if (!raw) return raw;
    if (auto documented = check_homing_method(profile, parameter.address, *raw); !documented) return documented.error();
    return raw;
}

std::vector<std::byte> to_bytes(const DriveParameter& parameter, std::int64_t raw) {
    std::vector<std::byte> out((parameter.bits + 7u) / 8u);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::byte>(static_cast<std::uint64_t>(raw) >> (8 * i) & 0xFFu);
    return out;
}

Result<std::int64_t> from_bytes(const DriveParameter& parameter, std::span<const std::byte> bytes) {
    // Some drives answer in another width than their manual says: what fits is taken as it is.
    if (bytes.empty() || bytes.size() > 8)
        return Error{"drive.size", name_of(parameter), fmt::format("the drive answers {} bytes", bytes.size()),
                     "read it by `taktwerk bus sdo read`, and correct its type in the drive file"};
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) raw |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    const auto bits = 8 * bytes.size();
    if (parameter.is_signed && bits < 64 && (raw >> (bits - 1) & 1u)) raw |= ~std::uint64_t{0} << bits;
    return static_cast<std::int64_t>(raw);
}

bool is_setting(const DriveParameter& parameter) noexcept {
    if (parameter.reach == ParameterReach::maker_tool) return false;
    if (parameter.change == ParameterChange::never || parameter.action || parameter.bits == 0) return false;
    const auto index = parameter.address.index;
    if (index >= 0x1000 && index < 0x2000) return false;  // communication: the master's own
    // Commands of the cycle: control word, mode, targets, offsets, probes, outputs.
    static constexpr std::array<std::uint16_t, 10> commands{0x6040, 0x6060, 0x6071, 0x607A, 0x60B0, 0x60B1, 0x60B2, 0x60B8, 0x60FE, 0x60FF};
    return std::find(commands.begin(), commands.end(), index) == commands.end();
}

std::string way_to_store(const DriveProfile& profile, std::string_view drive, std::size_t axis, const DriveParameter& parameter,
                         std::int64_t raw) {
    DriveParameter bare = parameter;
    bare.unit.clear();
    const auto assignment = fmt::format("{}={}", name_of(parameter), value_text(bare, raw));
    const auto command = [&](std::string_view store) {
        return fmt::format("`taktwerk drive set {} {}{}{}`", drive, assignment, profile.axes > 1 ? fmt::format(" --axis {}", axis + 1) : "",
                           store);
    };
    switch (profile.storage.way) {
        case ParameterStorage::on_request:
        case ParameterStorage::each_write: return command(" --store") + ", then switch the drive off and on";
        case ParameterStorage::not_stated:
            return command("") +
                   " or its panel, then switch the drive off and on and read it again: whether it keeps what the bus writes, its "
                   "manual does not say";
        case ParameterStorage::never: break;
    }
    return fmt::format("set {} with its maker's tool or its panel and save it there, then switch the drive off and on", assignment);
}

}  // namespace taktwerk::axes
