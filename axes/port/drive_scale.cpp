#include "axes/port/drive_scale.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "axes/port/parameter_text.hpp"

namespace taktwerk::axes {

namespace {

std::string named(const DriveProfile& profile, ParameterAddress address) {
    for (const auto& parameter : profile.parameters)
        if (parameter.address == address) return name_of(parameter);
    return object_text(address);
}

}  // namespace

std::vector<ParameterAddress> scale_objects(const ScaleObjects& s) {
    std::vector<ParameterAddress> out;
    const auto add = [&](ParameterAddress address) {
        if (address.index != 0 && std::find(out.begin(), out.end(), address) == out.end()) out.push_back(address);
    };
    for (const auto& address : {s.counts, s.counts_high, s.encoder, s.numerator, s.denominator}) add(address);
    for (const auto& address : s.only_one) add(address);
    return out;
}

std::optional<DriveScale> scale_of(const ScaleObjects& s, const std::function<std::optional<std::int64_t>(ParameterAddress)>& value_of) {
    for (const auto& ratio : s.only_one)
        if (value_of(ratio) != 1) return std::nullopt;
    if (s.counts.index != 0) {
        const auto counts = value_of(s.counts);
        const auto high = s.counts_high.index != 0 ? value_of(s.counts_high) : std::optional<std::int64_t>{0};
        if (!counts || !high) return std::nullopt;
        if (const auto all = *counts + *high * s.counts_high_unit; all > 0) return DriveScale{all, 1};
    }
    if (s.encoder.index == 0) return std::nullopt;
    const auto encoder = value_of(s.encoder);
    const auto numerator = s.numerator.index != 0 ? value_of(s.numerator) : std::optional<std::int64_t>{1};
    const auto denominator = s.denominator.index != 0 ? value_of(s.denominator) : std::optional<std::int64_t>{1};
    constexpr std::int64_t most = 0xFFFFFFFF;  // all of them have 32 bit: no product of two leaves 64
    const auto fits = [](const std::optional<std::int64_t>& value) { return value && *value > 0 && *value <= most; };
    if (!fits(encoder) || !fits(numerator) || !fits(denominator)) return std::nullopt;
    if (*encoder > std::numeric_limits<std::int64_t>::max() / *denominator) return std::nullopt;
    return DriveScale{*encoder * *denominator, *numerator};
}

std::string scale_words(const DriveProfile& profile) {
    const auto& s = profile.scale;
    if (s.counts.index != 0)
        return s.counts_high.index == 0
                   ? named(profile, s.counts)
                   : fmt::format("{} + {} x {}", named(profile, s.counts), s.counts_high_unit, named(profile, s.counts_high));
    if (s.encoder.index == 0) return {};
    if (s.numerator.index == 0) return named(profile, s.encoder);
    return fmt::format("{} x {} / {}", named(profile, s.encoder), named(profile, s.denominator), named(profile, s.numerator));
}

}  // namespace taktwerk::axes
