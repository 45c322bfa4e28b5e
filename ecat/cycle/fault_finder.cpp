#include "ecat/cycle/fault_finder.hpp"

#include <algorithm>
#include <tuple>

#include "ecat/alarms.hpp"
#include "ecat/cycle/cycle_link.hpp"

namespace taktwerk::ecat {

namespace {

/// How long after a slave was first seen out of OP what is then known still counts as what came before it.
constexpr std::uint8_t cycles_of_a_fall = 3;
/// Cycles without a reference time until it is said: a single outlier is no news, and a recovery takes a few.
constexpr std::uint32_t reference_times_limit = 50;
/// So many cycles the watch has to name who is missing before each slave speaks for itself.
constexpr std::uint32_t naming_cycles = 200;
constexpr std::uint32_t attempts_limit = 3;
/// A frame that got lost on one side of a ring is no break.
constexpr std::uint32_t broken_cycles = 2;
constexpr std::size_t facts_of_bus = 16, facts_of_slave = 6;  ///< room for more than can hold at once

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

/// To the microsecond.
double milliseconds(Duration d) noexcept { return static_cast<double>(d / std::chrono::microseconds{1}) / 1e3; }

bool in_op(const SlaveCondition& slave) noexcept { return slave.al_state == AlState::op && !slave.al_error; }

constexpr auto all_in_op = static_cast<std::uint16_t>(AlState::op);
/// Among these is one that a controller enters by its own restart.
bool some_in_init(std::uint16_t states) noexcept { return (states & static_cast<std::uint16_t>(AlState::init)) != 0; }

}  // namespace

FaultFinder::FaultFinder(std::vector<FaultSlave> slaves, std::uint16_t expected, std::uint32_t limit)
    : slaves_(std::move(slaves)),
      states_(slaves_.size()),
      order_(slaves_.size()),
      expected_(expected),
      limit_(limit),
      silence_(BusAlarm::frames_lost) {
    for (std::size_t i = 0; i < slaves_.size(); ++i) order_[slaves_[i].index] = i;
    facts_.reserve(facts_of_bus + facts_of_slave * slaves_.size());
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        auto& slave = slaves_[i];
        if (slave.alone()) continue;
        const auto known = std::find(numbers.begin(), numbers.end(), slave.unit);
        const auto number = static_cast<std::size_t>(known - numbers.begin());
        if (known == numbers.end()) {
            numbers.push_back(slave.unit);
            units_.emplace_back();
        }
        slave.unit = number;
        units_[number].members.push_back(i);
        units_[number].stops_machine = units_[number].stops_machine || slave.on_loss == LossPolicy::stop_machine;
    }
}

void FaultFinder::raise(BusAlarm alarm, AlarmSource source, std::size_t index, double a, double b) noexcept {
    if (facts_.size() < facts_.capacity()) facts_.push_back({id(alarm), source, static_cast<std::uint16_t>(index), a, b});
}

std::span<const AlarmFact> FaultFinder::facts_before_op(BusPhase phase) noexcept {
    static constexpr std::array failed{AlarmFact{id(BusAlarm::bringup_failed), AlarmSource::bus, 0, 0, 0}};
    static constexpr std::array not_there{AlarmFact{id(BusAlarm::bus_not_operational), AlarmSource::bus, 0, 0, 0}};
    return phase == BusPhase::failed ? failed : not_there;
}

void FaultFinder::look(const BusCondition& bus) noexcept {
    facts_.clear();
    look_at_slaves(bus);
    look_at_ring(bus);
    for (std::size_t s = 0; s < order_.size(); ++s) raise_emergency(s);
    const bool frames = std::none_of(facts_.begin(), facts_.end(), [](const AlarmFact& fact) {
        return fact.id == id(BusAlarm::link_down) || fact.id == id(BusAlarm::frames_lost);
    });
    if (frames && bus.out_of_lock) raise(BusAlarm::dc_not_locked, AlarmSource::bus, 0, static_cast<double>(bus.dc_phase_error_ns));
}

