#include "ecat/process_data_cycle.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/dc/propagation.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t phase_smoothing = 16;
constexpr std::size_t bringup_datagrams = AcyclicChannel::max_datagrams_a_frame;  // nobody to disturb before OP

std::int64_t nanoseconds(Instant t) noexcept { return t.time_since_epoch().count(); }

/// `value` in -period/2 .. period/2.
std::int64_t centred(std::int64_t value, std::int64_t period) noexcept {
    const std::int64_t into = ((value % period) + period) % period;
    return into > period / 2 ? into - period : into;
}

}  // namespace

CyclePlan::CyclePlan(const Bus& bus)
    : plan(bus.plan), outputs(bus.plan.output_bytes), inputs(bus.plan.input_bytes), health(bus.slaves.size()), in_flight(bus.plan.frames) {
    for (const auto& slave : bus.slaves) {
        slaves.push_back(slave.get());
        if (slave->dc) ++clock_wkc;
        ++state_wkc;
    }
    if (bus.reference) reference = bus.slaves[*bus.reference]->found.station;
    first_datagram.assign(plan.frames + 1, plan.datagrams.size());
    for (std::size_t d = plan.datagrams.size(); d-- > 0;) first_datagram[plan.datagrams[d].frame] = d;
    for (std::size_t f = plan.frames; f-- > 0;) first_datagram[f] = std::min(first_datagram[f], first_datagram[f + 1]);
}

ProcessDataCycle::ProcessDataCycle(Transport& transport, const BusConfig& config)
    : transport_(transport), config_(config), exchange_(transport), channel_(exchange_) {}

void ProcessDataCycle::adopt(std::unique_ptr<CyclePlan> plan) {
    plans_.push_back(std::move(plan));
    latest_.store(plans_.back().get(), std::memory_order_release);
    running_.store(plans_.back().get(), std::memory_order_release);
}

void ProcessDataCycle::copy_statistics() noexcept {
    const auto& s = exchange_.statistics();
    statistics_.frames_sent = s.sent;
    statistics_.frames_received = s.received;
    statistics_.frames_lost = s.lost;
    statistics_.frames_late = s.late;
    statistics_.frames_rejected = s.rejected + s.duplicate;
    statistics_.send_errors = s.send_errors;
    statistics_.dc_rejected = clock_.rejected();
    if (const auto* link = link_.load(std::memory_order_acquire))
        statistics_.dc_difference_ns = link->dc_difference_ns.load(std::memory_order_relaxed);
}

void ProcessDataCycle::pump(Instant now) noexcept {
    exchange_.receive(now);
    channel_.collect(now);
    channel_.pack(now, bringup_datagrams);
    copy_statistics();
}

void ProcessDataCycle::receive(Instant now) noexcept {
    exchange_.receive(now);
    channel_.collect(now);
    if (auto* cycle = latest_.load(std::memory_order_acquire)) collect_frames(*cycle, now);
    copy_statistics();
}

