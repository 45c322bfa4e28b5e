#include "ecat/cycle/process_data_cycle.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/dc/sync0_budget.hpp"
#include "ecat/ring/ring_view.hpp"

namespace taktwerk::ecat {

namespace {

/// Before OP nobody is disturbed but the frames of the next cycle: what is acyclic may take a quarter of the cycle on the wire.
constexpr std::int64_t bringup_share = 4;
constexpr Duration longest_frame = std::chrono::microseconds{124};  ///< 1518 bytes, preamble and gap at 100 Mbit/s

}  // namespace

ProcessDataCycle::ProcessDataCycle(Transport& transport, const BusConfig& config)
    : transport_(transport), ring_(transport.ring()), config_(config), exchange_(transport), channel_(exchange_), clock_(config.cycle) {}

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
    statistics_.frames_foreign = s.foreign;
    statistics_.dc_rejected = clock_.reference().rejected();
    statistics_.dc_offset_ns = clock_.offset().value_or(0);
    statistics_.dc_drift_ppb = clock_.reference().drift_ppb();
    statistics_.dc_lock = clock_.lock();
    statistics_.dc_phase_error_ns = clock_.phase_error();
    statistics_.dc_correction = clock_.correction();
    if (ring_ != nullptr) statistics_.ring = ring_->state();
    if (auto* link = link_.load(std::memory_order_acquire)) {
        if (ring_ != nullptr) link->ring.store(statistics_.ring);
        link->line.link_up.store(transport_.link_up(), std::memory_order_relaxed);
        std::uint64_t source = 0;
        for (const std::uint8_t byte : s.foreign_source) source = source << 8 | byte;
        link->foreign_source.store(source, std::memory_order_relaxed);
        link->foreign_frames.store(s.foreign, std::memory_order_relaxed);
        link->dc_time.drift_ppb.store(statistics_.dc_drift_ppb, std::memory_order_relaxed);
        statistics_.dc_difference_ns = link->dc_difference_ns.load(std::memory_order_relaxed);
    }
}

void ProcessDataCycle::pump(Instant now) noexcept {
    exchange_.receive(now);
    channel_.collect(now);
    pack_bring_up(now);
    copy_statistics();
}

void ProcessDataCycle::receive(Instant now) noexcept {
    exchange_.receive(now);
    channel_.collect(now);
    auto* cycle = latest_.load(std::memory_order_acquire);
    note_stall(now);  // before the answers are judged: a slave or drive that complains of it speaks in the first of them
    if (cycle != nullptr) collect_frames(*cycle);
    note_gap(now);
    copy_statistics();
    if (cycle != nullptr) find_faults(*cycle, now);
}

/// Two frames missing in a row are the least that a drive's SYNC supervision or a slave's watchdog (three periods) minds. Of several
/// gaps close behind one another the longest is told: the shorter ones are this computer catching its breath.
void ProcessDataCycle::note_stall(Instant now) noexcept {
    auto* link = link_.load(std::memory_order_acquire);
    if (link == nullptr || !last_departure_) return;
    const Duration gap = now - *last_departure_;
    if (2 * gap <= 5 * config_.cycle) return;
    link->stall_ns.store(std::max(gap, recent_stall(*link, now)).count(), std::memory_order_relaxed);
    link->stall_ended_ns.store(nanoseconds(now), std::memory_order_relaxed);
}

/// The same of frames that this computer sent and that did not come back: short of the limit they are only counted, but slaves and drives
/// have watchdogs of their own, and what these say then is no fault of theirs.
void ProcessDataCycle::note_gap(Instant now) noexcept {
    constexpr std::uint32_t least_gap = 2;
    auto* link = link_.load(std::memory_order_acquire);
    if (link == nullptr || statistics_.lost_in_a_row < least_gap) return;
    link->gap_cycles.store(std::max(statistics_.lost_in_a_row, recent_gap(*link, now)), std::memory_order_relaxed);
    link->gap_ended_ns.store(nanoseconds(now), std::memory_order_relaxed);
}

