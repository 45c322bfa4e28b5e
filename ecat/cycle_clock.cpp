#include "ecat/cycle_clock.hpp"

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t phase_smoothing = 16;
/// What a FRMW carries towards the reference is its time as the master knows it, less this: so that a datagram that comes back
/// as it was sent (the reference has lost its station address: the others wrote, the working counter is as ever) is told from
/// one with the reference's time in it. Should it be taken by a slave all the same, one microsecond for one cycle is nothing.
constexpr std::int64_t mark_ns = 1000;

std::int64_t nanoseconds(Instant t) noexcept { return t.time_since_epoch().count(); }

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
    if (link == nullptr) return;
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

CycleClock::Request CycleClock::request(Instant now, bool hold) noexcept {
    asked_.command = trusted_ && !hold ? Command::FRMW : Command::FPRD;
    asked_.data = nanoseconds(now) + reference_.offset_at(now) - mark_ns;
    return asked_;
}

void CycleClock::answer(std::span<const std::byte> data, std::uint16_t wkc, Instant sent) noexcept {
    trusted_ = false;
    const std::int64_t system = data.size() == 8 ? load_le<std::int64_t>(data) : asked_.data;
    // One that was addressed answers a FPRD; in a FRMW the others count, too, but only the reference changes the data.
    const bool own = asked_.command == Command::FPRD ? wkc == 1 : wkc > 0;
    if (!own || system == asked_.data) {
        reference_.miss();
        return;
    }
    if (!reference_.take(sent, system)) return;
    trusted_ = fresh_ = true;
    if (link_ == nullptr) return;
    link_->dc_offset_ns.store(*reference_.offset(), std::memory_order_relaxed);
    link_->dc_settled.store(reference_.settled(), std::memory_order_release);
}

void CycleClock::no_answer() noexcept { reference_.miss(); }

}  // namespace taktwerk::ecat
