// Which settings of a drive a saved set holds, and how a drive differs from one.

#include <algorithm>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using axes::DriveParameter;

struct Read {
    std::vector<config::ParameterSet::Value> values;
    std::vector<LeftOut> left_out;
};

/// The drive answered, and what it said is that this object gives no value; any other error is of the way to it, and concerns all of them.
bool refused_by_drive(const Error& error) {
    return error.code == "sdo.abort" || error.code == "drive.refused" || error.code == "drive.not_taken";
}

Result<Read> read_settings(DriveAccess& drive) {
    Read out;
    for (const auto& parameter : drive.profile().parameters) {
        if (!axes::is_setting(parameter)) continue;
        if (const auto raw = drive.read(parameter)) out.values.push_back({&parameter, *raw});
        else if (refused_by_drive(raw.error())) out.left_out.push_back({&parameter, raw.error().what});
        else return raw.error();
    }
    return out;
}

/// Why the reader of a set would refuse what the drive shows; empty: it takes it, and takes it for the same.
std::string why_refused(const axes::DriveProfile& profile, const DriveParameter& parameter, std::int64_t raw) {
    const auto shown = axes::value_text(parameter, raw);
    const auto back = axes::parse_value(profile, parameter, shown);
    if (back && *back == raw) return {};
    if (!axes::check_homing_method(profile, parameter.address, raw)) return back.error().what;
    return fmt::format("the drive shows {}, its manual allows {}: it would refuse that value, if it were written", shown,
                       axes::range_text(parameter));
}

}  // namespace

Result<KeptSettings> kept_settings(DriveAccess& drive, Kept kept) {
    KeptSettings out;
    out.set.drive = drive.profile().name;
    out.set.comment = fmt::format("{} on {}", drive.subject(), drive.where());
    auto read = read_settings(drive);
    if (!read) return read.error();
    out.left_out = std::move(read->left_out);
    for (const auto& value : read->values) {
        if (kept == Kept::unlike_factory && value.parameter->is_stated_factory(value.raw)) continue;
        if (auto why = why_refused(drive.profile(), *value.parameter, value.raw); why.empty()) out.set.values.push_back(value);
        else out.left_out.push_back({value.parameter, std::move(why)});
    }
    return out;
}

std::string text_of(const KeptSettings& settings) {
    auto out = config::text_of(settings.set);
    for (const auto& one : settings.left_out)
        out += fmt::format("# {} ({}) is left out: {}\n", axes::name_of(*one.parameter), one.parameter->name, one.why);
    return out;
}

Result<SetDifference> difference_from(DriveAccess& drive, const config::ParameterSet& set) {
    SetDifference out;
    for (const auto& value : set.values) {
        const auto now = drive.read(*value.parameter);
        if (!now && !refused_by_drive(now.error())) return now.error();
        if (!now) out.left_out.push_back({value.parameter, now.error().what});
        else if (*now != value.raw) out.changes.push_back({value.parameter, value.raw, *now});
    }
    return out;
}

Result<SetDifference> difference_from_factory(DriveAccess& drive) {
    SetDifference out;
    const auto read = read_settings(drive);
    if (!read) return read.error();
    for (const auto& one : read->left_out) {
        if (one.parameter->factory != axes::FactoryValue::stated) ++out.not_stated;
        else out.left_out.push_back(one);
    }
    for (const auto& value : read->values) {
        if (value.parameter->factory != axes::FactoryValue::stated) ++out.not_stated;
        else if (value.raw != value.parameter->value) out.changes.push_back({value.parameter, value.parameter->value, value.raw});
    }
    return out;
}

}  // namespace taktwerk::apps
