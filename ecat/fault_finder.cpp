#include "ecat/fault_finder.hpp"

#include <algorithm>

#include "ecat/alarms.hpp"

namespace taktwerk::ecat {

namespace {

/// How long after a slave was first seen out of OP a stall of this computer still counts as what came before it.
constexpr std::uint8_t cycles_of_a_fall = 3;
constexpr std::int64_t sync_limit_ns = 3000;  // SV33-E P0A.32 default
/// Cycles without a reference time until it is said: a single outlier is no news, and a recovery takes a few.
constexpr std::uint32_t reference_times_limit = 50;
/// So many cycles the watch has to name who is missing before each slave speaks for itself.
constexpr std::uint32_t naming_cycles = 200;
constexpr std::uint32_t attempts_limit = 3;
constexpr std::size_t facts_of_bus = 6, facts_of_slave = 4;

/// AL status codes by which a slave says that frames or SYNC0 and frames did not come as they should (ETG.1000.6 table 11).
bool for_want_of_frames(std::uint16_t code) noexcept {
    switch (code) {
        case 0x001A:               // synchronization error
        case 0x001B:               // sync manager watchdog
        case 0x002C:               // fatal synchronization error
        case 0x0032:               // PLL error
        case 0x0033:               // DC sync input/output error
        case 0x0034: return true;  // DC sync timeout
        default: return false;
    }
}

double milliseconds(Duration d) noexcept { return to_seconds(d) * 1e3; }

bool in_op(const SlaveCondition& slave) noexcept { return slave.al_state == AlState::op && !slave.al_error; }

}  // namespace

std::vector<FaultSlave> fault_slaves(const Bus& bus) {
    std::vector<FaultSlave> slaves;
    for (const auto& slave : bus.slaves)
        slaves.push_back({slave->index, FaultSlave::none, slave->config->on_loss, bus.reference == slave->index});
    const auto position = [&](const FaultSlave& s) { return std::size_t{bus.slaves[s.index]->found.position}; };
    std::sort(slaves.begin(), slaves.end(), [&](const FaultSlave& a, const FaultSlave& b) { return position(a) < position(b); });
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        if (position(slaves[i]) >= bus.topology.slaves.size()) {  // the tree could not be read: take it for a line
            if (i > 0) slaves[i].parent = i - 1;
            continue;
        }
        for (auto up = bus.topology.slaves[position(slaves[i])].parent; up && slaves[i].parent == FaultSlave::none;
             up = bus.topology.slaves[*up].parent)
            for (std::size_t k = 0; k < i; ++k)
                if (position(slaves[k]) == *up) slaves[i].parent = k;
    }
    return slaves;
}

FaultFinder::FaultFinder(std::vector<FaultSlave> slaves, std::uint16_t expected, std::uint32_t limit)
    : slaves_(std::move(slaves)), states_(slaves_.size()), order_(slaves_.size()), expected_(expected), limit_(limit) {
    for (std::size_t i = 0; i < slaves_.size(); ++i) order_[slaves_[i].index] = i;
    facts_.reserve(facts_of_bus + facts_of_slave * slaves_.size());
}

void FaultFinder::raise(AlarmId id, AlarmSource source, std::size_t index, double a, double b) noexcept {
    if (facts_.size() < facts_.capacity()) facts_.push_back({id, source, static_cast<std::uint16_t>(index), a, b});
}

void FaultFinder::look(const BusCondition& bus) noexcept {
    facts_.clear();
    if (bus.foreign_master) raise(alarm::foreign_master, AlarmSource::bus, 0);
    if (!bus.link_up) return raise(alarm::link_down, AlarmSource::bus, 0);
    if (bus.lost_in_a_row >= limit_) return raise(alarm::frames_lost, AlarmSource::bus, 0, bus.lost_in_a_row);

    for (auto& state : states_) {
        if (in_op(state.seen)) {
            state.fell_after_stall = {};
            state.fell_code = 0;
            state.cycles_down = 0;
            continue;
        }
        // What the fall came behind is known with it or right after it (a stall is noted when the next frame leaves); what comes later is no cause.
        if (state.cycles_down < cycles_of_a_fall) {
            ++state.cycles_down;
            if (state.fell_after_stall == Duration{}) state.fell_after_stall = bus.stall;
        }
        if (state.seen.al_status_code != 0) state.fell_code = state.seen.al_status_code;
    }
    const std::size_t unnamed = find_lost(bus.slaves_answering);
    form_groups();
    raise_groups();
    raise_unnamed(unnamed);
    bool reference_gone = false;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        if (slaves_[i].reference) reference_gone = !in_op(states_[i].seen);
        raise_slave(i, unnamed > 0);
    }
    if (bus.reference_times_missing >= reference_times_limit && !reference_gone)
        raise(alarm::reference_clock_lost, AlarmSource::bus, 0, bus.reference_times_missing);
    if (bus.dc_difference_ns > sync_limit_ns) raise(alarm::dc_out_of_sync, AlarmSource::bus, 0, static_cast<double>(bus.dc_difference_ns));
}