void ProcessDataCycle::find_faults(CyclePlan& cycle, Instant now) noexcept {
    for (std::size_t s = 0; s < cycle.slaves.size(); ++s) {
        const auto& health = cycle.health[s];
        const auto& link = *cycle.slaves[s].link;
        if (link.attendance.load(std::memory_order_relaxed) != Attendance::there) {
            cycle.faults.condition(s) = {.al_state = AlState::op, .seen = link.seen.load()};  // nothing is expected of it
            continue;
        }
        cycle.faults.condition(s) = {
            .al_state = health.al_state,
            .al_error = health.al_error,
            .al_status_code = health.al_status_code,
            .age = health.age,
            .presence = link.presence.load(std::memory_order_relaxed),
            .trouble = link.trouble.load(std::memory_order_relaxed),
            .attempts = link.attempts.load(std::memory_order_relaxed),
            .taken_down = link.taken_down.load(std::memory_order_relaxed),
            .seen = link.seen.load(),
            .cable = link.cable.load(),
            .emergency_code = health.emergency_code,
            .error_register = health.error_register,
        };
    }
    const bool in_time = statistics_.dc_lock == DcLock::locked || statistics_.dc_lock == DcLock::coasting;
    BusCondition bus{
        .link_up = transport_.link_up(),
        .lost_in_a_row = statistics_.lost_in_a_row,
        .slaves_answering = statistics_.slaves_answering,
        .reference_times_missing = clock_.reference().rejected_in_a_row(),
        .dc_difference_ns = statistics_.dc_difference_ns,
        .dc_phase_error_ns = statistics_.dc_phase_error_ns,
        .ring = statistics_.ring,
        .ramp_down = config_.ring && config_.ring->behind_break == BehindBreak::ramp_down,
    };
    if (const auto* link = link_.load(std::memory_order_acquire)) {
        bus.seen = link->seen.load();
        bus.reference_station = static_cast<std::uint16_t>(link->reference.load(std::memory_order_relaxed) & 0xFFFFu);
        bus.guests = link->line.guests.load(std::memory_order_relaxed);
        bus.stall = recent_stall(*link, now);
        bus.gap = recent_gap(*link, now);
        bus.states = static_cast<std::uint16_t>(link->states_seen.load(std::memory_order_relaxed));
        bus.out_of_lock = !in_time && link->runs_sync0.load(std::memory_order_relaxed);
    }
    cycle.faults.look(bus);
}

void ProcessDataCycle::collect_frames(CyclePlan& cycle) noexcept {
    if (!cycle.sent) return;
    cycle.sent = false;
    any_lost_ = cycle.frames[0].generation == 0;
    for (const SlotId slot : cycle.frames) {
        if (slot.generation == 0) continue;
        if (exchange_.state(slot) == SlotState::answered) statistics_.round_trip = exchange_.round_trip(slot);
        else any_lost_ = true;
    }
    all_good_ = !any_lost_;
    collect_first_frame(cycle, cycle.frames[0]);
    clock_offset_ = clock_.offset().value_or(0);
    for (const auto& unit : cycle.plan.units) take_unit(cycle, unit);
    give_up_frames(cycle);

    statistics_.lost_in_a_row = any_lost_ ? statistics_.lost_in_a_row + 1 : 0;
    if (auto* link = link_.load(std::memory_order_acquire)) {
        link->lost_in_a_row.store(statistics_.lost_in_a_row, std::memory_order_relaxed);
        if (statistics_.lost_in_a_row == config_.lost_frames_limit) link->line.silences.fetch_add(1, std::memory_order_relaxed);
        if (ring_ != nullptr) upheavals_.see_ring(ring_->state());
        link->line.upheavals.store(upheavals_.count(), std::memory_order_relaxed);
    }
    for (std::size_t s = 0; s < cycle.slaves.size(); ++s) {
        auto& health = cycle.health[s];
        const std::uint32_t al = cycle.slaves[s].link->al.load(std::memory_order_relaxed);
        health.al_state = al_state(static_cast<std::uint16_t>(al));
        health.al_error = (al & al_status_error) != 0;
        health.al_status_code = static_cast<std::uint16_t>(al >> 16);
        const std::uint32_t emergency = cycle.slaves[s].emergency->load(std::memory_order_relaxed);
        health.emergency_code = static_cast<std::uint16_t>(emergency);
        health.error_register = static_cast<std::uint8_t>(emergency >> 16);
        if (!cycle.plan.slaves[s].unit) health.fresh = !any_lost_ && health.al_state != AlState::unknown;
        cycle.slaves[s].link->age.store(health.age, std::memory_order_relaxed);
    }
    if (auto* link = link_.load(std::memory_order_acquire)) {
        const auto good = link->good_in_a_row.load(std::memory_order_relaxed);
        link->good_in_a_row.store(all_good_ ? good + 1 : 0, std::memory_order_relaxed);
    }
}

