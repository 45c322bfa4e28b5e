#include "apps/machine/health.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

/// What stands there, if it is of that kind: an answer may be anybody's.
template <class T>
T get(const Json& object, const char* key, T otherwise = {}) {
    if (!object.is_object()) return otherwise;
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if constexpr (std::is_same_v<T, std::string>) {
        if (!found->is_string()) return otherwise;
    } else if constexpr (std::is_same_v<T, bool>) {
        if (!found->is_boolean()) return otherwise;
    } else if (!found->is_number()) {
        return otherwise;
    }
    return found->template get<T>();
}

const Json& part(const Json& object, const char* key) {
    static const Json nothing;
    if (!object.is_object()) return nothing;
    const auto found = object.find(key);
    return found == object.end() ? nothing : *found;
}

bool stops_something(const std::string& reaction) { return reaction != "none" && reaction != "warn"; }

void judge(Health& h, bool cycling, const std::string& progress) {
    if (!cycling) h.unwell.push_back(progress.empty() ? "it does not cycle" : "it does not cycle: " + progress);
    else if (h.bus != "operational") h.unwell.push_back(fmt::format("the bus is {}", h.bus.empty() ? "unknown" : h.bus));
    else if (h.phase != "running") h.unwell.push_back("it is " + (h.phase.empty() ? std::string("in no known phase") : h.phase));
    if (h.emergency_stop) h.unwell.emplace_back("the emergency stop is pressed");
    for (const auto& alarm : h.alarms)
        h.unwell.push_back(fmt::format("{}, {}{}: {}", alarm.source, alarm.name, alarm.standing ? "" : " (waits for a reset)", alarm.text));
    for (const auto& [name, state] : h.programs)
        if (state == "fault") h.unwell.push_back(fmt::format("program {} is in fault", name));
}

}  // namespace

Health health_of(const Json& hello, const Json& state) {
    Health h;
    h.machine = get<std::string>(hello, "machine");
    h.version = get<std::string>(hello, "version");
    h.process = get<long long>(hello, "pid");
    h.uptime_s = get<double>(hello, "uptime_s");
    h.phase = get<std::string>(state, "phase");
    h.mode = get<std::string>(state, "mode");
    h.simulated = get<bool>(state, "simulated");
    h.emergency_stop = get<bool>(state, "emergency_stop");
    h.bus = get<std::string>(part(state, "bus"), "phase");
    h.frames_lost = get<double>(part(state, "bus"), "frames_lost");
    const auto& statistics = part(state, "statistics");
    h.cycles = get<double>(statistics, "cycles");
    h.missed = get<double>(statistics, "missed_ticks");
    h.lateness_max_us = get<double>(statistics, "lateness_max_ns") / 1000;
    h.compute_max_us = get<double>(statistics, "compute_max_ns") / 1000;
    if (const auto& axes = part(state, "axes"); axes.is_array())
        for (const auto& axis : axes) {
            ++h.axes;
            h.powered += get<bool>(axis, "powered") ? 1 : 0;
            h.homed += get<bool>(axis, "homed") ? 1 : 0;
        }
    if (const auto& programs = part(state, "programs"); programs.is_array())
        for (const auto& program : programs) h.programs.emplace_back(get<std::string>(program, "name"), get<std::string>(program, "state"));
    if (const auto& alarms = part(state, "alarms"); alarms.is_array())
        for (const auto& alarm : alarms)
            if (auto reaction = get<std::string>(alarm, "reaction"); stops_something(reaction))
                h.alarms.push_back({get<std::string>(alarm, "source"), get<std::string>(alarm, "name"), get<std::string>(alarm, "english"),
                                    std::move(reaction), get<bool>(alarm, "standing")});
    judge(h, get<bool>(hello, "cycling") && state.is_object(), get<std::string>(hello, "progress"));
    return h;
}

std::string health_text(const Health& h) {
    auto text = fmt::format("{}: {}{}\n", h.machine, h.well() ? "well" : "NOT WELL", h.simulated ? ", SIMULATED bus" : "");
    for (const auto& why : h.unwell) text += fmt::format("  ! {}\n", why);
    if (!h.mode.empty())
        text += fmt::format("  {}, {} mode; {} of {} axes powered, {} homed\n", h.phase, h.mode, h.powered, h.axes, h.homed);
    for (const auto& [name, state] : h.programs) text += fmt::format("  program {}: {}\n", name, state);
    if (h.cycles > 0)
        text += fmt::format(
            "  {:.0f} cycles, {:.0f} ticks missed, wake-up at most {:.0f} us late, computing at most {:.0f} us; {:.0f} frames lost\n",
            h.cycles, h.missed, h.lateness_max_us, h.compute_max_us, h.frames_lost);
    return text + fmt::format("  taktwerk {}, process {}, up {:.0f} s\n", h.version, h.process, h.uptime_s);
}

Json health_json(const Health& h) {
    Json json{{"machine", h.machine},
              {"well", h.well()},
              {"unwell", h.unwell},
              {"phase", h.phase},
              {"mode", h.mode},
              {"bus", h.bus},
              {"simulated", h.simulated},
              {"emergency_stop", h.emergency_stop},
              {"axes", {{"all", h.axes}, {"powered", h.powered}, {"homed", h.homed}}},
              {"cycles", h.cycles},
              {"missed_ticks", h.missed},
              {"lateness_max_us", h.lateness_max_us},
              {"compute_max_us", h.compute_max_us},
              {"frames_lost", h.frames_lost},
              {"version", h.version},
              {"pid", h.process},
              {"uptime_s", h.uptime_s}};
    auto& programs = json["programs"] = Json::array();
    for (const auto& [name, state] : h.programs) programs.push_back({{"name", name}, {"state", state}});
    auto& alarms = json["alarms"] = Json::array();
    for (const auto& alarm : h.alarms)
        alarms.push_back({{"source", alarm.source},
                          {"name", alarm.name},
                          {"text", alarm.text},
                          {"reaction", alarm.reaction},
                          {"standing", alarm.standing}});
    return json;
}

}  // namespace taktwerk::apps
