#include "runtime/run/end_watch.hpp"

#include <string_view>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

using namespace std::chrono_literals;

constexpr Duration bus_and_files = 8s;  // the bus into INIT (at most 5 s), the files closed; only while the cycle advances
constexpr Duration threads_home = 5s;   // the disk, too, must have taken the last positions by then

}  // namespace

std::string EndWatch::who() const {
    if (stuck_) return stuck_->text();
    if (const auto code = machine_.program_at_work(); !code.empty()) return code + " does not return";
    if (machine_.disk_at_work()) return "a disk does not take what is kept";
    return "the bus or the system did not end in time";
}

std::optional<Error> EndWatch::look(Instant now) {
    stuck_ = cycle_.look(now);
    if (!asked_ && machine_.shutdown_asked()) asked_ = now;
    if (!alone_ && only_threads_left_.load(std::memory_order_acquire)) alone_ = now;
    if (alone_ && machine_.phase() == MachinePhase::stopped) stuck_.reset();  // its thread has come home
    const bool late = asked_ && now - *asked_ > machine_.longest_stop() + (stuck_ ? Duration{} : bus_and_files);
    const bool left_behind = alone_ && now - *alone_ > threads_home;
    if (!late && !left_behind) return std::nullopt;
    const bool a_program = stuck_ || !machine_.program_at_work().empty();
    const std::string_view cure = a_program ? "Mend that program"
                                  : machine_.disk_at_work()
                                      ? "Look at the disk of `retain`; axes may not be homed, or stand elsewhere, after the next start"
                                      : "Look at the log before this line";
    return Error{"run.ended_hard", "run", "the run was told to end and cannot: " + who(),
                 fmt::format("{}{}", cure,
                             left_behind && !stuck_ ? "; the axes had stopped and the bus was down."
                                                    : ". No frame leaves any more: the drives stop by their own watchdogs.")};
}

}  // namespace taktwerk::runtime