/// What only the first frame carries: reference time, AL states, full mailboxes.
void ProcessDataCycle::collect_first_frame(CyclePlan& cycle, SlotId slot) noexcept {
    const bool answered = exchange_.state(slot) == SlotState::answered;
    if (cycle.reference) {
        if (answered) clock_.answer(exchange_.data(slot, 0), exchange_.wkc(slot, 0), exchange_.departed_at(slot));
        else clock_.no_answer();
        measure_margin(cycle, slot);
    }
    auto* link = link_.load(std::memory_order_acquire);
    if (!answered || link == nullptr || exchange_.half(slot)) return;
    const auto states = exchange_.data(slot, cycle.state_number);
    statistics_.slaves_answering = exchange_.wkc(slot, cycle.state_number);
    link->slaves_answering.store(statistics_.slaves_answering, std::memory_order_relaxed);
    const bool all_answered = statistics_.slaves_answering == cycle.state_wkc + link->line.guests.load(std::memory_order_relaxed);
    const auto all_states = static_cast<std::uint16_t>(states.size() == 2 ? load_le<std::uint16_t>(states) & 0x1Fu : 0u);
    link->states_seen.store(all_answered ? all_states : 0u, std::memory_order_relaxed);
    upheavals_.see_slaves(statistics_.slaves_answering, all_states);
    if (cycle.plan.mailbox.size > 0)
        link->mailbox.publish(exchange_.data(slot, cycle.state_number + 1),
                              exchange_.wkc(slot, cycle.state_number + 1) == cycle.plan.mailbox.expected_wkc);
}

/// From the arrival of the last byte of the frames at each slave to the SYNC0 that was to find them there.
void ProcessDataCycle::measure_margin(CyclePlan& cycle, SlotId slot) noexcept {
    const auto passed = clock_.passed_reference();
    if (!passed) return;
    std::size_t bytes = 0, frames = 0;
    for (const SlotId frame : cycle.frames) {
        if (frame.generation == 0) continue;
        bytes += exchange_.frame_size(frame);
        ++frames;
    }
    const std::int64_t through = *passed + flight_time(bytes, frames, 0).count();
    const std::int64_t due = nanoseconds(exchange_.sent_at(slot)) + clock_.offset_at(exchange_.sent_at(slot));
    std::optional<std::int64_t> least;
    for (std::size_t s = 0; s < cycle.slaves.size(); ++s) {
        const std::int64_t start = sync0_of(cycle, s);
        if (start == 0 || due < start) continue;
        const std::int64_t margin = cycle.sync0[s].next(due + 1, start, cycle.slaves[s].period.count()) - (through + cycle.slaves[s].delay);
        least = least ? std::min(*least, margin) : margin;
    }
    if (!least) return;
    statistics_.sync0_margin_ns = *least;
    if (!operational_.load(std::memory_order_relaxed)) return;
    statistics_.sync0_margin_least_ns = margin_known_ ? std::min(statistics_.sync0_margin_least_ns, *least) : *least;
    margin_known_ = true;
}

bool ProcessDataCycle::answered_exactly(const CyclePlan& cycle, const UnitPlan& unit) noexcept {
    bool exact = true;
    for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) {
        const auto place = cycle.places[d];
        if (place.frame == CyclePlan::Place::nowhere) return false;
        const SlotId slot = cycle.frames[place.frame];
        if (exchange_.state(slot) != SlotState::answered) return false;
        const std::uint16_t wkc = exchange_.wkc(slot, place.number);
        if (wkc == cycle.plan.datagrams[d].expected_wkc) continue;
        exact = false;
        if (auto* link = link_.load(std::memory_order_acquire)) {
            link->worst_datagram.store(static_cast<std::uint16_t>(d), std::memory_order_relaxed);
            link->worst_wkc.store(wkc, std::memory_order_relaxed);
            if (link->supervise.load(std::memory_order_relaxed)) ++statistics_.working_counter_errors;
        }
    }
    return exact;
}

bool ProcessDataCycle::away(const CyclePlan& cycle, const UnitPlan& unit) noexcept {
    return std::any_of(unit.slaves.begin(), unit.slaves.end(), [&](std::size_t s) {
        return cycle.slaves[s].link->attendance.load(std::memory_order_acquire) != Attendance::there;
    });
}

