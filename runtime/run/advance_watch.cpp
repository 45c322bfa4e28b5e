#include "runtime/run/advance_watch.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

using namespace std::chrono_literals;

constexpr Duration shortest_patience = 250ms;
constexpr int cycles_of_patience = 50;
constexpr int relaxed_patience = 10;

}  // namespace

std::string StuckCycle::text() const {
    const auto where = program.empty() ? std::string("no program's code is running in it")
                                       : fmt::format("task '{}' of program '{}' does not return", task, program);
    return fmt::format("the cycle has not advanced for {:.1f} s: {}; what is shown is old, and no frame leaves", to_seconds(lasts), where);
}

AdvanceWatch::AdvanceWatch(const Machine& machine)
    : machine_(machine), patience_(std::max<Duration>(shortest_patience, cycles_of_patience * machine.config().cycle)) {
    if (machine.config().simulation.supervision == Supervision::relaxed) patience_ *= relaxed_patience;
}

std::optional<StuckCycle> AdvanceWatch::look(Instant now) {
    const auto pulse = machine_.pulse();
    // Who did not look himself for long (stopped in a debugger, starved) knows nothing about what was meanwhile.
    const bool blind = now - looked_ > patience_ / 2;
    looked_ = now;
    if (first_ || blind || pulse.cycles != seen_) {
        first_ = false;
        seen_ = pulse.cycles;
        advanced_ = now;
        return std::nullopt;
    }
    if (pulse.cycles == 0 || now - advanced_ < patience_) return std::nullopt;  // before the first cycle nothing can be old
    StuckCycle stuck;
    stuck.lasts = now - advanced_;
    if (pulse.task >= 0) {
        const auto names = machine_.task_names(static_cast<std::size_t>(pulse.task));
        stuck.program = names.program;
        stuck.task = names.task;
    }
    return stuck;
}

}  // namespace taktwerk::runtime