void FaultFinder::look_at_ring(const BusCondition& bus) noexcept {
    if (!bus.ring.needs_mending()) {
        broken_for_ = 0;
        return;
    }
    broken_for_ = std::min(broken_for_ + 1, broken_cycles);
    if (broken_for_ < broken_cycles) return;
    const auto& ring = bus.ring;
    const bool first = ring.shape == RingShape::first_silent, second = ring.shape == RingShape::second_silent;
    const std::uint16_t before = first ? std::uint16_t{0} : ring.before_break, behind = second ? std::uint16_t{0} : ring.behind_break;
    raise(BusAlarm::ring_broken, AlarmSource::bus, 0, before, behind);
    const auto reference = std::find_if(slaves_.begin(), slaves_.end(), [&](const FaultSlave& slave) {
        return bus.reference_station != 0 ? slave.station == bus.reference_station : slave.reference;
    });
    if (!bus.ramp_down || reference == slaves_.end()) return;
    // Each half counts those that answer, from its own end: who is gone stands between them.
    const auto from_first = [&](const FaultSlave& slave) { return slave.position < before; };
    const auto from_second = [&](const FaultSlave& slave) { return slave.position + behind >= expected_; };
    for (const auto& slave : slaves_)
        if (slave.synchronised && ((from_first(*reference) && from_second(slave)) || (from_second(*reference) && from_first(slave))))
            raise(BusAlarm::cut_off_from_reference, AlarmSource::slave, slave.index);
}

void FaultFinder::raise_emergency(std::size_t index) noexcept {
    const auto& seen = condition(index);
    if (seen.emergency_code != 0) raise(BusAlarm::slave_emergency, AlarmSource::slave, index, seen.emergency_code, seen.error_register);
}

void FaultFinder::look_at_slaves(const BusCondition& bus) noexcept {
    const bool silent = !bus.link_up || bus.lost_in_a_row >= limit_;
    if (silent) {
        if (bus.seen.has<BusAlarm::foreign_master>()) raise(BusAlarm::foreign_master, AlarmSource::bus, 0);
        // The first frames behind a link that is back are still those that it could not carry.
        linked_cycles_ = bus.link_up ? linked_cycles_ + 1 : 0;
        if (!bus.link_up) silence_ = BusAlarm::link_down;
        else if (linked_cycles_ > limit_ || !was_silent_) silence_ = BusAlarm::frames_lost;
        was_silent_ = true;
        silence_cycles_ = bus.lost_in_a_row;
        return raise(silence_, AlarmSource::bus, 0, silence_cycles_);
    }
    was_silent_ = false;
    note_falls(bus);
    const auto expected = static_cast<std::uint16_t>(expected_ + bus.guests);
    crowded_ = bus.slaves_answering > expected;
    uninvited_ = false;
    const std::size_t unnamed = find_lost(bus.slaves_answering, expected);
    form_groups();
    raise_falls(bus);
    raise_groups();
    raise_unnamed(unnamed, expected);
    raise_units();
    bool reference_gone = false;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        if (slaves_[i].reference) reference_gone = states_[i].fall.now();
        raise_slave(i, unnamed > 0);
    }
    if (uninvited_) raise(BusAlarm::newcomer_takes_part, AlarmSource::bus, 0);
    // What no frame brings back is no fault of the clock.
    const bool unasked = bus.lost_in_a_row > 0 || bus.gap >= bus.reference_times_missing;
    if (bus.reference_times_missing >= reference_times_limit && !reference_gone && !unasked)
        raise(BusAlarm::reference_clock_lost, AlarmSource::bus, 0, bus.reference_times_missing);
    if (bus.seen.has<BusAlarm::stranger_plugged_in>()) raise(BusAlarm::stranger_plugged_in, AlarmSource::bus, 0, bus.guests);
    if (bus.dc_difference_ns > clock_is_off_ns)
        raise(BusAlarm::dc_out_of_sync, AlarmSource::bus, 0, static_cast<double>(bus.dc_difference_ns));
}

