// taktwerk drive get, set: single parameters.

#include <fmt/format.h>

#include "apps/drive.hpp"
#include "apps/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using axes::DriveParameter;
using Values = std::vector<config::ParameterSet::Value>;

struct Options {
    std::shared_ptr<DriveOptions> drive;
    std::vector<std::string> words;
};

std::string text_of(const std::vector<std::byte>& bytes) {
    std::string out;
    for (const auto b : bytes)
        if (const auto c = std::to_integer<unsigned char>(b); c >= 0x20) out += static_cast<char>(c);
    return out;
}

int get(const Options& options) {
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

/// "P05.13=300 ms".
Result<Values> parsed(const axes::DriveProfile& profile, const std::vector<std::string>& words) {
    Values out;
    for (const auto& word : words) {
        const auto equals = word.find('=');
        if (equals == std::string::npos) return Error{"drive.value", word, "has no '='", "write it as P05.13=300"};
        const auto found = axes::find_parameter(profile, word.substr(0, equals));
        if (!found) return found.error();
        const auto raw = axes::parse_value(**found, word.substr(equals + 1));
        if (!raw) return raw.error();
        out.push_back({*found, *raw});
    }
    return out;
}

int set(const Options& options) {
    const auto& bus = *options.drive->bus;
    return with_drive(*options.drive, [&](DriveAccess& drive) {
        const auto values = parsed(drive.profile(), options.words);
        if (!values) return fail(bus, values.error());
        const auto written = write_values(drive, *values, options.drive->storing);
        return report_written(bus, drive, written);
    });
}

}  // namespace

void add_drive_values(CLI::App& drive, Action& action) {
    auto* getting = drive.add_subcommand("get", "parameters of a drive");
    auto options = std::make_shared<Options>();
    options->drive = add_drive_options(*getting);
    add_drive_choice(*getting, *options->drive);
    getting->add_option("PARAMETER", options->words, "P05.13, PA17, Pr098, 6084h, 2005h:0E")->required();
    getting->callback([&action, options] { action = [options] { return get(*options); }; });

    auto* setting = drive.add_subcommand("set", "change parameters of a drive; each is read back");
    auto set_options = std::make_shared<Options>();
    set_options->drive = add_drive_options(*setting);
    add_drive_choice(*setting, *set_options->drive);
    setting->add_option("PARAMETER=VALUE", set_options->words, "P05.13=300, 'P05.13=300 ms', 6084h=0x1000")->required();
    add_store_option(*setting, *set_options->drive);
    setting->callback([&action, set_options] { action = [set_options] { return set(*set_options); }; });
}

}  // namespace taktwerk::apps
