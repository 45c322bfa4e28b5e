// taktwerk enable | disable | home | reset | stop | start | mode | set | output | force | override | ack | shutdown | control: one command to a running
// machine, one answer. Jogging is in jog.cpp.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "apps/machine/group.hpp"
#include "apps/machine/held_velocity.hpp"
#include "apps/machine/jog.hpp"
#include "apps/machine/override_part.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "config/reading/unit_text.hpp"
#include "core/clock.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

/// One sub-command on its way: what was given, and what it needs.
struct Order {
    RemoteOptions remote;
    std::string target, program;
    std::string mode;
    std::string value, velocity;  // as written, with a unit or without
    double hold_s = 0;
    bool wait = false;
    double patience_s = 0;  ///< 0: not given
};

using Body = int (*)(const Order&, hmi::Client&);

int send(const Order& order, hmi::Client& client, const nlohmann::json& request, const std::string& done) {
    const auto answer = client.request(request);
    if (!answer) return report(order.remote, answer.error());
    const auto note = answer->value("note", std::string{});
    return report(order.remote, note.empty() ? done : done + ", " + note);
}

constexpr double ordinary_patience_s = 30;

/// Until `reached` holds for every axis asked for; an axis that has `failed` on the way ends it, and one for which `given_up` holds.
/// `given_up`: the axis itself decides how long it takes; then only a --timeout ends it earlier.
int wait_for(const Order& order, hmi::Client& client, bool (*reached)(const Json&), const std::string& done, bool (*failed)(const Json&),
             bool (*given_up)(const Json&) = nullptr) {
    SystemClock clock;
    const double patience = order.patience_s > 0 ? order.patience_s : ordinary_patience_s;
    const auto end = order.patience_s > 0 || !given_up ? clock.now() + from_seconds(patience) : Instant::max();
    watch_stop_signals();
    while (!stop_requested()) {
        const auto state = state_of(client);
        if (!state) return report(order.remote, state.error());
        bool all = true;
        for (const auto& axis : state->at("axes")) {
            const auto name = axis.at("name").get<std::string>();
            if ((order.target != "all" && !order.target.empty() && name != order.target) || axis.at("disabled").get<bool>()) continue;
            if (failed && failed(axis)) {
                for (const auto& alarm : state->at("alarms"))
                    if (alarm.at("source") == "axis " + name)
                        return report(order.remote, Error{"axis.error_stop", "axis " + name, alarm.at("english").get<std::string>(),
                                                          alarm.at("remedy").get<std::string>()});
                return report(order.remote,
                              Error{"axis.error_stop", "axis " + name, "the axis is in ErrorStop", "See `taktwerk monitor`; then reset."});
            }
            if (given_up && given_up(axis))
                return report(order.remote,
                              Error{"axis.ended", "axis " + name, "the command was ended before it was done",
                                    "Another command, or power that went, took it; see `taktwerk monitor`, then give it again."});
            all = all && reached(axis);
        }
        if (all) return report(order.remote, done);
        if (clock.now() >= end) break;
        std::this_thread::sleep_for(50ms);
    }
    return report(order.remote, Error{"axis.not_in_time", order.target.empty() ? "axes" : "axis " + order.target,
                                      fmt::format("not finished within {:g} s", patience), "See `taktwerk monitor` what it waits for."});
}

bool in_error(const Json& axis) { return axis.at("state") == "ErrorStop"; }
/// It has been tried: the cause is still there, or no reset clears it.
bool reset_in_vain(const Json& axis) { return in_error(axis) && !axis.at("resetting").get<bool>(); }
/// One that still stops has its power yet: it may be about to lose it (switched off before, another mode), and takes no motion.
bool is_powered(const Json& axis) { return axis.at("powered").get<bool>() && axis.at("state") != "Stopping"; }
bool is_off(const Json& axis) { return axis.at("state") == "Disabled"; }
bool is_homed(const Json& axis) { return axis.at("homed").get<bool>() && axis.at("state") != "Homing" && !axis.at("has_job").get<bool>(); }
bool gave_up_homing(const Json& axis) {
    return !axis.at("homed").get<bool>() && axis.at("state") != "Homing" && !axis.at("has_job").get<bool>();
}
bool is_reset(const Json& axis) { return axis.at("state") != "ErrorStop" && !axis.at("resetting").get<bool>(); }