void ProcessDataCycle::take_unit(CyclePlan& cycle, const UnitPlan& unit) noexcept {
    auto& under_way = cycle.under_way[static_cast<std::size_t>(&unit - cycle.plan.units.data())];
    if (!under_way) {
        for (const std::size_t s : unit.slaves) cycle.health[s].fresh = cycle.health[s].due = false;
        return;
    }
    under_way = 0;
    if (away(cycle, unit)) {
        for (const std::size_t s : unit.slaves) {
            auto& health = cycle.health[s];
            health.fresh = false;
            health.due = true;
            health.age = std::max(health.age, 1u);
        }
        return;
    }
    if (!answered_exactly(cycle, unit)) {
        all_good_ = false;
        for (const std::size_t s : unit.slaves) {
            auto& health = cycle.health[s];
            health.fresh = false;
            health.due = true;
            ++health.age;
        }
        return;
    }
    for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) {
        const auto& datagram = cycle.plan.datagrams[d];
        const auto data = exchange_.data(cycle.frames[cycle.places[d].frame], cycle.places[d].number);
        std::copy_n(data.begin() + datagram.outputs.size, datagram.inputs.size, cycle.inputs.begin() + datagram.inputs.offset);
    }
    const Instant sent = exchange_.sent_at(cycle.frames[cycle.places[unit.first].frame]);
    for (const std::size_t s : unit.slaves) {
        auto& health = cycle.health[s];
        health.fresh = health.due = true;
        health.age = 0;
        health.latched = sent;
        if (const std::int64_t start = sync0_of(cycle, s); start != 0) {
            const std::int64_t system = nanoseconds(sent) + clock_offset_;
            if (system >= start)
                health.latched = Instant{Duration{cycle.sync0[s].last(system, start, cycle.slaves[s].period.count()) - clock_offset_}};
        }
    }
}

std::int64_t ProcessDataCycle::sync0_of(const CyclePlan& cycle, std::size_t slave) const noexcept {
    return clock_.known() ? cycle.slaves[slave].link->sync0_start.load(std::memory_order_relaxed) : 0;
}

void ProcessDataCycle::send(Instant now) noexcept {
    auto* link = link_.load(std::memory_order_acquire);
    clock_.steer(now, link);
    auto* cycle = running_.load(std::memory_order_acquire);
    if (cycle != nullptr) {
        if (ring_ != nullptr) steer_ring(*cycle);
        send_frames(*cycle, now);
        // The cycle may be due in time and still come to its send() late: what counts is when the frames left.
        const Instant left = std::max(now, exchange_.departed_at(cycle->frames[0]));
        note_stall(left);
        last_departure_ = left;
        if (link != nullptr) {
            link->first_send_ns.store(nanoseconds(now) - static_cast<std::int64_t>(cycle->number - 1) * config_.cycle.count(),
                                      std::memory_order_relaxed);
            link->cycles.store(link->cycles.load(std::memory_order_relaxed) + 1, std::memory_order_release);
        }
    } else {
        last_departure_.reset();
    }
    if (operational_.load(std::memory_order_relaxed)) channel_.pack(now, config_.acyclic_per_cycle);
    else pack_bring_up(now);
}

/// What the half without the reference shall take for its time. The second interface's frame passes the slaves behind the break on its way
/// back, first the one next to it: at D(last) - D(that one) after the last slave, where D counts from the reference. As long as both of the
/// master's own cables are as long, every slave j there sees the reference's time less D(j), which it adds itself.
void ProcessDataCycle::steer_ring(const CyclePlan& cycle) noexcept {
    const RingState& ring = statistics_.ring;
    const auto& delays = cycle.ring_delays;
    RingClocks clocks;
    // Counted from the far end: at the break slaves may be missing.
    const bool cut_off = ring.shape == RingShape::open && cycle.reference_position < ring.before_break && ring.behind_break > 0 &&
                         ring.behind_break <= delays.size();
    if (cut_off && config_.ring && config_.ring->behind_break == BehindBreak::hand_time_on) {
        clocks.hand_on = true;
        clocks.ahead = CycleClock::mark.count() + delays.back() - 2 * delays[delays.size() - ring.behind_break];
    }
    ring_->set_clocks(clocks);
}

void ProcessDataCycle::pack_bring_up(Instant now) noexcept {
    const auto frames = std::clamp<std::int64_t>(config_.cycle / (bringup_share * longest_frame), 1, AcyclicChannel::max_frames);
    for (std::int64_t i = 0; i < frames; ++i)
        if (channel_.pack(now, AcyclicChannel::max_datagrams_a_frame) == 0) return;
}

