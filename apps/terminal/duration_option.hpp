#pragma once
// A time on the command line: "200us", "500ms", "2s", "1min", "4h"; a bare number is seconds.

#include <cstdlib>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace taktwerk::apps {

/// `seconds` keeps its value when the option is not given.
inline CLI::Option* add_duration(CLI::App& app, const std::string& name, double& seconds, const std::string& doc) {
    return app.add_option(name, seconds, doc)
        ->transform(
            CLI::AsNumberWithUnit(std::map<std::string, double>{{"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}}))
        ->check(CLI::Validator(
            [](const std::string& value) {
                constexpr double longest = 1e8;  // three years, and what a clock counts
                const double seconds = std::strtod(value.c_str(), nullptr);
                return seconds > 0 && seconds <= longest
                           ? std::string{}
                           : "a time above 0 and up to 1e8 s is wanted, not " + value + "; without the option it is as its help says";
            },
            ""))
        ->type_name("TIME");
}

}  // namespace taktwerk::apps