std::size_t FaultFinder::find_lost(std::uint16_t answering) noexcept {
    const std::size_t missing = answering < expected_ ? std::size_t{expected_} - answering : 0;
    std::size_t silent = 0, suspect = 0;
    for (const auto& state : states_) {
        silent += state.seen.presence == Presence::silent;
        suspect += state.seen.presence == Presence::silent || stale(state);
    }
    // When exactly as many are not exchanged as are missing, they are the missing ones: no need to wait for the watch.
    const bool suspects_are_missing = suspect == missing;
    for (auto& state : states_)
        state.lost = missing > 0 && (state.seen.presence == Presence::silent || (suspects_are_missing && stale(state)));
    const std::size_t named = suspects_are_missing ? suspect : silent;
    return missing > named ? missing - named : 0;
}

void FaultFinder::form_groups() noexcept {
    for (auto& state : states_) {
        state.group = 0;
        state.group_stops_machine = false;
    }
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        State& state = states_[i];
        if (state.lost) {
            const std::size_t parent = slaves_[i].parent;
            state.gone_with = parent != FaultSlave::none && states_[parent].lost ? states_[parent].gone_with : i;
        } else if (in_op(state.seen) && !stale(state)) {
            state.gone_with = FaultSlave::none;
        }
        if (state.gone_with == FaultSlave::none) continue;
        State& first = states_[state.gone_with];
        ++first.group;
        first.group_stops_machine = first.group_stops_machine || slaves_[i].on_loss == LossPolicy::stop_machine;
    }
    for (auto& state : states_) state.largest_group = state.group == 0 ? 0 : std::max(state.largest_group, state.group);
}

void FaultFinder::raise_groups() noexcept {
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        const State& first = states_[i];
        if (first.group == 0) continue;
        const bool branch = first.largest_group > 1;
        const AlarmId id = branch ? (first.group_stops_machine ? alarm::cable_broken : alarm::branch_dropped_out)
                                  : (first.group_stops_machine ? alarm::slave_lost : alarm::slave_dropped_out);
        raise(id, AlarmSource::slave, slaves_[i].index, branch ? static_cast<double>(first.group) : 0);
    }
}

void FaultFinder::raise_unnamed(std::size_t unnamed) noexcept {
    if (unnamed == 0) return;
    for (std::size_t i = 0; i < slaves_.size(); ++i)
        if (stale(states_[i]) && states_[i].gone_with == FaultSlave::none && slaves_[i].on_loss == LossPolicy::stop_machine)
            return raise(alarm::slaves_missing, AlarmSource::bus, 0, static_cast<double>(unnamed), expected_);
}

void FaultFinder::raise_slave(std::size_t at, bool counted_out) noexcept {
    const auto& slave = slaves_[at];
    const State& state = states_[at];
    const auto& seen = state.seen;
    const bool tolerated = slave.on_loss == LossPolicy::stop_own_axes;
    if (seen.trouble == ReturnTrouble::other_device) {
        raise(tolerated ? alarm::other_device_tolerated : alarm::other_device, AlarmSource::slave, slave.index);
        return;
    }
    if (seen.trouble == ReturnTrouble::refused && seen.attempts >= attempts_limit)
        raise(alarm::slave_does_not_return, AlarmSource::slave, slave.index, seen.attempts);
    if (state.gone_with != FaultSlave::none) return;  // said with the cable, or it is just coming back
    if (seen.mailbox_silent) raise(alarm::mailbox_silent, AlarmSource::slave, slave.index);

    const bool waits = counted_out && seen.age < limit_ + naming_cycles;  // probably one of those who are just being named
    if (seen.presence == Presence::silent) {
        // Only who exchanges in this very cycle has power and cable, and lost nothing but its address.
        if (seen.age == 0) raise(alarm::station_address_lost, AlarmSource::slave, slave.index);
        else if (stale(state)) raise(tolerated ? alarm::slave_dropped_out : alarm::slave_lost, AlarmSource::slave, slave.index);
    } else if (seen.presence == Presence::answers && !in_op(seen)) {
        raise_left_op(at);
    } else if (stale(state) && !waits) {
        if (tolerated) raise_left_op(at);
        else raise(alarm::working_counter_wrong, AlarmSource::slave, slave.index, seen.age);
    }
}

void FaultFinder::raise_left_op(std::size_t at) noexcept {
    const auto& slave = slaves_[at];
    const auto& seen = states_[at].seen;
    const bool tolerated = slave.on_loss == LossPolicy::stop_own_axes;
    const Duration stall = states_[at].fell_after_stall;
    const std::uint16_t code = states_[at].fell_code;
    if (stall > Duration{} && for_want_of_frames(code)) {
        raise(tolerated ? alarm::starved_slave_dropped_out : alarm::starved_slave_left_op, AlarmSource::slave, slave.index, code,
              milliseconds(stall));
        return;
    }
    raise(tolerated ? alarm::slave_dropped_out : alarm::slave_left_op, AlarmSource::slave, slave.index, static_cast<double>(seen.al_state),
          code);
}

}  // namespace taktwerk::ecat
