#include "apps/machine/health.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

/// A part that may not be there; one of another type throws, as everything here does (understood() of remote.hpp makes words of it).
Json part(const Json& object, const char* key, const Json& otherwise) { return object.value(key, otherwise); }

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

Health health_of(const Json& hello, const Json& told) {
    constexpr std::uint64_t none = 0;
    const bool cycles = told.is_object();
    const auto& state = cycles ? told : Json::object();
    Health h;
    h.machine = hello.value("machine", std::string{});
    h.version = hello.value("version", std::string{});
    h.process = hello.value("pid", 0LL);
    h.uptime_s = hello.value("uptime_s", 0.0);
    h.phase = state.value("phase", std::string{});
    h.mode = state.value("mode", std::string{});
    h.simulated = state.value("simulated", false);
    h.emergency_stop = state.value("emergency_stop", false);
    h.bus = part(state, "bus", Json::object()).value("phase", std::string{});
    h.frames_lost = part(state, "bus", Json::object()).value("frames_lost", none);
    const auto statistics = part(state, "statistics", Json::object());
    h.cycles = statistics.value("cycles", none);
    h.missed = statistics.value("missed_ticks", none);
    h.lateness_max_us = statistics.value("lateness_max_ns", 0.0) / 1000;
    h.compute_max_us = statistics.value("compute_max_ns", 0.0) / 1000;
    h.page_faults = statistics.value("page_faults", none);
    for (const auto& axis : part(state, "axes", Json::array())) {
        ++h.axes;
        h.powered += axis.value("powered", false) ? 1 : 0;
        h.homed += axis.value("homed", false) ? 1 : 0;
    }
    for (const auto& program : part(state, "programs", Json::array()))
        h.programs.emplace_back(program.value("name", std::string{}), program.value("state", std::string{}));
    for (const auto& group : part(state, "groups", Json::array()))
        if (group.value("held", false)) h.held.push_back(group.value("name", std::string{}));
    for (const auto& task : part(state, "tasks", Json::array()))
        h.tasks.push_back({task.value("name", std::string{}), task.value("releases", none), task.value("overruns", none),
                           task.value("run_ns", 0.0) / 1000, task.value("run_max_ns", 0.0) / 1000});
    for (const auto& alarm : part(state, "alarms", Json::array()))
        if (auto reaction = alarm.value("reaction", std::string{}); stops_something(reaction))
            h.alarms.push_back({alarm.value("source", std::string{}), alarm.value("name", std::string{}),
                                alarm.value("english", std::string{}), std::move(reaction), alarm.value("standing", false)});
    judge(h, hello.value("cycling", false) && cycles, hello.value("progress", std::string{}));
    return h;
}

std::string health_text(const Health& h) {
    auto text = fmt::format("{}: {}{}\n", h.machine, h.well() ? "well" : "NOT WELL", h.simulated ? ", SIMULATED bus" : "");
    for (const auto& why : h.unwell) text += fmt::format("  ! {}\n", why);
    if (!h.mode.empty())
        text += fmt::format("  {}, {} mode; {} of {} axes powered, {} homed\n", h.phase, h.mode, h.powered, h.axes, h.homed);
    for (const auto& [name, state] : h.programs) text += fmt::format("  program {}: {}\n", name, state);
    for (const auto& name : h.held)
        text += fmt::format("  group {}: a person has interrupted it; `taktwerk group continue {}` lets it go on\n", name, name);
    for (const auto& task : h.tasks)
        text += fmt::format("  task {}: {} runs, {} overruns, {:.0f} us, at most {:.0f} us\n", task.name, task.runs, task.overruns,
                            task.run_us, task.run_max_us);
    if (h.cycles > 0)
        text += fmt::format(
            "  {} cycles, {} ticks missed, wake-up at most {:.0f} us late, computing at most {:.0f} us; {} frames lost; {} "
            "page faults of the cycle\n",
            h.cycles, h.missed, h.lateness_max_us, h.compute_max_us, h.frames_lost, h.page_faults);
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
              {"page_faults", h.page_faults},
              {"version", h.version},
              {"pid", h.process},
              {"uptime_s", h.uptime_s}};
    auto& programs = json["programs"] = Json::array();
    for (const auto& [name, state] : h.programs) programs.push_back({{"name", name}, {"state", state}});
    json["held"] = h.held;
    auto& tasks = json["tasks"] = Json::array();
    for (const auto& task : h.tasks)
        tasks.push_back({{"name", task.name},
                         {"runs", task.runs},
                         {"overruns", task.overruns},
                         {"run_us", task.run_us},
                         {"run_max_us", task.run_max_us}});
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
