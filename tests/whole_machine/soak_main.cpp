// machine_soak MACHINE [HOURS [SEED]]: hours of virtual time, a line for each, a table at the end. Exit code 1: something was wrong, with the reason.

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <string>

#include "core/clock.hpp"
#include "tests/whole_machine/long_day.hpp"

int main(int count, char** words) {
    using namespace taktwerk;
    using namespace taktwerk::whole;
    const std::string machine = count > 1 ? words[1] : "demo";
    const double hours = count > 2 ? std::strtod(words[2], nullptr) : 24;
    const auto seed = static_cast<std::uint32_t>(count > 3 ? std::strtoul(words[3], nullptr, 10) : 1);
    constexpr std::size_t most_growth = 512 * 1024;  // bytes, from the end of the first hour on
    const SystemClock clock;
    const auto begin = clock.now();
    fmt::print("{}, {} h of virtual time, seed {}\n{:>8} {:>9} {:>9} {:>9} {:>9} {:>11} {:>10} {:>9}\n", machine, hours, seed, "virtual",
               "real", "troubles", "alarms", "commands", "places", "references", "heap");
    LongDay day{machine, seed};
    bool grown = false;
    const auto every = hours >= 1 ? Duration{std::chrono::hours{1}} : from_seconds(hours * 3600 / 4);
    day.live(from_seconds(hours * 3600), every, [&](const LongDay::Hour& hour) {
        fmt::print("{:>6.2f} h {:>7.0f} s {:>9} {:>9} {:>9} {:>11} {:>10} {:>6} kB\n", to_seconds(hour.at) / 3600,
                   to_seconds(clock.now() - begin), hour.troubles, hour.alarms, hour.commands, hour.compared, hour.references,
                   hour.heap / 1024);
        std::fflush(stdout);
        grown = grown || hour.heap > day.hours().front().heap + most_growth;
    });
    day.end();
    fmt::print("{}", day.table());
    for (const auto& problem : day.problems()) fmt::print("WRONG: {}\n", problem);
    if (!day.problems().empty()) fmt::print("{}", day.story());
    if (grown) fmt::print("WRONG: memory has grown by more than {} kB\n", most_growth / 1024);
    const bool wrong = grown || !day.problems().empty();
    fmt::print("{}\n", wrong ? "not well" : "well: each alarm explained, positions exact, memory flat, told = shown");
    return wrong ? 1 : 0;
}
