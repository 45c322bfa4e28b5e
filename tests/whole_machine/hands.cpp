#include "tests/whole_machine/hands.hpp"

#include <cmath>

namespace taktwerk::whole {

using enum runtime::OperatorAction;

void Hands::do_anything() {
    const auto& layout = rig_.m.machine->layout();
    const auto axis = static_cast<std::uint16_t>(below(layout.axes.size()));
    const auto program = static_cast<std::uint16_t>(below(std::max<std::size_t>(layout.programs.size(), 1)));
    switch (below(20)) {
        case 0:
        case 1: (void)rig_.submit(power, below(3) == 0 ? 0xFFFF : axis, true); break;
        case 2: (void)rig_.submit(power, axis, false); break;
        case 3: (void)rig_.submit(home, axis); break;
        case 4:
        case 5:
        case 6: (void)rig_.submit(jog, axis, below(3) == 0, between(-1, 1) * layout.axes[axis].jog_fast); break;
        case 7:
        case 8: move(axis); break;
        case 9: (void)rig_.submit(stop, below(2) == 0 ? 0xFFFF : axis); break;
        case 10: (void)rig_.submit(reset, below(2) == 0 ? 0xFFFF : axis); break;
        case 11: (void)rig_.submit(acknowledge_alarms); break;
        case 12: (void)rig_.submit(program_start, program); break;
        case 13: (void)rig_.submit(program_stop, program); break;
        case 14: (void)rig_.submit(program_reset, program); break;
        case 15: (void)rig_.submit(override_velocity, below(2) == 0 ? 0xFFFF : axis, false, below(4) == 0 ? 1 : between(0, 1.2)); break;
        case 16: (void)rig_.submit(below(2) == 0 ? reset_peaks : reset_statistics, axis); break;
        case 17: rig_.mode(static_cast<runtime::Mode>(below(3))); break;
        default: set_something();
    }
}

void Hands::move(std::uint16_t axis) {
    const auto& info = rig_.m.machine->layout().axes[axis];
    const double low = std::isfinite(info.position_min) ? info.position_min - 5 : -100;
    const double high = std::isfinite(info.position_max) ? info.position_max + 5 : 100;
    (void)rig_.submit(move_absolute, axis, false, between(low, high), between(0.01, 1.1) * info.velocity_limit);
}

void Hands::set_something() {
    const auto& layout = rig_.m.machine->layout();
    switch (below(4)) {
        case 0:
            if (!layout.parameters.empty()) {
                const auto which = below(layout.parameters.size());
                const auto& info = layout.parameters[which];
                const double value = between(info.minimum, info.maximum);
                (void)rig_.submit(set_parameter, static_cast<std::uint16_t>(which), false, info.whole ? std::floor(value) : value);
            }
            return;
        case 1:
            if (!layout.variables.empty()) {
                const auto which = below(layout.variables.size());
                const auto& info = layout.variables[which];
                (void)rig_.submit(set_value, static_cast<std::uint16_t>(which), info.momentary && below(2) == 0,
                                  info.momentary ? 1 : std::floor(between(info.minimum, info.maximum)));
            }
            return;
        case 2:
            if (!layout.outputs.empty())
                (void)rig_.submit(set_output, static_cast<std::uint16_t>(below(layout.outputs.size())), false, below(2));
            return;
        default: (void)rig_.submit(below(2) == 0 ? take_control : release_control, static_cast<std::uint16_t>(below(layout.axes.size())));
    }
}

void Hands::force_anything() {
    const auto& layout = rig_.m.machine->layout();
    const bool output = below(2) == 0;
    const auto& points = output ? layout.outputs : layout.inputs;
    if (points.empty()) return;
    const auto which = static_cast<std::uint16_t>(below(points.size()));
    if (below(4) == 0) (void)rig_.submit(unforce, which, output);
    else (void)rig_.submit(force, which, output, below(2));
}

void Hands::reset_all() {
    const auto programs = rig_.m.machine->layout().programs.size();
    rig_.mode(runtime::Mode::manual);
    rig_.cycle();
    (void)rig_.submit(power, 0xFFFF, false);  // who pushes against a stop has to let go first
    (void)rig_.submit(release_forces);
    (void)rig_.submit(override_velocity, 0xFFFF, false, 1);
    for (std::size_t i = 0; i < programs; ++i) (void)rig_.submit(program_reset, static_cast<std::uint16_t>(i));
    rig_.run(5 * rig_.m.machine->config().cycle);
    (void)rig_.submit(acknowledge_alarms);
    (void)rig_.submit(reset);
    for (std::size_t i = 0; i < rig_.m.machine->layout().axes.size(); ++i)
        (void)rig_.submit(release_control, static_cast<std::uint16_t>(i));
}

}  // namespace taktwerk::whole
