#include "tests/whole_machine/recovery.hpp"

#include <cmath>

namespace taktwerk::whole {

namespace {

using axes::AxisState;

/// That a person can move now.
bool is_moved_by_hand(const Rig& rig, std::size_t i) {
    const auto& binding = rig.m.machine->config().axes[i];
    return !binding.encoder || binding.analog;
}

bool all_reset(Rig& rig) {
    if (!rig.in_operation() || rig.any_in_error()) return false;
    const auto& snapshot = rig.m.state();
    for (std::size_t i = 0; i < snapshot.axes.size(); ++i)
        if (!snapshot.axes[i].online && is_moved_by_hand(rig, i)) return false;
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i)
        if (snapshot.alarms[i].reaction >= Reaction::stop_axis) return false;
    return true;
}

std::string states(Rig& rig) {
    std::string out;
    const auto& layout = rig.m.machine->layout();
    for (std::size_t i = 0; i < layout.axes.size(); ++i) {
        const auto& view = rig.m.axis(i);
        out += fmt::format("{} is in {} (error {:x}, drive {} {:x}, online {}); ", layout.axes[i].name, axes::name(view.state), view.error,
                           axes::name(view.drive_state), view.drive_error, view.online);
    }
    return out;
}

/// The sense in which there is room: by its mechanics, which an axis that is not homed does not know.
double away_from_ends(Rig& rig, std::size_t i) {
    const auto& binding = rig.m.machine->config().axes[i];
    const auto& simulation = binding.simulation;
    const auto& view = rig.m.axis(i);
    const double sense = binding.axis.gearing.inverted ? -1 : 1;
    if (view.negative_limit_switch != view.positive_limit_switch) return view.negative_limit_switch ? 1 : -1;
    if (auto* drive = rig.m.world.drive(binding.axis.name); drive != nullptr && simulation.negative_stop && simulation.positive_stop) {
        const double place = drive->plant().position() / binding.axis.gearing.counts_per_unit();
        return sense * place < (*simulation.negative_stop + *simulation.positive_stop) / 2 ? 1 : -1;
    }
    const auto& info = rig.m.machine->layout().axes[i];
    const bool ends = std::isfinite(info.position_min) && std::isfinite(info.position_max);
    return view.actual_position < (ends ? (info.position_min + info.position_max) / 2 : 0) ? 1 : -1;
}

/// A drive is not switched on while its motor turns. What runs out stands in the end; what is pulled (a reel by its web) is held by hand, until its drive
/// holds it.
void hold_what_turns(Rig& rig, bool held) {
    const auto& layout = rig.m.machine->layout();
    for (std::size_t i = 0; i < layout.axes.size(); ++i)
        if (auto* drive = rig.m.world.drive(layout.axes[i].name); drive != nullptr && is_moved_by_hand(rig, i))
            if (!held || std::abs(rig.m.axis(i).actual_velocity) > 0.01 * layout.axes[i].velocity_limit) drive->jam(held);
    if (held) rig.run(200ms);
}

bool all_powered(Rig& rig) {
    for (std::size_t i = 0; i < rig.m.machine->layout().axes.size(); ++i)
        if (is_moved_by_hand(rig, i) && !(rig.m.axis(i).powered && rig.m.axis(i).state == AxisState::Standstill)) return false;
    return true;
}

/// To a drive that has its limit switch as a fault (SV-DA200 Er21), who comes to stand on the edge of one falls when it gets power: it is inside then.
bool fell_at_its_switch(Rig& rig) {
    for (std::size_t i = 0; i < rig.m.machine->layout().axes.size(); ++i) {
        const auto& view = rig.m.axis(i);
        if (view.drive_state == axes::PowerState::fault && (view.negative_limit_switch || view.positive_limit_switch)) return true;
    }
    return false;
}

bool switched_on(Rig& rig) {
    using enum runtime::OperatorAction;
    (void)rig.submit(override_velocity, 0xFFFF, false, 1);  // somebody may have turned it down to nothing
    for (std::uint16_t i = 0; i < rig.m.machine->layout().axes.size(); ++i)
        if (is_moved_by_hand(rig, i)) (void)rig.submit(power, i, true);
    // What a program held goes off and comes back: the wish is the operator's from here on.
    int in_a_row = 0;
    const auto settled = [&] { return (in_a_row = all_powered(rig) ? in_a_row + 1 : 0) > 500; };
    return rig.until(settled, 8s);
}

bool move_by_hand(Rig& rig) {
    using enum runtime::OperatorAction;
    const auto& layout = rig.m.machine->layout();
    for (std::uint16_t i = 0; i < layout.axes.size(); ++i) {
        if (!is_moved_by_hand(rig, i)) continue;
        const auto& info = layout.axes[i];
        const auto& view = rig.m.axis(i);
        const double way = away_from_ends(rig, i);
        const double before = view.actual_position;
        (void)rig.submit(jog, i, true, way * info.jog_slow);
        for (int beat = 0; beat < 8; ++beat) {
            rig.run(50ms);
            (void)rig.submit(jog, i, false, way * info.jog_slow);
        }
        const double after = rig.m.axis(i).actual_position, modulo = rig.m.axis(i).modulo;
        (void)rig.submit(jog, i, false, 0);
        const double moved = modulo > 0 ? (after - before) - modulo * std::round((after - before) / modulo) : after - before;
        if (way * moved <= 0)
            rig.problem(
                fmt::format("{} does not move by hand: from {} to {}; {}{}", info.name, before, after, states(rig), rig.standing()));
    }
    if (!rig.until([&] { return all_powered(rig); }, 5s)) rig.problem("not every axis stands: " + states(rig) + rig.standing());
    return rig.problems.empty();
}

bool reset(Rig& rig, Hands& hands) {
    const auto end = rig.now() + 60s;
    while (!all_reset(rig) && rig.now() < end && !rig.over()) {
        hands.reset_all();
        rig.run(700ms);
    }
    if (!all_reset(rig)) rig.problem("a reset does not bring it back: " + states(rig) + rig.standing());
    return all_reset(rig);
}

}  // namespace