void ProcessDataCycle::collect_frames(CyclePlan& cycle, Instant) noexcept {
    all_good_ = true;
    any_lost_ = false;
    bool any = false;
    for (std::size_t f = 0; f < cycle.in_flight.size(); ++f) {
        const SlotId slot = cycle.in_flight[f];
        if (slot.generation == 0) continue;
        any = true;
        cycle.in_flight[f] = SlotId{};
        std::size_t number = 0;
        const bool answered = exchange_.state(slot) == SlotState::answered;
        if (answered) {
            statistics_.round_trip = exchange_.round_trip(slot);
            if (f == 0 && cycle.reference) {
                take_clock(cycle, slot);
                ++number;
            }
        } else {
            any_lost_ = true;
            all_good_ = false;
            if (f == 0 && cycle.reference) clock_.miss();
        }
        for (std::size_t d = cycle.first_datagram[f]; d < cycle.first_datagram[f + 1]; ++d) {
            if (answered) take_datagram(cycle, d, slot, number++);
            else miss(cycle, cycle.plan.datagrams[d]);
        }
        if (answered && f == 0)
            if (auto* link = link_.load(std::memory_order_acquire)) {
                const auto states = exchange_.data(slot, number);
                const bool all_answered = exchange_.wkc(slot, number) == cycle.state_wkc;
                link->states_seen.store(all_answered && states.size() == 2 ? load_le<std::uint16_t>(states) & 0x1Fu : 0u,
                                        std::memory_order_relaxed);
            }
        exchange_.release(slot);
    }
    if (!any) return;
    statistics_.lost_in_a_row = any_lost_ ? statistics_.lost_in_a_row + 1 : 0;
    for (std::size_t s = 0; s < cycle.slaves.size(); ++s) {
        auto& health = cycle.health[s];
        const std::uint32_t al = cycle.slaves[s]->al.load(std::memory_order_relaxed);
        health.al_state = al_state(static_cast<std::uint16_t>(al));
        health.al_error = (al & al_status_error) != 0;
        health.al_status_code = static_cast<std::uint16_t>(al >> 16);
        if (!cycle.plan.slaves[s].datagram) health.fresh = !any_lost_ && health.al_state != AlState::unknown;
    }
    if (auto* link = link_.load(std::memory_order_acquire)) {
        const auto good = link->good_in_a_row.load(std::memory_order_relaxed);
        link->good_in_a_row.store(all_good_ ? good + 1 : 0, std::memory_order_relaxed);
    }
}

void ProcessDataCycle::miss(CyclePlan& cycle, const DatagramPlan& datagram) noexcept {
    for (const std::size_t s : datagram.slaves) {
        cycle.health[s].fresh = false;
        ++cycle.health[s].age;
    }
}

void ProcessDataCycle::take_datagram(CyclePlan& cycle, std::size_t d, SlotId slot, std::size_t number) noexcept {
    const auto& datagram = cycle.plan.datagrams[d];
    const std::uint16_t wkc = exchange_.wkc(slot, number);
    auto* link = link_.load(std::memory_order_acquire);
    if (wkc != datagram.expected_wkc) {
        all_good_ = false;
        if (link != nullptr) {
            link->worst_datagram.store(static_cast<std::uint16_t>(d), std::memory_order_relaxed);
            link->worst_wkc.store(wkc, std::memory_order_relaxed);
            if (link->supervise.load(std::memory_order_relaxed)) ++statistics_.working_counter_errors;
        }
        miss(cycle, datagram);
        return;
    }
    const auto data = exchange_.data(slot, number);
    std::copy_n(data.begin() + datagram.outputs.size, datagram.inputs.size, cycle.inputs.begin() + datagram.inputs.offset);
    const Instant sent = exchange_.sent_at(slot);
    for (const std::size_t s : datagram.slaves) {
        auto& health = cycle.health[s];
        health.fresh = true;
        health.age = 0;
        health.latched = sent;
        const std::int64_t start = cycle.slaves[s]->sync0_start.load(std::memory_order_relaxed);
        if (const auto offset = clock_.offset(); start != 0 && offset) {
            const std::int64_t system = nanoseconds(sent) + *offset;
            if (system >= start) health.latched = Instant{Duration{last_sync0(system, start, config_.cycle.count()) - *offset}};
        }
    }
}

/// Only a time that the reference itself put in counts (exact working counter): a slave without its station address leaves the
/// master's own time in the datagram.
void ProcessDataCycle::take_clock(const CyclePlan& cycle, SlotId slot) noexcept {
    const auto data = exchange_.data(slot, 0);
    if (data.size() != 8 || exchange_.wkc(slot, 0) != cycle.clock_wkc) {
        clock_.miss();
        return;
    }
    if (!clock_.take(exchange_.sent_at(slot), load_le<std::int64_t>(data))) return;
    statistics_.dc_offset_ns = *clock_.offset();
    statistics_.dc_drift_ppb = clock_.drift_ppb();
    if (auto* link = link_.load(std::memory_order_acquire)) {
        link->dc_offset_ns.store(*clock_.offset(), std::memory_order_relaxed);
        link->dc_samples.store(clock_.samples(), std::memory_order_release);
    }
}

