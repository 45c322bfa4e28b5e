#include "ecat/cycle/cycle_clock.hpp"

#include <algorithm>
#include <limits>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t phase_smoothing = 16;
/// What a FRMW carries towards the reference is its time as the master knows it, less this: so that a datagram that comes back
/// as it was sent (the reference has lost its station address: the others wrote, the working counter is as ever) is told from
/// one with the reference's time in it. A slave that takes it all the same sees it in one frame only, and too far off to learn
/// from it; a real clock moves by a fraction of a tick then.
constexpr std::int64_t mark_ns = CycleClock::mark.count();

/// `value` in -period/2 .. period/2.
std::int64_t centred(std::int64_t value, std::int64_t period) noexcept {
    const std::int64_t into = ((value % period) + period) % period;
    return into > period / 2 ? into - period : into;
}

}  // namespace

void CycleClock::steer(Instant now, CycleLink* link) noexcept {
    const std::int64_t period = cycle_.count();
    const std::int64_t t = nanoseconds(now);
    phase_ = phase_ ? *phase_ + centred(t - *phase_, period) / phase_smoothing : ((t % period) + period) % period;
    if (link != link_) {  // another bring-up: the reference was set anew
        link_ = link;
        reference_ = ReferenceClock{};
        trusted_ = fresh_ = false;
    }
    const bool fresh = fresh_;
    fresh_ = false;
    missing_ = fresh ? 0 : std::min(missing_ + 1, std::numeric_limits<std::uint32_t>::max() - 1);
    if (link == nullptr) return;
    link->dc_missing.store(missing_, std::memory_order_relaxed);
    link->dc_time.offset_ns.store(reference_.offset_at(now), std::memory_order_relaxed);
    link->dc_time.measured.store(reference_.measured(), std::memory_order_release);
    link->send_phase_ns.store(*phase_, std::memory_order_relaxed);
    const std::int64_t target = link->dc_phase_ns.load(std::memory_order_relaxed);
    if (target < 0 || !reference_.settled()) {
        phase_error_ = 0;
        correction_ = servo_.wait();
    } else {
        phase_error_ = centred(t + reference_.offset_at(now) - target, period);
        correction_ = servo_.step({phase_error_, reference_.drift_in(cycle_), fresh});
    }
    link->dc_phase_error_ns.store(phase_error_, std::memory_order_relaxed);
    link->dc_lock.store(servo_.lock(), std::memory_order_release);
}

CycleClock::Request CycleClock::request(Instant now, std::uint16_t first) noexcept {
    const std::uint64_t serving = link_ != nullptr ? link_->reference.load(std::memory_order_relaxed) : 0;
    const bool hold = link_ != nullptr && link_->clock_holds.load(std::memory_order_relaxed) > 0;
    const std::uint16_t before = asked_.station;
    asked_.station = serving != 0 ? static_cast<std::uint16_t>(serving & 0xFFFF) : first;
    asked_.behind = static_cast<std::int64_t>(serving >> 16);
    // Another one is listened to before it is believed.
    asked_.command = trusted_ && !hold && asked_.station == before ? Command::FRMW : Command::FPRD;
    asked_.data = nanoseconds(now) + reference_.offset_at(now) - mark_ns;
    return asked_;
}

void CycleClock::answer(std::span<const std::byte> data, std::uint16_t wkc, Instant sent) noexcept {
    trusted_ = false;
    passed_.reset();
    const std::int64_t system = data.size() == 8 ? load_le<std::int64_t>(data) : asked_.data;
    // One that was addressed answers a FPRD; in a FRMW the others count, too, but only the reference changes the data.
    const bool own = asked_.command == Command::FPRD ? wkc == 1 : wkc > 0;
    if (!own || system == asked_.data) {
        reference_.miss();
        return;
    }
    // As the first reference would have said it: where a frame passes another one later, system time is the same.
    if (!reference_.take(sent, system - asked_.behind)) return;
    trusted_ = fresh_ = true;
    passed_ = system - asked_.behind;
}

void CycleClock::no_answer() noexcept {
    passed_.reset();
    reference_.miss();
}

}  // namespace taktwerk::ecat
