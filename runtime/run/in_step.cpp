#include "runtime/run/in_step.hpp"

namespace taktwerk::runtime {

void InStep::between_cycles() {
    const std::unique_lock mine{service_side_, std::try_to_lock};
    if (!mine) return;
    if (start_.exchange(false)) machine_.start_bus();
    if (stop_.exchange(false)) machine_.stop_bus();
    if (arm_.exchange(false)) {
        if (auto done = machine_.arm(); !done) not_armed_ = done.error();
        armed_.store(true, std::memory_order_release);
    }
    machine_.service_bus(clock_.now());
}

std::optional<Result<void>> InStep::armed() const {
    if (!armed_.load(std::memory_order_acquire)) return std::nullopt;
    return not_armed_ ? Result<void>{*not_armed_} : Result<void>{};
}

}  // namespace taktwerk::runtime