void ProcessDataCycle::update_phase(Instant now) noexcept {
    const std::int64_t period = config_.cycle.count();
    const std::int64_t t = nanoseconds(now);
    phase_ = phase_ ? *phase_ + centred(t - *phase_, period) / phase_smoothing : ((t % period) + period) % period;
}

void ProcessDataCycle::send(Instant now) noexcept {
    update_phase(now);
    auto* link = link_.load(std::memory_order_acquire);
    auto* cycle = running_.load(std::memory_order_acquire);
    if (cycle != nullptr) {
        for (std::size_t f = 0; f < cycle->in_flight.size(); ++f) send_frame(*cycle, f, now);
        if (link != nullptr) {
            link->send_phase_ns.store(*phase_, std::memory_order_relaxed);
            link->cycles.store(link->cycles.load(std::memory_order_relaxed) + 1, std::memory_order_release);
        }
    }
    channel_.pack(now, operational_.load(std::memory_order_relaxed) ? config_.acyclic_per_cycle : bringup_datagrams);
}

void ProcessDataCycle::send_frame(CyclePlan& cycle, std::size_t frame, Instant now) noexcept {
    if (cycle.in_flight[frame].generation != 0) {  // send() twice without receive(): the older one is given up
        exchange_.release(cycle.in_flight[frame]);
        cycle.in_flight[frame] = SlotId{};
    }
    const auto slot = exchange_.begin(FrameKind::cyclic);
    if (!slot) return;
    cycle.in_flight[frame] = *slot;
    if (frame == 0 && cycle.reference) {
        const auto* link = link_.load(std::memory_order_acquire);
        const bool hold = link != nullptr && link->hold_clock.load(std::memory_order_relaxed);
        const auto clock =
            exchange_.add(*slot, hold ? Command::FPRD : Command::FRMW, Address::physical(*cycle.reference, reg::dc_system_time), 8);
        // Should the reference be away, the others get the master's idea of its time instead of 0.
        if (clock) store_le(clock->data, 0, nanoseconds(now) + clock_.offset().value_or(0));
    }
    for (std::size_t d = cycle.first_datagram[frame]; d < cycle.first_datagram[frame + 1]; ++d) {
        const auto& datagram = cycle.plan.datagrams[d];
        const auto lrw = exchange_.add(*slot, Command::LRW, Address::logical(datagram.logical), datagram.size());
        if (lrw) std::copy_n(cycle.outputs.begin() + datagram.outputs.offset, datagram.outputs.size, lrw->data.begin());
    }
    if (frame == 0) exchange_.add(*slot, Command::BRD, Address::physical(0, reg::al_status), 2);
    exchange_.send(*slot, now);
}

std::span<const std::byte> ProcessDataCycle::inputs() const noexcept {
    const auto* cycle = latest_.load(std::memory_order_acquire);
    return cycle != nullptr ? std::span<const std::byte>{cycle->inputs} : std::span<const std::byte>{};
}

std::span<std::byte> ProcessDataCycle::outputs() noexcept {
    auto* cycle = latest_.load(std::memory_order_acquire);
    return cycle != nullptr ? std::span<std::byte>{cycle->outputs} : std::span<std::byte>{};
}

const SlaveHealth& ProcessDataCycle::health(std::size_t slave) const noexcept {
    const auto* cycle = latest_.load(std::memory_order_acquire);
    return cycle != nullptr && slave < cycle->health.size() ? cycle->health[slave] : nothing_;
}

Instant ProcessDataCycle::outputs_effective(std::size_t slave, Instant send_time) const noexcept {
    const auto* cycle = latest_.load(std::memory_order_acquire);
    if (cycle == nullptr || slave >= cycle->slaves.size() || !clock_.offset()) return send_time;
    const std::int64_t start = cycle->slaves[slave]->sync0_start.load(std::memory_order_relaxed);
    if (start == 0) return send_time;
    const std::int64_t arrival = nanoseconds(send_time) + statistics_.round_trip.count() / 2 + *clock_.offset();
    return Instant{Duration{next_sync0(arrival + 1, start, config_.cycle.count()) - *clock_.offset()}};
}

}  // namespace taktwerk::ecat
