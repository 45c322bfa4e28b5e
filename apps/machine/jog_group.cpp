#include "apps/machine/jog_group.hpp"

#include <cmath>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "apps/machine/stop_signal.hpp"
#include "config/reading/unit_text.hpp"
#include "core/clock.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto renewed_each = 50ms;
constexpr auto longest_stop = 5s;  ///< longest ramp we wait for after letting go

Json named(const Json& list, const std::string& name) {
    for (const auto& one : list)
        if (one.at("name") == name) return one;
    return {};
}

bool turns(const std::string& direction) { return direction.size() == 3 && direction[0] == 'r'; }

/// What a distance is in: of ways the group's unit, of turns degrees, of single axes theirs. Where these differ nobody could say what one number means.
Result<double> distance_in(const GroupJogOptions& options, const Json& layout) {
    if (options.distance.empty()) return 0.0;
    std::string unit;
    for (const auto& direction : options.directions) {
        std::string own = "deg";
        if (options.frame == "acs") {
            const auto axis = named(layout.at("axes"), direction.substr(0, direction.size() - 1));
            if (!axis.is_object()) continue;  // the machine says so
            own = axis.at("unit").get<std::string>();
        } else if (!turns(direction)) {
            own = named(layout.at("groups"), options.group).value("unit", std::string{});
        }
        if (!unit.empty() && own != unit)
            return Error{"usage.distance", options.distance, fmt::format("the directions are in {} and in {}", unit, own),
                         "Jog one behind the other, or leave --distance out."};
        unit = own;
    }
    auto distance = config::value_in(options.distance, unit);
    if (distance && !(*distance > 0))
        return Error{"usage.distance", options.distance, "a distance is above 0", "Say the sense with the direction: x+ or x-."};
    return distance;
}

Result<double> part_of(const std::string& text) {
    const auto percent = config::value_in(text, "%");
    if (!percent) return percent.error();
    if (!(*percent > 0 && *percent <= 100))
        return Error{"usage.velocity", text, "a group is jogged with a part of its jogging velocity, above 0 and up to 100 %",
                     "Give for example --velocity 20%; the sense stands in the direction: x+ or x-."};
    // 0.2 is mostly meant as a fifth, and moves so slowly that nobody sees it move.
    if (*percent < 1 && text.find('%') == std::string::npos)
        return Error{"usage.velocity", text, "a bare number is per cent, and this is less than one",
                     fmt::format("Write `{:g}%` if you mean a part of 1, or `{:g}%` if it is to be so slow.", 100 * *percent, *percent)};
    return *percent / 100;
}

/// "arm: X 10.000  Y 5.000 ... mm", or its axes.
std::string place_of(const Json& group) {
    std::string out;
    if (group.value("tool_known", false)) {
        constexpr const char* components[] = {"X", "Y", "Z", "RX", "RY", "RZ"};
        for (std::size_t i = 0; i < 6; ++i)
            out += fmt::format("{}{} {:.3f}", i == 0 ? "" : "  ", components[i], hmi::number_of(group.at("tool_actual")[i]));
        return out + fmt::format("  [{}, deg]", group.at("unit").get<std::string>());
    }
    for (const auto& member : group.at("members"))
        out += fmt::format("{}{} {:.3f} {}", out.empty() ? "" : "  ", member.at("axis").get<std::string>(),
                           hmi::number_of(member.at("actual_position")), member.at("unit").get<std::string>());
    return out;
}

/// What keeps it slower than it was told to.
std::string held_back(const Json& group, const std::string& frame) {
    const auto limiter = group.at("limiter").get<std::string>();
    // Below a millionth it stands, and nothing holds a velocity back that is none.
    if (hmi::number_of(group.at("override")) * hmi::number_of(group.at("operators_override")) < 1e-6)
        return "; it does not move: the override is 0 % (`taktwerk override 100`, `taktwerk group override`)";
    if (limiter == "setup_velocity") return "; slower than asked: set-up mode holds the tool's point down (setup_velocity of the group)";
    if (limiter == "override_factor") return "; slower than asked: the override holds it down (`taktwerk group override`)";
    // Of a ramp every axis may be at its limit.
    constexpr double lasting = 2.5;  // s, until its velocity would be another one
    const bool ramps =
        std::abs(hmi::number_of(group.at("path_acceleration"))) * lasting > std::abs(hmi::number_of(group.at("path_velocity")));
    // In acs an axis is asked for a part of what mode and limits leave it: the whole of that is no less than asked.
    if (limiter == "axis_limit" && frame != "acs" && !ramps)
        return fmt::format("; slower than asked: axis {} is at what the mode and its limits leave it",
                           group.at("limiting_axis").get<std::string>());
    return "";
}

}  // namespace

int jog_group(const RemoteOptions& remote, const GroupJogOptions& options, hmi::Client& client) {
    const auto layout = layout_of(client);
    if (!layout) return report(remote, layout.error());
    const auto distance = distance_in(options, *layout);
    if (!distance) return report(remote, distance.error());
    const auto part = part_of(options.speed);
    if (!part) return report(remote, part.error());
    watch_stop_signals();
    SystemClock clock;
    const auto start = clock.now();
    const bool show = !remote.json && ::isatty(STDOUT_FILENO) != 0;
    std::string held;
    bool stands = false, arrived = false;

    for (bool press = true; !stop_requested() && !arrived; press = false) {
        nlohmann::json request{{"cmd", "group_jog"},
                               {"group", options.group},
                               {"frame", options.frame},
                               {"direction", fmt::format("{}", fmt::join(options.directions, " "))},
                               {"velocity", *part}};
        if (press) request["press"] = true;
        if (*distance > 0) request["distance"] = *distance;
        const auto answer = client.request(request);
        if (!answer) return report(remote, answer.error());
        // Where it stands it has arrived only if a renewal behind that says so: what else may have stopped it is that one's refusal.
        arrived = stands;
        const auto state = state_of(client);
        const auto group = state ? named(state->at("groups"), options.group) : Json{};
        if (group.is_object()) {
            if (const auto now = held_back(group, options.frame); !now.empty()) held = now;
            if (show) fmt::print("\r{} {}   Ctrl-C stops ", options.group, place_of(group));
            if (show) std::fflush(stdout);
            // Its last press has an answer, so that what is seen here is not what was before it.
            stands = !press && *distance > 0 && group.at("state") == "GroupStandby";
        }
        if (options.for_s > 0 && clock.now() - start >= from_seconds(options.for_s) && !stands) break;
        std::this_thread::sleep_for(renewed_each);
    }
    if (show) fmt::print("\n");
    if (*distance > 0 && !arrived) held = fmt::format("; let go before all of {} was gone", options.distance) + held;
    const auto released = client.request({{"cmd", "group_jog"}, {"group", options.group}, {"velocity", 0}});
    if (!released) return report(remote, released.error());
    for (const auto end = clock.now() + longest_stop; clock.now() < end;) {
        const auto state = state_of(client);
        if (!state) return report(remote, state.error());
        const auto group = named(state->at("groups"), options.group);
        if (!group.is_object()) break;
        if (group.at("state") != "GroupMoving")
            return report(remote, fmt::format("{}: stands at {}{}", options.group, place_of(group), held));
        std::this_thread::sleep_for(20ms);
    }
    return report(remote, options.group + ": let go");
}

}  // namespace taktwerk::apps
