// taktwerk measure AXIS KIND: the axis is measured while this command lives, by the lease of a jog; when it ends or dies, the axis stops. Says
// where it will go before it goes. The words of a result: measure_text.cpp.

#include <cstdio>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/machine/measure_text.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "config/reading/unit_text.hpp"
#include "core/clock.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

constexpr auto measure_renewal = 50ms;
constexpr auto measure_patience = 30s;  ///< a long sweep's, on a small computer

struct MeasureOptions {
    RemoteOptions remote;
    std::string axis, kind, csv;
    std::string distance, velocity, acceleration, period, window;  // as written, with a unit or without
    std::optional<int> count;
    std::optional<double> from_hz, to_hz;
    double window_u = 0;
    bool only_plan = false;
};

/// Numbers in the axis' unit.
Result<nlohmann::json> order_of(hmi::Client& client, MeasureOptions& options) {
    nlohmann::json order{{"axis", options.axis}, {"kind", options.kind}};
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    std::string unit;
    for (const auto& axis : layout->at("axes"))
        if (axis.at("name") == options.axis) unit = axis.at("unit").get<std::string>();
    const struct {
        const char* key;
        const std::string& text;
        std::string unit;
    } numbers[] = {{"distance", options.distance, unit},
                   {"velocity", options.velocity, unit + "/s"},
                   {"acceleration", options.acceleration, unit + "/s2"},
                   {"period", options.period, unit}};
    for (const auto& number : numbers) {
        if (number.text.empty()) continue;
        const auto value = config::value_in(number.text, number.unit);
        if (!value) return value.error();
        order[number.key] = *value;
    }
    if (!options.window.empty()) {
        const auto window = config::value_in(options.window, unit);
        if (!window) return window.error();
        options.window_u = *window;
    }
    if (options.count) order["count"] = *options.count;
    if (options.from_hz) order["from_hz"] = *options.from_hz;
    if (options.to_hz) order["to_hz"] = *options.to_hz;
    return order;
}

Result<Json> result_of(hmi::Client& client, const MeasureOptions& options) {
    nlohmann::json question{{"cmd", "measure_result"}, {"axis", options.axis}};
    if (options.window_u > 0) question["window"] = options.window_u;
    auto answer = client.request(question, measure_patience);
    if (!answer) return answer.error();
    return answer->at("measure_result");
}

int measure(MeasureOptions options, hmi::Client& client) {
    const auto order = order_of(client, options);
    if (!order) return report(options.remote, order.error());
    auto question = *order;
    question["cmd"] = "measure_plan";
    const auto plan = client.request(question);
    if (!plan) return report(options.remote, plan.error());
    if (options.only_plan && options.remote.json) fmt::print("{}\n", plan->at("measure_plan").dump());
    if (!options.remote.json) fmt::print("{}: {}\n", options.axis, plan_text(plan->at("measure_plan")));
    if (options.only_plan) return exit_ok;
    std::fflush(stdout);

    watch_stop_signals();
    auto request = *order;
    request["cmd"] = "measure";
    request["press"] = true;
    if (const auto pressed = client.request(request); !pressed) return report(options.remote, pressed.error());
    const bool show = !options.remote.json && ::isatty(STDOUT_FILENO) != 0;
    for (bool over = false; !over && !stop_requested();) {
        std::this_thread::sleep_for(measure_renewal);
        const auto now = result_of(client, options);
        if (!now) return report(options.remote, now.error());
        over = !now->at("running").get<bool>();
        if (over) break;
        if (show)
            fmt::print("\r{:5.1f} of {:.1f} s   Ctrl-C lets go ", hmi::number_of(now->at("elapsed_s")),
                       hmi::number_of(now->at("plan").at("duration_s")));
        if (show) std::fflush(stdout);
        // One that has just ended is told by the next look.
        (void)client.request({{"cmd", "measure"}, {"axis", options.axis}});
    }
    if (show) fmt::print("\r{:40}\r", "");
    if (stop_requested())
        if (const auto stopped = client.request({{"cmd", "stop"}, {"axis", options.axis}}); !stopped)
            return report(options.remote, stopped.error());
    auto result = result_of(client, options);
    for (int i = 0; result && result->at("running").get<bool>() && i < 20; ++i) {
        std::this_thread::sleep_for(measure_renewal);
        result = result_of(client, options);
    }
    if (!result) return report(options.remote, result.error());
    if (options.remote.json) fmt::print("{}\n", result->dump());
    else fmt::print("{}", result_text(*result));
    if (!options.csv.empty())
        if (const auto written = write_curves(*result, options.csv); !written) return report(options.remote, written.error());
    return result->at("end") == "done" ? exit_ok : exit_refused;
}

}  // namespace

void add_measure(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("measure", "measure an axis while this command lives, in manual or set-up mode");
    auto options = std::make_shared<MeasureOptions>();
    add_remote_options(*sub, options->remote);
    sub->add_option("AXIS", options->axis, "axis")->required();
    sub->add_option("KIND", options->kind, "step, ramp, friction, sweep, following or cogging")
        ->required()
        ->check(CLI::IsMember({"step", "ramp", "friction", "sweep", "following", "cogging"}));
    sub->add_option("--distance", options->distance, "signed, from where it stands: 10mm; sweep: the most amplitude");
    sub->add_option("--velocity", options->velocity, "the highest: 20mm/s; default: the slow jogging speed");
    sub->add_option("--acceleration", options->acceleration, "the highest; default: half the limit");
    sub->add_option("--count", options->count, "times to and fro; friction, following: velocities; sweep: frequencies")
        ->check(CLI::PositiveNumber);
    sub->add_option("--from-hz", options->from_hz, "sweep: the lowest frequency")->check(CLI::PositiveNumber);
    sub->add_option("--to-hz", options->to_hz, "sweep: the highest")->check(CLI::PositiveNumber);
    sub->add_option("--period", options->period, "cogging: after which way it repeats; default: a turn of the motor");
    sub->add_option("--window", options->window, "step: settled inside it, 0.02mm; default: the axis' in-position window");
    sub->add_flag("--plan", options->only_plan, "only say where it would go");
    sub->add_option("--csv", options->csv, "file for the curves");
    sub->callback([&action, options] {
        action = [options] { return with_machine(options->remote, [&](hmi::Client& client) { return measure(*options, client); }); };
    });
}

}  // namespace taktwerk::apps
