// taktwerk drive get, set: single parameters.

#include <algorithm>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using axes::DriveParameter;
using Values = std::vector<config::ParameterSet::Value>;

struct ValueOptions {
    std::shared_ptr<DriveOptions> drive;
    std::vector<std::string> words;
};

std::string text_of(const std::vector<std::byte>& bytes) {
    std::string out;
    for (const auto b : bytes)
        if (const auto c = std::to_integer<unsigned char>(b); c >= 0x20) out += static_cast<char>(c);
    return out;
}

int get(const ValueOptions& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        auto json = Json::array();
        for (const auto& word : options.words) {
            const auto found = axes::find_parameter(drive.profile(), word);
            if (!found) return fail(bus, found.error());
            const auto& parameter = **found;
            const auto bytes = drive.read_bytes(parameter);
            if (!bytes) return fail(bus, bytes.error());
            std::string shown;
            if (parameter.bits == 0) {
                shown = text_of(*bytes);
            } else {
                const auto raw = axes::from_bytes(parameter, *bytes);
                if (!raw) return fail(bus, raw.error());
                shown = axes::value_text(parameter, *raw);
            }
            json.push_back(Json{{"parameter", axes::name_of(parameter)}, {"name", parameter.name}, {"shown", shown}});
            if (!bus.json) {
                fmt::print("{} ({}) = {}\n", axes::name_of(parameter), parameter.name, shown);
                if (!parameter.meaning.empty()) fmt::print("    {}\n", wrapped(parameter.meaning, 4));
            }
        }
        if (bus.json) print_json(json);
        return static_cast<int>(exit_ok);
    });
}

/// Of this drive, and such as it could be meant.
std::string example(const axes::DriveProfile& profile, const std::vector<std::string>& words, std::size_t at) {
    if (axes::find_parameter(profile, words[at])) return fmt::format("write {}=VALUE", words[at]);
    if (at > 0) return fmt::format("if it belongs to the value before it, put both in quotes: '{} {}'", words[at - 1], words[at]);
    const auto& rows = profile.parameters;
    const auto setting = std::find_if(rows.begin(), rows.end(), [](const DriveParameter& p) { return axes::is_setting(p); });
    if (setting == rows.end()) return "write PARAMETER=VALUE";
    const bool known = setting->factory != axes::FactoryValue::unknown;
    return fmt::format("write PARAMETER=VALUE, such as '{}={}'", axes::name_of(*setting),
                       known ? axes::value_text(*setting, setting->value) : "VALUE");
}

int set(const ValueOptions& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto values = parsed_assignments(drive.profile(), options.words);
        if (!values) return fail(bus, values.error());
        if (const auto refusal = needs_a_yes(drive, *values))
            if (const auto sure = confirm(drive, *refusal, bus.yes); !sure) return fail(bus, sure.error());
        const auto written = write_values(drive, *values, options.drive->storing);
        return report_written(bus, drive, written);
    });
}

}  // namespace

Result<Values> parsed_assignments(const axes::DriveProfile& profile, const std::vector<std::string>& words) {
    Values out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto& word = words[i];
        const auto equals = word.find('=');
        if (equals == std::string::npos) return Error{"drive.value", word, "has no '='", example(profile, words, i)};
        const auto found = axes::find_parameter(profile, word.substr(0, equals));
        if (!found) return found.error();
        const auto raw = axes::parse_value(profile, **found, word.substr(equals + 1));
        if (!raw) return raw.error();
        if (std::any_of(out.begin(), out.end(), [&](const auto& earlier) { return earlier.parameter == *found; }))
            return Error{"drive.twice", axes::name_of(**found), "is given twice: nobody can tell which value is meant",
                         "leave one of them away"};
        out.push_back({*found, *raw});
    }
    return out;
}

void add_drive_values(CLI::App& drive, Action& action) {
    auto* getting = drive.add_subcommand("get", "parameters of a drive");
    auto options = std::make_shared<ValueOptions>();
    options->drive = add_drive_options(*getting);
    add_drive_choice(*getting, *options->drive);
    getting->add_option("PARAMETER", options->words, "P05.13, PA17, Pr098, 6084h, 2005h:0E")->required();
    getting->callback([&action, options] { action = [options] { return get(*options); }; });

    auto* setting = drive.add_subcommand("set", "change parameters of a drive; each is read back");
    auto set_options = std::make_shared<ValueOptions>();
    set_options->drive = add_drive_options(*setting);
    add_drive_choice(*setting, *set_options->drive);
    setting->add_option("PARAMETER=VALUE", set_options->words, "P05.13=300, 'P05.13=300 ms', 6084h=0x1000")->required();
    add_store_option(*setting, *set_options->drive);
    setting->add_flag("--yes", set_options->drive->bus->yes, "do not ask before what is no setting is written: a command to the drive");
    setting->callback([&action, set_options] { action = [set_options] { return set(*set_options); }; });
}

}  // namespace taktwerk::apps