// The broadcast says that somebody is out of OP before the watch has asked who: a slave that is not exchanged then is the one.
void FaultFinder::note_falls(const BusCondition& bus) noexcept {
    const bool somebody_fell = bus.states != 0 && bus.states != all_in_op;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        const auto& seen = states_[i].seen;
        Fall& fall = states_[i].fall;
        states_[i].stale_in_op = stale(states_[i]) && (states_[i].stale_in_op || (in_op(seen) && bus.states == all_in_op));
        const bool unread = in_op(seen) && somebody_fell && slaves_[i].alone() && stale(states_[i]) && seen.age < limit_ + naming_cycles;
        if (in_op(seen) && !unread) {
            fall = {};
            continue;
        }
        // What it came behind is known with it; what comes later is no cause.
        if (fall.cycles_down < cycles_of_a_fall) {
            ++fall.cycles_down;
            if (fall.stall == Duration{}) fall.stall = bus.stall;
            fall.gap = std::max(fall.gap, bus.gap);
        }
        if (seen.presence == Presence::silent && (slaves_[i].exchanges ? seen.age > 0 : some_in_init(bus.states))) fall.restarted = true;
        if (seen.al_status_code != 0) fall.code = seen.al_status_code;
        if (unread) {
            fall.by_command = (bus.states & al_status_error) == 0 && !some_in_init(bus.states);
        } else if (!fall.read && seen.presence == Presence::answers && seen.al_state != AlState::unknown) {
            fall.read = true;
            fall.by_command = !seen.al_error && seen.al_status_code == 0 && !seen.taken_down;
        }
    }
}

bool FaultFinder::lost_synchronisation(const Fall& fall) noexcept {
    constexpr std::uint16_t watchdog = 0x001B;
    return fall.read && fall.code != watchdog;
}

std::uint32_t FaultFinder::explaining_gap(std::size_t at) const noexcept {
    constexpr std::uint32_t least_gap = 2;
    return std::min(limit_, lost_synchronisation(states_[at].fall) ? least_gap : slaves_[at].watchdog_cycles);
}

Duration FaultFinder::explaining_stall(std::size_t at) const noexcept {
    constexpr Duration any{1};
    return lost_synchronisation(states_[at].fall) ? any : std::max(any, slaves_[at].watchdog);
}

bool FaultFinder::stuck(const SlaveCondition& slave) noexcept {
    return slave.presence == Presence::answers && !in_op(slave) &&
           (slave.trouble == ReturnTrouble::other_device || (slave.trouble == ReturnTrouble::refused && slave.attempts >= attempts_limit));
}

FaultFinder::Fallen* FaultFinder::fallen_with(std::size_t at) noexcept {
    const State& state = states_[at];
    const Fall& fall = state.fall;
    if (!fall.now() || fall.restarted || stuck(state.seen) || state.gone_with != FaultSlave::none || !(fall.read || stale(state)))
        return nullptr;
    const std::size_t policy = slaves_[at].on_loss == LossPolicy::stop_own_axes ? 1 : 0;
    const bool wanted_frames = fall.read ? for_want_of_frames(fall.code) : !fall.by_command;
    // Until its code is known a stall of any length counts, unless frames were lost for longer.
    const bool starved = fall.stall >= explaining_stall(at) || (!fall.read && fall.stall > Duration{} && fall.gap < explaining_gap(at));
    if (wanted_frames && starved) return &starved_[policy];
    // Short of the limit lost frames stop nobody who may drop out; the reason of one who does stands in its own alarm.
    const bool explained = fall.gap >= explaining_gap(at) && (policy == 0 || fall.gap >= limit_);
    if (wanted_frames && explained) return &silenced_;
    return fall.by_command ? &commanded_[policy] : nullptr;
}

void FaultFinder::raise_falls(const BusCondition& bus) noexcept {
    const std::array groups{&starved_[0], &starved_[1], &commanded_[0], &commanded_[1], &silenced_};
    for (auto* group : groups) group->count = 0;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
        auto* group = fallen_with(i);
        if (group == nullptr) continue;
        ++group->count;
        group->stall = std::max(group->stall, states_[i].fall.stall);
        group->gap = std::max(group->gap, states_[i].fall.gap);
    }
    for (auto* group : groups) {
        if (group->count == 0) *group = {};
        group->most = std::max(group->most, group->count);
    }
    // Who commands slaves is named with them: he is not told twice.
    const bool commanded = commanded_[0].count + commanded_[1].count > 0;
    if (bus.seen.has<BusAlarm::foreign_master>() && !commanded) raise(BusAlarm::foreign_master, AlarmSource::bus, 0);
    constexpr std::array starved_alarms{BusAlarm::starved_slave_left_op, BusAlarm::starved_slave_dropped_out};
    constexpr std::array commanded_alarms{BusAlarm::foreign_command, BusAlarm::foreign_command_tolerated};
    for (std::size_t policy = 0; policy < 2; ++policy) {
        const auto& starved = starved_[policy];
        if (starved.count > 0)
            raise(starved_alarms[policy], AlarmSource::bus, 0, milliseconds(starved.stall), static_cast<double>(starved.most));
        const auto& sent = commanded_[policy];
        if (sent.count > 0) raise(commanded_alarms[policy], AlarmSource::bus, 0, static_cast<double>(sent.most));
    }
    if (silenced_.count > 0) raise(silence_, AlarmSource::bus, 0, silenced_.gap, static_cast<double>(silenced_.most));
    else if (bus.gap == 0) silence_ = BusAlarm::frames_lost;
}