int enable(const Order& order, hmi::Client& client) {
    if (const auto answer = client.request({{"cmd", "enable"}, {"axis", order.target}}); !answer)
        return report(order.remote, answer.error());
    if (order.wait) return wait_for(order, client, is_powered, order.target + ": enabled", in_error);
    return report(order.remote, order.target + ": enabling");
}

int disable(const Order& order, hmi::Client& client) {
    if (const auto answer = client.request({{"cmd", "disable"}, {"axis", order.target}}); !answer)
        return report(order.remote, answer.error());
    if (order.wait) return wait_for(order, client, is_off, order.target + ": disabled", nullptr);
    return report(order.remote, order.target + ": stops, then power goes off");
}

int home(const Order& order, hmi::Client& client) {
    std::vector<std::string> axes{order.target};
    if (order.target == "all") {
        const auto layout = layout_of(client);
        if (!layout) return report(order.remote, layout.error());
        axes.clear();
        for (const auto& axis : layout->at("axes"))
            if (!axis.at("disabled").get<bool>()) axes.push_back(axis.at("name").get<std::string>());
    }
    for (const auto& axis : axes)
        if (const auto answer = client.request({{"cmd", "home"}, {"axis", axis}}); !answer) return report(order.remote, answer.error());
    if (!order.wait) return report(order.remote, order.target + ": homing");
    // The snapshot that still shows the axis as it was before must not count.
    std::this_thread::sleep_for(100ms);
    // How long it may take says homing.timeout in the machine file: the axis ends it by itself.
    return wait_for(order, client, is_homed, order.target + ": homed", in_error, gave_up_homing);
}

int reset(const Order& order, hmi::Client& client) {
    if (!order.program.empty())
        return send(order, client, {{"cmd", "program_reset"}, {"program", order.program}}, "program " + order.program + ": reset");
    const auto target = order.target.empty() ? std::string("all") : order.target;
    if (const auto answer = client.request({{"cmd", "reset"}, {"axis", target}}); !answer) return report(order.remote, answer.error());
    if (!order.wait) return report(order.remote, target + ": resetting");
    std::this_thread::sleep_for(100ms);
    return wait_for(order, client, is_reset, target + ": reset", reset_in_vain);
}

int stop(const Order& order, hmi::Client& client) {
    if (!order.program.empty())
        return send(order, client, {{"cmd", "program_stop"}, {"program", order.program}},
                    "program " + order.program + ": stopped, its axes ramp down");
    const auto target = order.target.empty() ? std::string("all") : order.target;
    return send(order, client, {{"cmd", "stop"}, {"axis", target}}, target + ": stops along the ramp");
}

int start(const Order& order, hmi::Client& client) {
    std::vector<std::string> programs{order.target};
    if (order.target.empty()) {
        const auto layout = layout_of(client);
        if (!layout) return report(order.remote, layout.error());
        programs = layout->at("programs").get<std::vector<std::string>>();
        if (programs.empty())
            return report(order.remote, Error{"command.not_possible_now", "", "this machine has no program",
                                              "Move its axes with `taktwerk jog`, or add a program to the machine file."});
    }
    std::vector<std::string> running, waiting;
    if (const auto state = state_of(client)) {
        for (const auto& program : state->at("programs"))
            if (program.at("state") == "running") running.push_back(program.at("name").get<std::string>());
        for (const auto& alarm : state->at("alarms"))
            if (alarm.value("name", "") == "program_waits") waiting.push_back(alarm.value("source", ""));
    }
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::string told;
    for (const auto& program : programs) {
        if (const auto answer = client.request({{"cmd", "program_start"}, {"program", program}}); !answer)
            return report(order.remote, answer.error());
        // What it does there is no small thing: its axes get their power back.
        const char* what = has(waiting, "program " + program) ? "goes on after the emergency stop"
                           : has(running, program)            ? "runs already"
                                                              : "started";
        told += fmt::format("{}program {}: {}", told.empty() ? "" : "; ", program, what);
    }
    return report(order.remote, told);
}