void ProcessDataCycle::send_frames(CyclePlan& cycle, Instant now) noexcept {
    give_up_frames(cycle);  // send() twice without receive()
    const SlotId first = cycle.frames[0] = exchange_.begin(FrameKind::cyclic).value_or(SlotId{});
    if (cycle.reference) add_clock(cycle, first, now);
    FramePacker packer{cycle.plan.mailbox};
    for (std::size_t u = 0; u < cycle.plan.units.size(); ++u) {
        cycle.under_way[u] = cycle.plan.units[u].due(cycle.number) ? 1 : 0;
        if (cycle.under_way[u]) add_unit(cycle, cycle.plan.units[u], packer);
    }
    if (const auto states = exchange_.add(first, Command::BRD, Address::physical(0, reg::al_status), 2))
        cycle.state_number = states->number;
    const auto& mailbox = cycle.plan.mailbox;
    if (mailbox.size > 0) exchange_.add(first, Command::LRD, Address::logical(mailbox.logical), mailbox.size);
    for (const SlotId slot : cycle.frames)
        if (slot.generation != 0) exchange_.send(slot, now);
    cycle.sent = true;
    ++cycle.number;
}

void ProcessDataCycle::add_clock(const CyclePlan& cycle, SlotId slot, Instant now) noexcept {
    const auto request = clock_.request(now, *cycle.reference);
    const auto clock = exchange_.add(slot, request.command, Address::physical(request.station, reg::dc_system_time), 8);
    if (clock) store_le(clock->data, 0, request.data);
}

void ProcessDataCycle::add_unit(CyclePlan& cycle, const UnitPlan& unit, FramePacker& packer) noexcept {
    std::size_t before = 0;
    for (std::size_t d = unit.first; d < unit.first + unit.count; ++d) {
        const auto& datagram = cycle.plan.datagrams[d];
        cycle.places[d] = {};
        const auto frame = packer.place(datagram.size(), datagram.continues ? before : 0);
        if (!frame || *frame >= cycle.frames.size()) continue;
        before = *frame;
        auto& slot = cycle.frames[*frame];
        if (slot.generation == 0) slot = exchange_.begin(FrameKind::cyclic).value_or(SlotId{});
        const auto added = exchange_.add(slot, datagram.command, Address::logical(datagram.logical), datagram.size());
        if (!added) continue;
        std::copy_n(cycle.outputs.begin() + datagram.outputs.offset, datagram.outputs.size, added->data.begin());
        cycle.places[d] = {static_cast<std::uint8_t>(*frame), static_cast<std::uint8_t>(added->number)};
    }
}

void ProcessDataCycle::give_up_frames(CyclePlan& cycle) noexcept {
    for (auto& slot : cycle.frames) {
        if (slot.generation != 0) exchange_.release(slot);
        slot = SlotId{};
    }
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

Attendance ProcessDataCycle::attendance(std::size_t slave) const noexcept {
    const auto* cycle = latest_.load(std::memory_order_acquire);
    if (cycle == nullptr || slave >= cycle->slaves.size()) return Attendance::away;
    const auto now = cycle->slaves[slave].link->attendance.load(std::memory_order_acquire);
    // The watch asks now and then; whoever is not exchanged although frames come back is gone, or as good as gone.
    const bool silent = now == Attendance::there && cycle->plan.slaves[slave].unit && statistics_.lost_in_a_row == 0 &&
                        cycle->health[slave].age >= config_.lost_frames_limit;
    return silent ? Attendance::away : now;
}

std::span<const AlarmFact> ProcessDataCycle::faults(BusPhase phase) const noexcept {
    if (phase != BusPhase::operational) return FaultFinder::facts_before_op(phase);
    const auto* cycle = latest_.load(std::memory_order_acquire);
    return cycle != nullptr ? cycle->faults.facts() : std::span<const AlarmFact>{};
}

Instant ProcessDataCycle::outputs_effective(std::size_t slave, Instant send_time) const noexcept {
    auto* cycle = latest_.load(std::memory_order_acquire);
    if (cycle == nullptr || slave >= cycle->slaves.size()) return send_time;
    if (const auto unit = cycle->plan.slaves[slave].unit) send_time += cycle->plan.units[*unit].cycles_until(cycle->number) * config_.cycle;
    const std::int64_t start = sync0_of(*cycle, slave);
    if (start == 0) return send_time;
    if (next_send_.send_time != send_time) next_send_ = {send_time, clock_.offset_at(send_time)};
    const std::int64_t arrival = nanoseconds(send_time) + cycle->slaves[slave].delay + next_send_.offset;
    return Instant{Duration{cycle->sync0[slave].next(arrival + 1, start, cycle->slaves[slave].period.count()) - next_send_.offset}};
}

}  // namespace taktwerk::ecat
