// taktwerk jog AXIS --velocity V, jog GROUP DIRECTION... --velocity PART: the axis or the group moves while this command lives. It presses once and renews each 50 ms; when it ends or
// dies, the axis stops (by letting go, or by its lease in the runtime).

#include "apps/machine/jog.hpp"

#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/machine/held_velocity.hpp"
#include "apps/machine/jog_group.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "core/clock.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

constexpr auto renewal = 50ms;
constexpr auto settling = 5s;  ///< longest ramp we wait for after letting go

struct JogOptions {
    RemoteOptions remote;
    std::string axis, speed;
    double for_s = 0;
    GroupJogOptions group;
};

/// The axis' own object of the state; empty when something went wrong.
nlohmann::ordered_json axis_of(const nlohmann::ordered_json& state, const std::string& name) {
    for (const auto& axis : state.at("axes"))
        if (axis.at("name") == name) return axis;
    return {};
}

/// A group is named, and no way to go.
Result<bool> is_a_group(const JogOptions& options, hmi::Client& client) {
    if (!options.group.directions.empty()) return true;
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    const auto names = [&](const char* what) {
        for (const auto& one : layout->at(what))
            if (one.at("name") == options.axis) return true;
        return false;
    };
    if (names("groups") && !names("axes"))
        return Error{
            "usage.direction", options.axis, "it is a group of axes, and no direction says where it is to go",
            fmt::format("Give one or more: `taktwerk jog {} x+ --velocity 20%`, `taktwerk jog {} AXIS+ --frame acs --velocity 20%`.",
                        options.axis, options.axis)};
    if (options.group.frame != "mcs" || !options.group.distance.empty())
        return Error{"usage.frame", options.axis, "--frame and --distance are of a group, and an axis has one direction alone",
                     "Leave them out, or name a group and a direction."};
    return false;
}

int jog(const JogOptions& options, hmi::Client& client) {
    const auto of_a_group = is_a_group(options, client);
    if (!of_a_group) return report(options.remote, of_a_group.error());
    if (*of_a_group) {
        auto group = options.group;
        group.group = options.axis;
        group.speed = options.speed;
        group.for_s = options.for_s;
        return jog_group(options.remote, group, client);
    }

    const auto velocity = velocity_on(client, options.axis, options.speed);
    if (!velocity) return report(options.remote, velocity.error());
    watch_stop_signals();
    SystemClock clock;
    const auto start = clock.now();
    const bool show = !options.remote.json && ::isatty(STDOUT_FILENO) != 0;
    std::string held;  // what kept it slower than asked
    int renewals = 0;

    for (bool press = true; !stop_requested(); press = false) {
        nlohmann::json request{{"cmd", "jog"}, {"axis", options.axis}, {"velocity", *velocity}};
        if (press) request["press"] = true;
        const auto answer = client.request(request);
        if (!answer) return report(options.remote, answer.error());
        if (const auto note = answer->value("note", std::string{}); press && !note.empty() && !options.remote.json)
            fmt::print("{}: {}\n", options.axis, note);
        constexpr int looked_at = 4;  // by then it is as fast as it may be, or on its way there
        if (show || ++renewals == looked_at) {
            if (const auto state = state_of(client)) {
                const auto axis = axis_of(*state, options.axis);
                if (axis.is_object()) held = held_velocity(axis, state->at("mode").get<std::string>());
                if (show && axis.is_object())
                    fmt::print("\r{} {:12.3f} {}  {:10.3f} {}/s   Ctrl-C stops ", options.axis, hmi::number_of(axis.at("actual_position")),
                               axis.at("unit").get<std::string>(), hmi::number_of(axis.at("actual_velocity")),
                               axis.at("unit").get<std::string>());
                if (show) std::fflush(stdout);
            }
        }
        if (options.for_s > 0 && clock.now() - start >= from_seconds(options.for_s)) break;
        std::this_thread::sleep_for(renewal);
    }
    if (show) fmt::print("\n");
    const auto released = client.request({{"cmd", "jog"}, {"axis", options.axis}, {"velocity", 0}});
    if (!released) return report(options.remote, released.error());

    // Where it came to rest is what one wants to know.
    for (const auto end = clock.now() + settling; clock.now() < end;) {
        const auto state = state_of(client);
        if (!state) return report(options.remote, state.error());
        const auto axis = axis_of(*state, options.axis);
        if (!axis.is_object()) break;
        if (!axis.at("has_job").get<bool>() && hmi::number_of(axis.at("set_velocity")) == 0)
            return report(options.remote, fmt::format("{}: stands at {:.3f} {}{}", options.axis, hmi::number_of(axis.at("actual_position")),
                                                      axis.at("unit").get<std::string>(), held));
        std::this_thread::sleep_for(20ms);
    }
    return report(options.remote, options.axis + ": let go");
}

}  // namespace

void add_jog(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("jog", "move an axis or a group while this command lives, in manual or set-up mode");
    auto options = std::make_shared<JogOptions>();
    add_remote_options(*sub, options->remote);
    sub->add_option("AXIS", options->axis, "axis, or group of axes with a direction behind it")->required();
    sub->add_option("DIRECTION", options->group.directions,
                    "of a group, one or more: x+ y- z+ rx+ ry+ rz+; with --frame acs the names of its axes: shoulder+");
    sub->add_option(
           "--velocity", options->speed,
           "of an axis, signed: 20mm/s, 1.2m/min; a bare number is in the axis' unit/s. Of a group: the part of its jogging velocity, 20%")
        ->required();
    sub->add_option(
        "--frame", options->group.frame,
        "of a group: mcs (the machine), acs (each axis), tcs (the tool), wcs (the world), pcs, pcs_2 to pcs_8 (a product); default mcs");
    sub->add_option("--distance", options->group.distance, "of a group: stop exactly behind it: 10mm, 5deg");
    add_duration(*sub, "--for", options->for_s, "let go after this time; default: at Ctrl-C");
    sub->callback([&action, options] {
        action = [options] { return with_machine(options->remote, [&](hmi::Client& client) { return jog(*options, client); }); };
    });
}

}  // namespace taktwerk::apps