int mode(const Order& order, hmi::Client& client) {
    return send(order, client, {{"cmd", "mode"}, {"mode", order.mode}}, "mode: " + order.mode);
}
int set(const Order& order, hmi::Client& client) {
    const auto value = parameter_value(client, order.target, order.value);
    if (!value) return report(order.remote, value.error());
    const auto done = fmt::format("{} = {:g}", order.target, *value);
    if (is_switch(client, order.target))
        return send(order, client, {{"cmd", "set_value"}, {"variable", order.target}, {"value", *value}}, done);
    return send(order, client, {{"cmd", "set_parameter"}, {"parameter", order.target}, {"value", *value}}, done);
}
/// What ends with its client: so this one stays.
int hold(const Order& order, hmi::Client& client, const std::string& what, const std::string& done) {
    watch_stop_signals();
    SystemClock clock;
    const auto start = clock.now();
    if (order.hold_s <= 0 && !order.remote.json) fmt::print("{} until Ctrl-C\n", what);
    std::fflush(stdout);
    while (!stop_requested() && (order.hold_s <= 0 || clock.now() - start < from_seconds(order.hold_s))) {
        if (const auto alive = client.request({{"cmd", "hello"}}); !alive) return report(order.remote, alive.error());
        std::this_thread::sleep_for(50ms);
    }
    return report(order.remote, done);
}
/// A point's value as written, in its unit; and that as people read it.
struct PointText {
    double value = 0;
    std::string text;
};
Result<PointText> point_value(const Order& order, hmi::Client& client, const char* units) {
    const auto state = state_of(client);
    const auto unit = state ? state->value(units, nlohmann::ordered_json::object()).value(order.target, "") : std::string{};
    const auto value = config::value_in(order.value, unit);
    if (!value) return value.error();
    return PointText{*value, fmt::format("{:g}{}{}", *value, unit.empty() ? "" : " ", unit)};
}
int output(const Order& order, hmi::Client& client) {
    const auto value = point_value(order, client, "output_units");
    if (!value) return report(order.remote, value.error());
    const auto answer = client.request({{"cmd", "set_output"}, {"output", order.target}, {"value", value->value}});
    if (!answer) return report(order.remote, answer.error());
    return hold(order, client, fmt::format("output {} = {}", order.target, value->text),
                fmt::format("output {} goes back to its safe value", order.target));
}
/// An input, or an output where no input has that name.
Result<std::string> direction_of(const Order& order, hmi::Client& client) {
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    for (const auto* key : {"inputs", "outputs"})
        for (const auto& name : layout->at(key))
            if (name == order.target && (order.mode.empty() || order.mode + "s" == key))
                return std::string(key).substr(0, std::strlen(key) - 1);
    return order.mode.empty() ? std::string("input") : order.mode;  // the machine says which names there are
}
int force(const Order& order, hmi::Client& client) {
    const auto direction = direction_of(order, client);
    if (!direction) return report(order.remote, direction.error());
    const auto value = point_value(order, client, *direction == "input" ? "input_units" : "output_units");
    if (!value) return report(order.remote, value.error());
    const auto answer = client.request({{"cmd", "force"}, {*direction, order.target}, {"value", value->value}});
    if (!answer) return report(order.remote, answer.error());
    return hold(order, client, fmt::format("{} {} is forced to {}", *direction, order.target, value->text),
                fmt::format("{} {} is its own again", *direction, order.target));
}
int unforce(const Order& order, hmi::Client& client) {
    if (order.target.empty()) return send(order, client, {{"cmd", "release_forces"}}, "no point is forced any more");
    const auto direction = direction_of(order, client);
    if (!direction) return report(order.remote, direction.error());
    return send(order, client, {{"cmd", "unforce"}, {*direction, order.target}},
                fmt::format("{} {} is its own again", *direction, order.target));
}
int set_override(const Order& order, hmi::Client& client) {
    const auto part = override_part(order.value);
    if (!part) return report(order.remote, part.error());
    const auto axis = order.target.empty() ? std::string("all") : order.target;
    return send(order, client, {{"cmd", "override"}, {"axis", axis}, {"value", *part}},
                fmt::format("override of {}: {:g} %", axis, 100 * *part));
}
int acknowledge(const Order& order, hmi::Client& client) { return send(order, client, {{"cmd", "acknowledge"}}, "alarms acknowledged"); }
int shut_down(const Order& order, hmi::Client& client) {
    return send(order, client, {{"cmd", "shutdown"}}, "the axes stop, then power goes off and the runtime ends");
}
int take_control(const Order& order, hmi::Client& client) {
    return send(order, client, {{"cmd", "take_control"}, {"axis", order.target}}, order.target + ": control taken");
}
int release_control(const Order& order, hmi::Client& client) {
    return send(order, client, {{"cmd", "release_control"}, {"axis", order.target}}, order.target + ": control released");
}
int move(const Order& order, hmi::Client& client) {
    const auto position = position_on(client, order.target, order.value), velocity = velocity_on(client, order.target, order.velocity);
    if (!position) return report(order.remote, position.error());
    if (!velocity) return report(order.remote, velocity.error());
    const auto answer = client.request({{"cmd", "move"}, {"axis", order.target}, {"position", *position}, {"velocity", *velocity}});
    if (!answer) return report(order.remote, answer.error());
    auto said = fmt::format("{}: moving to {:g}", order.target, *position);
    if (const auto note = answer->value("note", std::string{}); !note.empty()) return report(order.remote, said + ", " + note);
    std::this_thread::sleep_for(100ms);  // the snapshot in which it moves
    if (const auto state = state_of(client))
        for (const auto& axis : state->at("axes"))
            if (axis.at("name") == order.target) said += held_velocity(axis, state->at("mode").get<std::string>());
    return report(order.remote, said);
}

