// taktwerk drive params: what the manual lists, with a drive's values or without one.

#include <algorithm>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/drive/profiles.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using axes::DriveParameter;
using axes::ParameterChange;
using axes::ParameterEffect;

struct ParameterOptions {
    std::shared_ptr<DriveOptions> drive;
    std::string filter;
};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string effect_text(const DriveParameter& parameter) {
    if (parameter.change == ParameterChange::never) return "read-only";
    std::string text = parameter.change == ParameterChange::disabled ? "while disabled" : "any time";
    switch (parameter.effect) {
        case ParameterEffect::at_once: break;
        case ParameterEffect::at_standstill: text += ", at standstill"; break;
        case ParameterEffect::when_enabled: text += ", when enabled"; break;
        case ParameterEffect::after_restart: text += ", after restart"; break;
        case ParameterEffect::after_saving: text += ", after saving and restart"; break;
    }
    return text;
}

std::vector<const DriveParameter*> chosen(const axes::DriveProfile& profile, const std::string& filter) {
    std::vector<const DriveParameter*> out;
    const auto wanted = lower(filter);
    for (const auto& parameter : profile.parameters)
        if (lower(axes::name_of(parameter)).rfind(wanted, 0) == 0 || lower(parameter.name).find(wanted) != std::string::npos ||
            (!filter.empty() && parameter.chinese.find(filter) != std::string::npos))
            out.push_back(&parameter);
    return out;
}

int show_parameters(const ParameterOptions& options, const std::string& heading, const axes::DriveProfile& profile,
                    const std::function<std::optional<std::int64_t>(const DriveParameter&)>& value_of) {
    const auto parameters = chosen(profile, options.filter);
    if (parameters.empty())
        return fail(*options.drive->bus, Error{"drive.no_parameter", options.filter,
                                               fmt::format("no parameter of {} begins so or has it in its name", profile.name),
                                               "leave the filter away to see all"});
    std::vector<std::optional<std::int64_t>> values;
    if (value_of)
        for (const auto* parameter : parameters) values.push_back(value_of(*parameter));
    if (options.drive->bus->json) {
        auto out = Json::array();
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            out.push_back(parameter_json(*parameters[i]));
            if (i < values.size() && values[i])
                out.back()["value"] = *values[i], out.back()["shown"] = axes::value_text(*parameters[i], *values[i]);
        }
        print_json(out);
        return exit_ok;
    }
    const auto colours = colours_of_output();
    fmt::print("{}: {}\n\n{}", toned(heading, Tone::strong, colours), count_text(parameters.size(), "parameter"),
               params_text(parameters, values, colours));
    return exit_ok;
}

int params(const ParameterOptions& options) {
    const auto& bus = *options.drive->bus;
    if (options.drive->drive.empty()) {
        if (options.drive->profile.empty())
            return fail(bus, Error{"drive.value", "", "say which drive on the bus, or --profile NAME for the manual's list alone",
                                   "`taktwerk drive identify` lists the drives"});
        const auto profile = profile_named(*options.drive, options.drive->profile);
        if (!profile) return fail(bus, profile.error());
        return show_parameters(options, (*profile)->title, **profile, nullptr);
    }
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        return show_parameters(options, drive.subject(), drive.profile(),
                               [&](const DriveParameter& parameter) -> std::optional<std::int64_t> {
                                   if (parameter.bits == 0) return std::nullopt;
                                   const auto value = drive.read(parameter);
                                   return value ? std::optional(*value) : std::nullopt;
                               });
    });
}

}  // namespace

Json parameter_json(const DriveParameter& parameter) {
    Json out{{"parameter", axes::name_of(parameter)},
             {"index", parameter.address.index},
             {"sub", parameter.address.sub},
             {"name", parameter.name},
             {"chinese", parameter.chinese},
             {"factory", parameter.factory == axes::FactoryValue::unknown ? Json() : Json(parameter.value)},
             {"factory_is", axes::name(parameter.factory)},
             {"unit", parameter.unit},
             {"scale", parameter.scale},
             {"meaning", parameter.meaning},
             {"effective", effect_text(parameter)},
             {"section", parameter.section}};
    if (parameter.minimum) out["minimum"] = *parameter.minimum;
    if (parameter.maximum) out["maximum"] = *parameter.maximum;
    return out;
}

std::string params_text(const std::vector<const DriveParameter*>& parameters, const std::vector<std::optional<std::int64_t>>& values,
                        Colours colours) {
    using Side = TextTable::Column::Side;
    std::vector<TextTable::Column> columns{{"parameter"}, {"name", Side::left, 36}};
    if (!values.empty()) columns.push_back({"value", Side::right});
    for (const char* title : {"factory", "range"}) columns.push_back({title, Side::right, 28});
    columns.push_back({"may be written"});
    TextTable table{columns};
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const auto& p = *parameters[i];
        std::vector<Cell> row{Cell{axes::name_of(p), Tone::strong}, Cell{p.name}};
        if (!values.empty()) {
            const auto& value = values[i];
            row.push_back(!value ? Cell{"-", Tone::faint}
                                 : Cell{axes::value_text(p, *value),
                                        p.factory == axes::FactoryValue::unknown || *value == p.value ? Tone::plain : Tone::warning});
        }
        row.push_back(Cell{p.bits == 0 || p.change == ParameterChange::never ? std::string{} : axes::factory_text(p)});
        row.push_back(Cell{axes::range_text(p)});
        row.push_back(Cell{effect_text(p)});
        table.add(std::move(row));
    }
    return table.text(colours);
}

void add_drive_params(CLI::App& drive, Action& action) {
    auto* sub = drive.add_subcommand("params", "the parameters of a drive, or of a kind of drive (--profile)");
    auto options = std::make_shared<ParameterOptions>();
    options->drive = add_drive_options(*sub);
    sub->add_option("DRIVE", options->drive->drive, "position or name on the bus; none: the manual's list of --profile");
    sub->add_option("--filter", options->filter, "those whose number begins so, or whose name has it")->type_name("TEXT");
    sub->add_option("--axis", options->drive->axis, "of a drive with several axes, from 1")->check(CLI::Range(1, 8));
    sub->callback([&action, options] { action = [options] { return params(*options); }; });
}

}  // namespace taktwerk::apps
