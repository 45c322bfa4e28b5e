#include "runtime/machine/late_cycles.hpp"

#include <algorithm>

#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

/// How long a late wake-up stays listed: many in a row are one alarm.
constexpr Duration late_wakeups_shown = std::chrono::seconds{1};
/// The same for a base task that computes too long: one in a hundred cycles is one alarm, too.
constexpr Duration long_task_shown = std::chrono::seconds{5};

}  // namespace

// A cycle that comes late behind one that went past its own end, with a base task taking most of that time, is late by that task and
// not by its wake-up. In virtual time nothing is ever late, so a measured time changes nothing there.
void LateCycles::blame_base_task(const CycleTick& tick) noexcept {
    const auto now = body_.now;
    const auto cycle = body_.config.cycle;
    const bool late = tick.missed > 0 || tick.woken > tick.scheduled;
    const auto& before = body_.statistics;
    const auto& longest = programs_.longest_base_task();
    late_by_a_task_ = late && body_.cycles > 0 && before.compute > before.lateness && before.compute + before.lateness > cycle &&
                      longest.run > before.compute / 2;
    if (late_by_a_task_) {
        if (now >= blamed_until_ || longest.run > blamed_.run || longest.place != blamed_.place) blamed_ = longest;
        blamed_until_ = now + long_task_shown;
    }
    if (now < blamed_until_)
        body_.raise(MachineAlarm::base_task_overrun, AlarmSource::task, static_cast<std::uint16_t>(blamed_.place),
                    to_seconds(blamed_.run) * 1e3, to_seconds(cycle) * 1e3);
}

void LateCycles::watch(const CycleTick& tick) noexcept {
    const auto now = body_.now;
    const auto& limits = body_.config.watch;
    blame_base_task(tick);
    overruns_in_a_row_ = tick.missed > 0 ? overruns_in_a_row_ + tick.missed : 0;
    if (const auto allowed = supervised_limit(body_.config, limits.overruns_allowed); overruns_in_a_row_ > allowed)
        body_.raise(MachineAlarm::cycle_overrun, late_by_a_task_ ? AlarmSource::task : AlarmSource::machine,
                    static_cast<std::uint16_t>(late_by_a_task_ ? blamed_.place : 0), overruns_in_a_row_, allowed);
    const auto warning = limits.lateness_warning > Duration{} ? limits.lateness_warning : body_.config.cycle / 4;
    const auto late = tick.woken - tick.scheduled;
    if (now >= late_until_) late_worst_ = Duration{};
    if (late > warning && !late_by_a_task_) {
        late_until_ = now + late_wakeups_shown;
        late_worst_ = std::max(late_worst_, late);
    }
    if (now < late_until_)
        body_.raise(MachineAlarm::late_wakeups, AlarmSource::machine, 0, to_seconds(late_worst_) * 1e6, to_seconds(warning) * 1e6);
}

}  // namespace taktwerk::runtime