std::size_t FaultFinder::find_lost(std::uint16_t answering, std::uint16_t expected) noexcept {
    const std::size_t missing = answering < expected ? std::size_t{expected} - answering : 0;
    // Who came back and has no address yet is silent, too, and is not the one who is missing now: unless nobody else turns up.
    const bool waited = missing == missing_ && naming_for_ >= naming_cycles;
    std::size_t silent = 0, suspect = 0;
    for (auto& state : states_) {
        state.counted = state.seen.presence == Presence::silent && (state.counted || missing == 0);
        silent += state.seen.presence == Presence::silent && (!state.counted || waited);
        suspect += state.seen.presence == Presence::silent || stale(state);
    }
    // When exactly as many are not exchanged as are missing, they are the missing ones: no need to wait for the watch.
    const bool suspects_are_missing = suspect == missing;
    const std::size_t named = suspects_are_missing ? suspect : silent;
    const std::size_t unnamed = missing > named ? missing - named : 0;
    naming_for_ = missing == missing_ ? std::min(naming_for_ + 1, naming_cycles) : 0;
    missing_ = missing;
    naming_ = unnamed > 0 && naming_for_ < naming_cycles;
    for (auto& state : states_) {
        const bool silent_now = state.seen.presence == Presence::silent && (!state.counted || waited);
        const bool gone = missing > 0 && (silent_now || (suspects_are_missing && stale(state)));
        state.lost = gone && (!naming_ || state.gone_with != FaultSlave::none);
    }
    return unnamed;
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
        } else if ((in_op(state.seen) && !stale(state)) || stuck(state.seen) || replaced(state)) {
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
        if (first.group == 0 || slaves_[i].guest) continue;
        const bool branch = first.largest_group > 1;
        const BusAlarm alarm = branch ? (first.group_stops_machine ? BusAlarm::cable_broken : BusAlarm::branch_dropped_out)
                                      : (first.group_stops_machine ? BusAlarm::slave_lost : BusAlarm::slave_dropped_out);
        const auto [most, away] = std::pair{static_cast<double>(first.largest_group), static_cast<double>(first.group)};
        raise(alarm, AlarmSource::slave, slaves_[i].index, branch ? most : 0, branch ? away : 0);
    }
}

void FaultFinder::raise_unnamed(std::size_t unnamed, std::uint16_t expected) noexcept {
    if (unnamed == 0) return;
    for (std::size_t i = 0; i < slaves_.size(); ++i)
        if (stale(states_[i]) && states_[i].gone_with == FaultSlave::none && slaves_[i].on_loss == LossPolicy::stop_machine)
            return raise(BusAlarm::slaves_missing, AlarmSource::bus, 0, static_cast<double>(missing_), expected);
}