void begin_work(Rig& rig) {
    std::vector<std::string> buttons;
    for (const auto& input : rig.m.machine->layout().inputs)
        if (input.find("start") != std::string::npos) buttons.push_back(input);
    if (buttons.empty()) return;
    rig.run(1200ms);  // power comes first
    for (const auto& button : buttons) rig.m.world.set_input(button, true);
    rig.run(100ms);
    for (const auto& button : buttons) rig.m.world.set_input(button, false);
}

bool recover(Rig& rig, Hands& hands) {
    rig.mode(runtime::Mode::manual);
    (void)rig.submit(runtime::OperatorAction::stop);  // it may have been manual before, with a move of somebody's under way
    // What stopped stands, and nothing begins by itself.
    const auto stands = [&] {
        const auto& axes = rig.m.state().axes;
        return std::all_of(axes.begin(), axes.end(),
                           [](const auto& axis) { return axis.set_velocity == 0 || axis.state == AxisState::Disabled; });
    };
    if (!rig.until(stands, 15s)) rig.problem("in manual mode something moves on: " + states(rig));
    if (!reset(rig, hands)) return false;
    hold_what_turns(rig, true);
    if (!switched_on(rig) && !(fell_at_its_switch(rig) && reset(rig, hands) && switched_on(rig))) {
        rig.problem("not every axis gets power: " + states(rig) + rig.standing());
        return false;
    }
    hold_what_turns(rig, false);
    if (!move_by_hand(rig)) return false;
    // What is left says nothing any more once it is acknowledged.
    // A cable that lost its link is told for a minute, and nobody can take that back (where the host slept meanwhile it has seen no more of it).
    constexpr int half_seconds = 20, of_a_minute = 130;
    const auto lasts = [&](int i) {
        const auto left = rig.standing();
        return !left.empty() && i < (left.find("cable_loses_link") == std::string::npos ? half_seconds : of_a_minute);
    };
    for (int i = 0; lasts(i); ++i) {
        (void)rig.submit(runtime::OperatorAction::acknowledge_alarms);
        (void)rig.submit(runtime::OperatorAction::reset);
        rig.run(500ms);
    }
    if (const auto left = rig.standing(); !left.empty()) rig.problem("alarms stay: " + left);
    return rig.problems.empty();
}

bool end_in_order(Rig& rig) {
    const auto longest = rig.m.machine->longest_stop();
    (void)rig.begins(Deed::end);
    rig.m.machine->request_shutdown();
    if (!rig.m.runner->run_until([&] { return rig.m.machine->phase() == runtime::MachinePhase::stopped; }, longest + 1s)) {
        rig.problem(fmt::format("it does not stop within {} ms", longest / 1ms));
        return false;
    }
    return bus_down(rig);
}

bool bus_down(Rig& rig) {
    rig.m.machine->stop_bus();
    if (!rig.m.runner->run_until([&] { return rig.m.machine->bus().phase() == ecat::Master::Phase::stopped; }, 30s))
        rig.problem("the bus does not go down: " + rig.m.machine->bus_progress());
    return rig.problems.empty();
}

}  // namespace taktwerk::whole
