#include "runtime/machine/drive_emergencies.hpp"

#include "ecat/alarms.hpp"

namespace taktwerk::runtime {

namespace {

/// A drive that sent an emergency shows it in its status word within this time, or it is no fault of the drive.
constexpr Duration drive_speaks_within = std::chrono::milliseconds{100};
/// An emergency that was over before an axis told it is an alarm for so long: nobody sees one of a cycle.
constexpr Duration missed_emergency_shown = std::chrono::seconds{1};

}  // namespace

void DriveEmergencies::begin_cycle() noexcept {
    for (auto& last : of_slaves_) last.seen = false;
}

// What is over may still be told for a moment: the status word is behind.
void DriveEmergencies::end_cycle() noexcept {
    const auto now = body_.now;
    for (auto& last : of_slaves_) {
        const bool over = !last.seen && last.fact.a != 0;
        if (over) (void)axis_tells(last);
        if (over && (last.told || last.raised || now - last.since >= drive_speaks_within)) miss(last);
        if (now < last.shown_until) body_.raise(last.missed, ecat::bus_alarms);
    }
}

void DriveEmergencies::miss(OfSlave& last) noexcept {
    if (last.fact.a != 0 && !last.told && !last.raised) {
        last.missed = last.fact;
        last.shown_until = body_.now + missed_emergency_shown;
    }
    last.fact = {};
}

bool DriveEmergencies::axis_tells(OfSlave& last) noexcept {
    bool has_axis = false;
    for (std::size_t axis = 0; axis < body_.axes.size(); ++axis) {
        if (drives_.slave_of(axis) != last.fact.index) continue;
        has_axis = true;
        last.told = last.told || drives_.port(axis).alarm().code == static_cast<std::uint16_t>(last.fact.a);
    }
    return has_axis;
}

// The two do not come and go at the same moment: the status word may be some milliseconds behind, and the message that the error is gone comes
// that much after a reset.
bool DriveEmergencies::told_by_an_axis(const AlarmFact& fact) noexcept {
    auto& last = of_slaves_[fact.index];
    if (last.fact.a != fact.a) {
        miss(last);
        last.since = body_.now;
        last.told = last.raised = false;
    }
    last.fact = fact;
    last.seen = true;
    const bool has_axis = axis_tells(last);
    if (last.told || (has_axis && body_.now - last.since < drive_speaks_within)) return true;
    last.raised = true;
    return false;
}

}  // namespace taktwerk::runtime
