#include "apps/docs/drive_pages.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

using axes::DriveAlarmText;
using axes::DriveParameter;

std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c;
    }
    return out;
}

std::string_view reset_of(const DriveAlarmText& alarm) {
    if (alarm.warning) return "goes with its cause";
    return alarm.resettable ? "MC_Reset, once the cause is gone" : "power cycle";
}

std::string number_of(const DriveParameter& parameter, bool has_objects) {
    if (parameter.reach == axes::ParameterReach::maker_tool) return "-";
    const auto& [index, sub] = parameter.address;
    if (!has_objects) return std::to_string(index);
    return sub == 0 ? fmt::format("{:04X}h", index) : fmt::format("{:04X}h:{:02X}", index, sub);
}

std::string type_of(const DriveParameter& parameter) {
    if (parameter.bits == 1) return "BOOL";
    return parameter.bits == 0 ? "text" : fmt::format("{}{}", parameter.is_signed ? 'I' : 'U', parameter.bits);
}

std::string range_of(const DriveParameter& parameter) {
    if (!parameter.minimum && !parameter.maximum) return "";
    const auto bound = [](const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : std::string{}; };
    return bound(parameter.minimum) + " .. " + bound(parameter.maximum);
}

/// Of one raw count: "0.1 A".
std::string unit_of(const DriveParameter& parameter) {
    if (parameter.unit.empty()) return parameter.scale == 1 ? "" : fmt::format("{:g}", parameter.scale);
    return parameter.scale == 1 ? parameter.unit : fmt::format("{:g} {}", parameter.scale, parameter.unit);
}

/// Only the manual's own value stands alone.
std::string factory_of(const DriveParameter& parameter) {
    if (parameter.bits == 0) return "";
    switch (parameter.factory) {
        case axes::FactoryValue::stated: return std::to_string(parameter.value);
        case axes::FactoryValue::assumed: return fmt::format("{} (assumed)", parameter.value);
        case axes::FactoryValue::unknown: break;
    }
    return parameter.change == axes::ParameterChange::never ? "" : "not stated";
}

std::string_view words(axes::ParameterEffect effect) {
    switch (effect) {
        case axes::ParameterEffect::at_once: return "at once";
        case axes::ParameterEffect::at_standstill: return "at standstill";
        case axes::ParameterEffect::when_enabled: return "at the next enabling";
        case axes::ParameterEffect::after_restart: return "after a restart";
        case axes::ParameterEffect::after_saving: return "after saving and a restart";
    }
    return "";
}

std::string_view words(axes::ParameterChange change) {
    switch (change) {
        case axes::ParameterChange::any_time: return "any time";
        case axes::ParameterChange::disabled: return "not enabled";
        case axes::ParameterChange::never: return "read only";
    }
    return "";
}

std::string both(const std::string& english, const std::string& chinese) {
    return chinese.empty() ? cell(english) : cell(english) + "<br>" + cell(chinese);
}

Result<std::string> read(const std::string& file) {
    std::ifstream stream(file);
    if (!stream)
        return Error{"docs.no_page", file, "this drive has no page",
                     fmt::format("Write one with the lines `{}` and `{}`; the features come between them.",
                                 features_begin.substr(0, features_begin.size() - 1), features_end.substr(0, features_end.size() - 1))};
    return std::string{std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::string drive_alarms_markdown(const config::LoadedDrive& drive) {
    const auto& profile = *drive.profile;
    std::string page = fmt::format(
        "# Alarms of the {}\n\nGenerated from `config/drives/{}.yaml` and what it names (`taktwerk docs drives {}`). The code is that of "
        "603Fh{}; sections are those of\nthe manual.\n\n| code | panel | name | cause | remedy | goes by | section |\n"
        "|---|---|---|---|---|---|---|\n",
        profile.title, profile.name, profile.name, drive.device ? "" : " where a drive has one, else the drive's own number");
    for (const auto& alarm : profile.alarms) {
        const auto code = alarm.detail == 0 ? fmt::format("{:04X}h", alarm.code) : fmt::format("{:04X}h, {:X}h", alarm.code, alarm.detail);
        fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {} | {} | {}{} | {} |\n", code, cell(alarm.panel),
                       both(alarm.english, alarm.chinese), cell(alarm.cause), cell(alarm.remedy), reset_of(alarm),
                       alarm.whole_drive ? "; all axes of the drive" : "", cell(alarm.section));
    }
    return page;
}

std::string drive_parameters_markdown(const config::LoadedDrive& drive) {
    const auto& profile = *drive.profile;
    std::string page = fmt::format(
        "# Parameters of the {}\n\nGenerated from `config/drives/{}.yaml` and what it names (`taktwerk docs drives {}`). Numbers are raw; "
        "the "
        "unit is that of one\nraw count. A factory value is the manual's; \"assumed\" is ours, \"not stated\" nobody's. Sections are those "
        "of the manual.\n\n| {} | | name | type | range | factory | unit | meaning | "
        "changes | counts | section |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
        profile.title, profile.name, profile.name, drive.device ? "object" : "register");
    for (const auto& row : profile.parameters) {
        const bool read_only = row.change == axes::ParameterChange::never;
        fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                       number_of(row, drive.device != nullptr), cell(row.parameter), both(row.name, row.chinese), type_of(row),
                       range_of(row), factory_of(row), cell(unit_of(row)), cell(row.meaning), words(row.change),
                       read_only ? std::string_view{} : words(row.effect), cell(row.section));
    }
    return page;
}

Result<std::string> with_features(const std::string& page, const std::string& features, const std::string& file) {
    const auto begin = page.find(features_begin);
    const auto end = page.find(features_end);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        return Error{"docs.no_marks", file, "the marks around the generated features are missing or in the wrong order",
                     fmt::format("Write a line `{}` and, after it, a line `{}`.", features_begin.substr(0, features_begin.size() - 1),
                                 features_end.substr(0, features_end.size() - 1))};
    return page.substr(0, begin + features_begin.size()) + features + page.substr(end);
}

Result<std::vector<CommittedPage>> drive_pages(const config::LoadedDrive& drive, const std::string& docs_folder) {
    const auto& name = drive.profile->name;
    const auto file = "drives/" + name + ".md";
    const auto page = read(docs_folder + "/" + file);
    if (!page) return page.error();
    auto text = with_features(*page, drive_features_markdown(drive), docs_folder + "/" + file);
    if (!text) return text.error();
    std::vector<CommittedPage> out{{file, std::move(*text)}};
    if (!drive.profile->alarms.empty()) out.push_back({"reference/drives/" + name + "-alarms.md", drive_alarms_markdown(drive)});
    if (!drive.profile->parameters.empty())
        out.push_back({"reference/drives/" + name + "-parameters.md", drive_parameters_markdown(drive)});
    return out;
}

}  // namespace taktwerk::apps