int carry_out(const Order& order, Body body) {
    return with_machine(order.remote, [&](hmi::Client& client) { return body(order, client); });
}

struct Adder {
    CLI::App& app;
    Action& action;
    std::shared_ptr<Order> order;

    CLI::App& add(const char* word, const char* doc, Body body) {
        order = std::make_shared<Order>();
        auto* sub = app.add_subcommand(word, doc);
        add_remote_options(*sub, order->remote);
        sub->callback([&action = action, order = order, body] { action = [order, body] { return carry_out(*order, body); }; });
        return *sub;
    }
    void add_wait(CLI::App& sub) {
        sub.add_flag("--wait", order->wait, "until it is done, or the axis is in error");
        add_duration(sub, "--timeout", order->patience_s, "longest wait, default 30s; for home as long as the axis takes (homing.timeout)");
    }
};

}  // namespace

void add_operate(CLI::App& app, Action& action) {
    add_jog(app, action);
    add_group(app, action);

    Adder adder{app, action, nullptr};
    const auto axis_command = [&](const char* word, const char* doc, Body body, const char* target, bool required,
                                  bool waits) -> CLI::App& {
        auto& sub = adder.add(word, doc, body);
        sub.add_option("AXIS", adder.order->target, target)->required(required);
        if (waits) adder.add_wait(sub);
        return sub;
    };
    axis_command("enable", "power on", enable, "axis, or all", true, true);
    axis_command("disable", "stop, then power off", disable, "axis, or all", true, true);
    axis_command("home", "find the zero position", home, "axis, or all", true, true);
    axis_command("reset", "leave ErrorStop; without an axis: all, and the machine's alarms", reset, "axis; default all", false, true)
        .add_option("--program", adder.order->program, "instead: a program after a fault");
    axis_command("stop", "stop along the ramp; always allowed", stop, "axis; default all", false, false)
        .add_option("--program", adder.order->program, "instead: end this program, its axes ramp down");

    auto& move_sub = axis_command("move", "move to a position, in manual mode", move, "axis", true, false);
    move_sub.add_option("POSITION", adder.order->value, "e.g. 120mm; a bare number is in the axis' unit")->required();
    move_sub.add_option("--velocity", adder.order->velocity, "e.g. 20mm/s or 1.2m/min, above 0; a bare number is in the axis' unit/s")
        ->required();

    adder.add("start", "start a program, in automatic mode", start)
        .add_option("PROGRAM", adder.order->target, "default: all of the machine");
    adder.add("mode", "mode of the machine", mode)
        .add_option("MODE", adder.order->mode, "manual, setup or automatic")
        ->required()
        ->check(CLI::IsMember({"manual", "setup", "automatic"}));
    auto& set_sub = adder.add("set", "write a parameter or a switch of a program", set);
    set_sub.add_option("NAME", adder.order->target, "of a parameter or of a variable that the program lets people write, or PROGRAM.NAME")
        ->required();
    set_sub.add_option("VALUE", adder.order->value, "within its range, e.g. 50mm; a bare number is in its unit")->required();
    auto& output_sub = adder.add("output", "set an output point while this command lives; only while no program runs", output);
    add_duration(output_sub, "--for", adder.order->hold_s, "let go after this time; default: at Ctrl-C");
    output_sub.add_option("NAME", adder.order->target, "output point")->required();
    output_sub.add_option("VALUE", adder.order->value, "0 or 1; a number for wider points")->required();
    auto& force_sub =
        adder.add("force", "put a value in place of an input's or an output's while this command lives, whatever programs do", force);
    add_duration(force_sub, "--for", adder.order->hold_s, "let go after this time; default: at Ctrl-C");
    force_sub.add_option("POINT", adder.order->target, "input or output point")->required();
    force_sub.add_option("VALUE", adder.order->value, "0 or 1; a number for wider points")->required();
    const auto which = [&](CLI::App& sub) {
        sub.add_option("--direction", adder.order->mode, "where an input and an output have that name")
            ->check(CLI::IsMember({"input", "output"}));
    };
    which(force_sub);
    auto& unforce_sub = adder.add("unforce", "let a point be its own again, whoever forced it", unforce);
    unforce_sub.add_option("POINT", adder.order->target, "input or output point; default: all");
    which(unforce_sub);
    auto& override_sub = adder.add("override", "the operator's factor on commanded velocities: stays until it is changed", set_override);
    override_sub.add_option("PERCENT", adder.order->value, "0 (halt) to 100 (as commanded)")->required();
    override_sub.add_option("AXIS", adder.order->target, "axis; default all");
    adder.add("ack", "acknowledge all alarms", acknowledge);
    adder.add("shutdown", "stop the axes, power off, end the runtime", shut_down);

    auto* control = app.add_subcommand("control", "who commands an axis");
    control->require_subcommand(1);
    Adder inner{*control, action, nullptr};
    inner.add("take", "become the owner; an axis that moves for another stops first", take_control)
        .add_option("AXIS", inner.order->target, "axis, or all")
        ->required();
    inner.add("release", "give the axis back", release_control).add_option("AXIS", inner.order->target, "axis, or all")->required();
}

}  // namespace taktwerk::apps
