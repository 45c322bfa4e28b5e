// taktwerk doctor: is this computer fit for a machine's cycle, and what would mend it?

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "apps/doctor/changes.hpp"
#include "apps/doctor/examine.hpp"
#include "apps/doctor/host_files.hpp"
#include "apps/machine/running_machine.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/terminal_size.hpp"

namespace taktwerk::apps {
namespace {

struct DoctorOptions {
    std::string interface;
    double cycle_s = 1e-3, computing_s = 0, duration_s = 5;
    int cpu = -1;
    bool json = false, apply = false, revert = false, no_measuring = false, why = false;
};

Duration of_seconds(double seconds) { return Duration{static_cast<std::int64_t>(seconds * 1e9 + 0.5)}; }

int exit_code_of(Severity fitness) {
    return fitness == Severity::unfit ? exit_realtime : fitness == Severity::warning ? exit_warnings : exit_ok;
}

using Json = nlohmann::ordered_json;

Json json_of(const Error& error) {
    return {{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}};
}

void print_json(const Json& json) { fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

int refused(const DoctorOptions& options, const Error& error, int code) {
    if (options.json) print_json({{"ok", false}, {"error", json_of(error)}});
    else print_error(error);
    return code;
}

bool all_done(const std::vector<ChangeOutcome>& outcomes) {
    return std::none_of(outcomes.begin(), outcomes.end(), [](const auto& outcome) { return outcome.error || outcome.left; });
}

void say(const std::vector<ChangeOutcome>& outcomes, const char* nothing) {
    for (const auto& outcome : outcomes) {
        fmt::print("  {}\n", outcome.words);
        if (outcome.error) print_error(*outcome.error);
    }
    if (outcomes.empty()) fmt::print("  {}\n", nothing);
}

Json json_of(const std::vector<ChangeOutcome>& outcomes) {
    auto list = Json::array();
    for (const auto& outcome : outcomes) {
        Json one{{"words", outcome.words}, {"left", outcome.left}};
        if (outcome.error) one["error"] = json_of(*outcome.error);
        list.push_back(std::move(one));
    }
    return list;
}

/// Why nothing may be changed here; nothing: it may. `recorded`: what --revert would put back.
std::optional<Error> why_not(const DoctorOptions& options, const std::vector<AppliedChange>& recorded) {
    if (::geteuid() != 0)
        return Error{"doctor.needs_root", options.apply ? "--apply" : "--revert", "settings of this computer are changed by root alone",
                     "sudo taktwerk doctor ...; without --apply it only looks, and shows the commands"};
    std::set<std::string> interfaces;
    if (!options.interface.empty()) interfaces.insert(options.interface);
    for (const auto& each : recorded)
        if (options.revert && each.change.kind == HostChange::Kind::ethernet) interfaces.insert(each.change.target);
    for (const auto& interface : interfaces)
        if (const auto machine = machine_on(interface, {}))
            return Error{"doctor.machine_runs", interface,
                         fmt::format("{} runs on it, and some of these settings take its link away for seconds", machine->name),
                         "end that run first (taktwerk shutdown)"};
    return std::nullopt;
}

int revert(const DoctorOptions& options, EthernetPorts& ports) {
    Changes changes{"/", ports};
    const auto recorded = changes.recorded();
    if (!recorded) return refused(options, recorded.error(), exit_bad_file);
    if (const auto why = why_not(options, *recorded)) return refused(options, *why, exit_refused);
    const auto done = changes.revert();
    if (!done) return refused(options, done.error(), exit_bad_file);
    if (options.json) {
        print_json({{"ok", all_done(*done)}, {"taken_back", json_of(*done)}});
    } else {
        fmt::print("Taken back:\n");
        say(*done, "nothing: no change of `doctor --apply` is recorded here");
    }
    return all_done(*done) ? exit_ok : exit_warnings;
}

/// `told`: of --json, what it says in the end.
int apply(const DoctorOptions& options, const Examination& seen, EthernetPorts& ports, Json& told) {
    if (const auto why = why_not(options, {})) return refused(options, *why, exit_refused);
    Changes changes{"/", ports};
    std::vector<ChangeOutcome> done;
    for (const auto& finding : seen.findings) {
        auto some = changes.apply_together(finding.changes);
        if (!some) return refused(options, some.error(), exit_bad_file);
        done.insert(done.end(), std::make_move_iterator(some->begin()), std::make_move_iterator(some->end()));
    }
    std::vector<std::string> commands;
    for (const auto& finding : seen.findings)
        if (!finding.changes.empty() && !finding.then.empty()) commands.push_back(finding.then);
    told = Json{{"ok", all_done(done)}, {"changed", json_of(done)}, {"takes_effect_with", commands}};
    if (!options.json) {
        fmt::print("Changed (`taktwerk doctor --revert` takes it back):\n");
        say(done, "nothing: what can be changed from here is as it should be");
        for (const auto& command : commands) fmt::print("  takes effect with: {}\n", command);
        fmt::print("\n");
    } else if (!all_done(done)) {
        print_json(told);
    }
    return all_done(done) ? exit_ok : exit_bad_file;
}

int run_doctor(const DoctorOptions& options) {
    Wanted wanted;
    wanted.cycle = of_seconds(options.cycle_s);
    wanted.computing = options.computing_s > 0 ? of_seconds(options.computing_s) : wanted.cycle / 10;
    wanted.cpu = options.cpu;
    if (wanted.cycle < std::chrono::microseconds{50} || wanted.cycle > std::chrono::seconds{1}) {
        return refused(options, {"usage.cycle", "--cycle", "a cycle of 50 us to 1 s is wanted", "leave it out for 1ms"}, exit_usage);
    }
    KernelEthernetPorts ports;
    ::umask(022);  // what is written is the computer's: others read it
    if (options.revert) return revert(options, ports);
    auto seen = examine("/", ports, wanted, options.interface);
    if (options.cpu >= 0 && !HostFiles{}.exists(fmt::format("/sys/devices/system/cpu/cpu{}", options.cpu))) {
        return refused(options, {"realtime.cpus", fmt::format("CPU {}", options.cpu), "there is no such CPU", "See `lscpu`"}, exit_usage);
    }
    Json changed;
    if (options.apply) {
        // root has every right: what is to be had is for those that a machine runs as.
        auto of_others = wanted;
        of_others.of_others = true;
        if (const int code = apply(options, examine("/", ports, of_others, options.interface), ports, changed); code != exit_ok)
            return code;
        seen = examine("/", ports, wanted, options.interface);
    }
    if (!options.no_measuring) {
        if (!options.json && terminal_size()) fmt::print(stderr, "measuring for {} ...\n", time_text(of_seconds(options.duration_s)));
        measure(seen, of_seconds(options.duration_s));
    }
    if (options.json) {
        auto report = report_json(seen);
        if (options.apply) report.update(changed);
        print_json(report);
    } else {
        fmt::print("{}", report_text(seen, colours_of_output(), terminal_size().value_or(TerminalSize{100, 24}).columns,
                                     options.why ? Sources::shown : Sources::hidden));
        if (options.computing_s <= 0)
            fmt::print(
                "Computing time was taken as a tenth of the cycle; `--computing 200us` says it (`taktwerk status` of a running machine has "
                "it).\n");
    }
    const bool no_port = std::any_of(seen.findings.begin(), seen.findings.end(), [](const Finding& f) { return f.code == "port.missing"; });
    return no_port ? exit_bus : exit_code_of(seen.verdict.fitness);
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand(
        "doctor",
        "is this computer fit for a machine's cycle? what it costs, and how to mend it; exit code 0: fit, 1: with warnings, 7: not");
    auto options = std::make_shared<DoctorOptions>();
    sub->add_option("--nic", options->interface,
                    "network interface of the bus: looked at as well, and measured with frames that change nothing");
    add_duration(*sub, "--cycle", options->cycle_s, "cycle that is wanted; default: 1ms");
    add_duration(*sub, "--computing", options->computing_s, "computing time of a cycle; default: a tenth of it");
    sub->add_option("--cpu", options->cpu, "CPU of the cycle (`realtime: {cpus: [N]}`); default: any")->check(CLI::Range(0, 1023));
    add_duration(*sub, "--duration", options->duration_s,
                 "of measuring; default: 5s. For a judgement that lasts: 1h, with the computer as busy as it will be");
    sub->add_flag("--no-measuring", options->no_measuring, "only look");
    sub->add_flag("--why", options->why, "where each figure is from");
    sub->add_flag("--json", options->json, "everything as one JSON object, with histograms");
    auto* apply = sub->add_flag("--apply", options->apply, "mend what can be mended from here, and say each change; needs root");
    sub->add_flag("--revert", options->revert, "put back exactly what was there before --apply; needs root")->excludes(apply);
    sub->footer(
        "  taktwerk doctor --nic eth1 --cycle 1ms --cpu 3\n"
        "  taktwerk doctor --nic eth1 --cycle 1ms --cpu 3 --duration 1h      a judgement that lasts\n"
        "  sudo taktwerk doctor --nic eth1 --apply");
    sub->callback([&action, options] { action = [options] { return run_doctor(*options); }; });
}

}  // namespace taktwerk::apps
