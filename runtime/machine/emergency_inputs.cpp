#include "runtime/machine/emergency_inputs.hpp"

#include <algorithm>

#include "runtime/machine/after_emergency.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

/// After a press that resets: its contact may bounce, and nobody means a start so soon after it.
constexpr Duration button_bounce = std::chrono::milliseconds{500};

}  // namespace

EmergencyInputs::EmergencyInputs(MachineBody& body, ProgramRunner& programs, OperatorDesk& desk)
    : body_(body), programs_(programs), desk_(desk) {
    const auto& wanted = body.config.emergency_stop;
    if (wanted.input.empty()) return;
    input_ = body.io.find(IoDirection::input, wanted.input);
    if (!wanted.restart.empty()) restart_input_ = body.io.find(IoDirection::input, wanted.restart);
    const auto& terminal = body.io.point(IoDirection::input, static_cast<std::size_t>(input_)).slave;
    while (slave_ < body.bus.slave_count() && body.bus.slave(slave_).name != terminal) ++slave_;
}

// The input is normally closed: what cannot be read counts as pressed.
void EmergencyInputs::watch() noexcept {
    if (input_ < 0) return;
    // The axes are off and the bus goes down: a button that falls silent by that was not pressed.
    if (body_.phase.load(std::memory_order_relaxed) == MachinePhase::stopped) return;
    const auto& bus = body_.bus;
    const auto limit = supervised_limit(body_.config, body_.config.bus.lost_frames_limit);
    const bool unread = slave_ < bus.slave_count() && bus.health(slave_).age > limit;
    const bool pressed = unread || body_.io.inputs()[static_cast<std::size_t>(input_)] == 0;
    if (pressed && !body_.emergency) pressed_since_ = body_.now;
    body_.emergency = pressed;
    if (pressed) {
        body_.raise(MachineAlarm::emergency_stop, AlarmSource::machine, 0, unread ? emergency_stop_unread : 0);
        desk_.release_outputs();
        body_.io.release_output_forces();  // whatever the emergency stop switches off, no force holds it
        for (auto& program : programs_.programs()) program.requests.hold();
    }
    watch_restart();
}

axes::EmergencyStop EmergencyInputs::level() const noexcept {
    if (!body_.emergency) return axes::EmergencyStop::none;
    return body_.now - pressed_since_ >= body_.config.emergency_stop.power_off_after ? axes::EmergencyStop::power_off_now
                                                                                     : axes::EmergencyStop::stop_and_power_off;
}

// After the release a person lets programs go on: by a start of each, or by this input, which wants a new edge. Where an axis is still to be
// reset a press resets and starts nothing (IEC 60204-1, 9.2.5.4.2: the reset only permits a restart); the start is another press.
void EmergencyInputs::watch_restart() noexcept {
    const auto now = body_.now;
    const bool pressed = restart_input_ >= 0 && body_.io.inputs()[static_cast<std::size_t>(restart_input_)] != 0;
    const bool wanted = pressed && !restart_pressed_ && !body_.emergency && now >= restart_deaf_until_;
    // Contacts bounce when they are let go, too, however long they were held.
    if (restart_pressed_ && !pressed) restart_deaf_until_ = std::max(restart_deaf_until_, now + button_bounce);
    restart_pressed_ = pressed;
    const bool resets = wanted && axes_to_reset(body_.axes);
    if (resets) reset_axes();
    if (wanted) body_.log.acknowledge(id(MachineAlarm::emergency_stop));
    auto& programs = programs_.programs();
    for (std::size_t p = 0; p < programs.size(); ++p) {
        if (wanted && !resets) programs[p].requests.go_on();
        if (!body_.emergency && programs[p].requests.held() && programs[p].running())
            body_.raise(MachineAlarm::program_waits, AlarmSource::program, static_cast<std::uint16_t>(p));
    }
}

void EmergencyInputs::reset_axes() noexcept {
    restart_deaf_until_ = body_.now + button_bounce;
    for (std::size_t i = 0; i < body_.axes.size(); ++i)
        if (stopped_by_emergency(body_.axes[i]))
            (void)body_.requests.reset(axes::AxisRef{static_cast<std::uint16_t>(i)}, axes::Owner::operator_panel);
}

}  // namespace taktwerk::runtime
