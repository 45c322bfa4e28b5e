#include "runtime/machine/page_fault_alarm.hpp"

namespace taktwerk::runtime {

namespace {
/// Many in a row are one alarm.
constexpr Duration shown_for = std::chrono::seconds{5};
}  // namespace

// Where memory is not locked, a page that is met for the first time is nothing that went wrong: the start has said what that costs. One that comes from
// a disk is.
void PageFaultAlarm::watch() noexcept {
    const auto now = body_.now;
    const auto faults = replayed_.value_or(FaultsSeen{minor_.load(std::memory_order_relaxed), major_.load(std::memory_order_relaxed),
                                                      locked_.load(std::memory_order_relaxed)});
    if (now >= shown_until_) shown_ = shown_major_ = 0;
    if (faults != seen_) {
        if (body_.recorder != nullptr) record_faults(*body_.recorder, now, faults);
        const auto major = faults.major - seen_.major, minor = faults.memory_locked ? faults.minor - seen_.minor : 0;
        if (major + minor > 0) {
            shown_ += major + minor;
            shown_major_ += major;
            shown_until_ = now + shown_for;
        }
        seen_ = faults;
        body_.statistics.page_faults = faults.minor + faults.major;
        body_.statistics.disk_page_faults = faults.major;
    }
    if (now < shown_until_)
        body_.raise(MachineAlarm::page_faults, AlarmSource::machine, 0, static_cast<double>(shown_), static_cast<double>(shown_major_));
}

}  // namespace taktwerk::runtime
