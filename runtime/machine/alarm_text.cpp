#include "runtime/machine/alarm_text.hpp"

#include <cctype>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "axes/port/drive_port.hpp"

namespace taktwerk::runtime {

namespace {

/// Nanoseconds in the unit that a person reads.
std::string time_text(double nanoseconds) {
    const double size = std::abs(nanoseconds);
    if (size >= 1e9) return fmt::format("{:.3g} s", nanoseconds * 1e-9);
    if (size >= 1e6) return fmt::format("{:.3g} ms", nanoseconds * 1e-6);
    if (size >= 1e3) return fmt::format("{:.3g} us", nanoseconds * 1e-3);
    return fmt::format("{:.0f} ns", nanoseconds);
}

}  // namespace

std::string number_text(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return fmt::format("{}", static_cast<std::int64_t>(value));
    if (std::abs(value) >= 1e4 && std::abs(value) < 1e15) return fmt::format("{:.0f}", value);  // nobody reads 1.99901e+06
    return fmt::format("{:.4g}", value);
}

std::string fill_in(std::string_view text, double a, double b) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const auto rest = text.substr(i);
        const auto end = rest.find('}');
        const auto place = rest.substr(0, end == std::string_view::npos ? 0 : end + 1);
        const bool known = place.starts_with("{a") || place.starts_with("{b");
        const double value = known && place[1] == 'a' ? a : b;
        if (known && place.size() == 3) {
            out += number_text(value);
            i += place.size();
        } else if (known && place.substr(2) == ":ns}") {
            out += time_text(value);
            i += place.size();
        } else if (known && place.substr(2) == ":mode}") {
            out += axes::name(static_cast<axes::DriveMode>(value));
            i += place.size();
        } else if (known && place.size() == 6 && place.substr(2, 2) == ":x") {
            out += fmt::format("{:0{}X}", static_cast<std::uint32_t>(value), place[4] - '0');
            i += place.size();
        } else {
            out += text[i++];
        }
    }
    return out;
}

std::string in_units_of(std::string_view text, const std::string& unit) {
    std::string out(text);
    for (const std::string_view place : {"{a} u", "{b} u"})
        for (auto at = out.find(place); at != std::string::npos; at = out.find(place, at + 1)) {
            const auto unit_at = at + place.size() - 1, behind = unit_at + 1;
            if (behind == out.size() || std::isalpha(static_cast<unsigned char>(out[behind])) == 0) out.replace(unit_at, 1, unit);
        }
    return out;
}

std::string_view text_of(Reaction reaction) {
    switch (reaction) {
        case Reaction::none: return "none";
        case Reaction::warn: return "warning";
        case Reaction::stop_axis: return "the axis stops";
        case Reaction::stop_machine: return "all axes stop";
        case Reaction::power_off: return "all axes stop, power goes off";
    }
    return "";
}

std::string_view text_of(ResetRule rule) {
    switch (rule) {
        case ResetRule::self_clearing: return "goes with its cause";
        case ResetRule::acknowledge: return "acknowledge";
        case ResetRule::reset: return "reset";
        case ResetRule::restart: return "power cycle or restart";
    }
    return "";
}

}  // namespace taktwerk::runtime
