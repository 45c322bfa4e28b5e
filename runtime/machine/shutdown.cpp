#include "runtime/machine/shutdown.hpp"

#include <algorithm>

#include "runtime/stop_time.hpp"

namespace taktwerk::runtime {

namespace {

constexpr Duration shutdown_margin = std::chrono::seconds{5};  // for a drive that does not answer

}  // namespace

Shutdown::Shutdown(MachineBody& body, ProgramRunner& programs, OperatorDesk& desk) : body_(body), programs_(programs), desk_(desk) {
    double longest_stop = 0;
    for (const auto& binding : body.config.axes) longest_stop = std::max(longest_stop, stop_seconds(binding.axis.limits));
    patience_ = shutdown_margin + 2 * from_seconds(longest_stop);
}

void Shutdown::begin() noexcept {
    body_.shutting_down = true;
    since_ = body_.now;
    body_.phase.store(MachinePhase::stopping, std::memory_order_release);
    programs_.stop_all();
    desk_.drop_power();
    body_.io.release_forces();
    body_.io.make_safe();
    for (std::size_t i = 0; i < body_.axes.size(); ++i) body_.shut_down(i);
}

void Shutdown::step() noexcept {
    if (!desk_.shutdown_taken()) return;
    if (!body_.shutting_down) begin();
    const bool off = std::none_of(body_.axes.begin(), body_.axes.end(), [](const axes::Axis& axis) {
        const auto state = axis.view().drive_state;
        return state == axes::PowerState::enabled || state == axes::PowerState::quick_stop;
    });
    if (off || body_.now - since_ > patience_) body_.phase.store(MachinePhase::stopped, std::memory_order_release);
}

}  // namespace taktwerk::runtime