void FaultFinder::raise_slave(std::size_t at, bool counted_out) noexcept {
    const auto& slave = slaves_[at];
    const State& state = states_[at];
    const auto& seen = state.seen;
    const bool tolerated = slave.on_loss == LossPolicy::stop_own_axes;
    if (seen.seen.has<BusAlarm::group_does_not_join>()) raise(BusAlarm::group_does_not_join, AlarmSource::slave, slave.index);
    if (slave.guest && (seen.presence == Presence::silent || state.fall.restarted)) return;  // it is gone, or just coming
    if (seen.trouble == ReturnTrouble::other_device) {
        raise(tolerated ? BusAlarm::other_device_tolerated : BusAlarm::other_device, AlarmSource::slave, slave.index);
        return;
    }
    if (seen.trouble == ReturnTrouble::refused && seen.attempts >= attempts_limit)
        raise(BusAlarm::slave_does_not_return, AlarmSource::slave, slave.index, seen.attempts);
    if (state.gone_with != FaultSlave::none) return;  // said with the cable, or it is just coming back
    if (fallen_with(at) != nullptr) return;           // said with what took it down
    if (seen.seen.has<BusAlarm::mailbox_silent>()) raise(BusAlarm::mailbox_silent, AlarmSource::slave, slave.index);

    if (const auto& cable = seen.cable; cable.lost_links > 0)
        raise(BusAlarm::cable_loses_link, AlarmSource::slave, slave.index, cable.lost_links, cable.port);
    else if (cable.errors > 0) raise(BusAlarm::cable_errors, AlarmSource::slave, slave.index, cable.errors, cable.port);

    // Probably one of those who are just being named.
    const bool waits = naming_ || (counted_out && seen.age < limit_ + naming_cycles);
    if (stuck(seen)) {
        raise_left_op(at);
    } else if (seen.presence == Presence::silent) {
        // Only who exchanges in this very cycle has power and cable, and lost nothing but its address.
        if (seen.age == 0 && !state.fall.restarted) raise(BusAlarm::station_address_lost, AlarmSource::slave, slave.index);
        else if ((stale(state) || !slave.exchanges) && !naming_)
            raise(tolerated ? BusAlarm::slave_dropped_out : BusAlarm::slave_lost, AlarmSource::slave, slave.index);
    } else if (seen.presence == Presence::answers && seen.taken_down && (state.fall.now() || stale(state))) {
        raise_not_exchanged(at);
    } else if (seen.presence == Presence::answers && fell_unexchanged(state)) {
        raise_not_exchanged(at);
    } else if (seen.presence == Presence::answers && state.fall.restarted) {
        raise(tolerated ? BusAlarm::slave_dropped_out : BusAlarm::slave_lost, AlarmSource::slave, slave.index);  // until it is back in OP
    } else if (seen.presence == Presence::answers && state.fall.now()) {
        if (state.fall.read || !naming_) raise_left_op(at);
    } else if (stale(state) && !waits && slave.alone()) {
        raise_not_exchanged(at);
    }
}

bool FaultFinder::fell_unexchanged(const State& state) noexcept {
    return state.stale_in_op && state.fall.now() && (!state.fall.read || for_want_of_frames(state.fall.code));
}

bool FaultFinder::is_out(const State& state) const noexcept {
    const auto& seen = state.seen;
    return state.gone_with != FaultSlave::none || state.fall.now() || seen.presence == Presence::silent || seen.taken_down || stuck(seen);
}

void FaultFinder::raise_units() noexcept {
    if (naming_) return;  // somebody is missing: probably one of them
    const auto stale_unit = [this](const SharedUnit& unit) {
        return std::any_of(unit.members.begin(), unit.members.end(), [this](std::size_t at) { return stale(states_[at]); });
    };
    if (crowded_) {
        uninvited_ = uninvited_ || std::any_of(units_.begin(), units_.end(), stale_unit);
        return;
    }
    for (const auto& unit : units_) {
        std::uint32_t age = 0;
        bool known = false;
        for (const std::size_t at : unit.members) {
            age = std::max(age, states_[at].seen.age);
            known = known || is_out(states_[at]);
        }
        if (known || age < limit_) continue;
        raise(unit.stops_machine ? BusAlarm::sync_unit_not_exchanged : BusAlarm::sync_unit_dropped_out, AlarmSource::bus,
              slaves_[unit.members.front()].index, static_cast<double>(unit.members.size()), age);
    }
}

void FaultFinder::raise_not_exchanged(std::size_t at) noexcept {
    if (crowded_) {
        uninvited_ = true;
        return;
    }
    const auto& slave = slaves_[at];
    if (slave.on_loss == LossPolicy::stop_own_axes) return raise_left_op(at);
    raise(BusAlarm::working_counter_wrong, AlarmSource::slave, slave.index, states_[at].seen.age);
}

void FaultFinder::raise_left_op(std::size_t at) noexcept {
    const auto& slave = slaves_[at];
    const auto& [seen, fall] = std::tie(states_[at].seen, states_[at].fall);
    const bool tolerated = slave.on_loss == LossPolicy::stop_own_axes;
    raise(tolerated ? BusAlarm::slave_dropped_out : BusAlarm::slave_left_op, AlarmSource::slave, slave.index,
          fall.read ? static_cast<double>(seen.al_state) : 0, fall.code);
}

}  // namespace taktwerk::ecat
