#include "ecat/sim/faults.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/nearest_name.hpp"

namespace taktwerk::ecat::sim {

namespace {
constexpr std::string_view master_end = "master";  // where a slave's name stands: the cable at the master's own port
constexpr std::string_view ring_end = "ring";      // that at its second one
}  // namespace

Result<SimSlave*> FaultInjector::find(const std::string& name) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < network_.size(); ++i) {
        names.push_back(network_.slave(i).options().name);
        if (names.back() == name) return &network_.slave(i);
    }
    const auto near = nearest_name(name, names);
    std::string list;
    for (const auto& known : names) list += (list.empty() ? "" : ", ") + known;
    return Error{"fault.no_slave", name, "there is no such slave on this bus",
                 near.empty() ? fmt::format("choose one of {}", list) : fmt::format("did you mean '{}'?", near)};
}

Result<void> FaultInjector::apply(const Fault& fault, Instant now) {
    if (fault.after <= Duration::zero()) return happen(fault, now);
    // A name that does not exist is told at once, not in an hour.
    if (!fault.slave.empty() && fault.slave != master_end && fault.slave != ring_end)
        if (const auto slave = find(fault.slave); !slave) return slave.error();
    waiting_.push_back({fault, now + fault.after});
    waiting_.back().fault.after = Duration::zero();
    return {};
}

Result<void> FaultInjector::happen(const Fault& fault, Instant now) {
    switch (fault.kind) {
        case FaultKind::drop: cable_.drop_requests = fault.count; return {};
        case FaultKind::drop_answers: cable_.drop_answers = fault.count; return {};
        case FaultKind::duplicate: cable_.duplicate_answers = fault.count; return {};
        case FaultKind::delay:
            cable_.delay = fault.time;
            cable_.delay_answers = fault.count;
            return {};
        case FaultKind::reorder: cable_.reorder_answers = fault.count; return {};
        case FaultKind::corrupt:
            cable_.corrupt_bit = fault.bit;
            cable_.corrupt_answers = fault.count;
            return {};
        case FaultKind::unplug:
        case FaultKind::plug:
            if (fault.slave == master_end) {
                cable_.link_down = fault.kind == FaultKind::unplug;
                if (network_.size() > 0) network_.set_cable(0, !cable_.link_down);
                return {};
            }
            if (fault.slave == ring_end) {
                network_.set_ring_cable(fault.kind == FaultKind::plug);
                return {};
            }
            break;
        default: break;
    }
    const auto slave = find(fault.slave);
    if (!slave) return slave.error();
    return happen_to(**slave, fault, now);
}

Result<void> FaultInjector::happen_to(SimSlave& slave, const Fault& fault, Instant now) {
    const bool talks = slave.description().mailbox.has_value();
    const auto no_mailbox = [&] {
        return Error{"fault.no_mailbox", fault.slave, "this slave has no mailbox", "choose a slave that answers SDOs"};
    };
    switch (fault.kind) {
        case FaultKind::unplug: network_.set_cable(slave, false); break;
        case FaultKind::plug: network_.set_cable(slave, true); break;
        case FaultKind::power_off: network_.set_power(slave, false); break;
        case FaultKind::power_on: network_.set_power(slave, true); break;
        case FaultKind::power_cycle:
            network_.set_power(slave, false);
            waiting_.push_back({Fault{.kind = FaultKind::power_on, .slave = fault.slave}, now + fault.time});
            break;
        case FaultKind::noise: network_.disturb(slave, fault.count); break;
        case FaultKind::stick_mailbox:
            if (!talks) return no_mailbox();
            slave.stick_mailbox(fault.on);
            break;
        case FaultKind::wrong_length:
            if (!talks) return no_mailbox();
            slave.answer_with_wrong_lengths(fault.count);
            break;
        case FaultKind::refuse: slave.refuse_state(fault.state, fault.on ? fault.al_code : std::uint16_t{0}); break;
        case FaultKind::abort:
            if (!talks) return no_mailbox();
            slave.abort_object(fault.index, fault.sub, fault.on ? fault.abort_code : 0u);
            break;
        case FaultKind::hang: slave.hang(fault.on); break;
        case FaultKind::drift: slave.controller().set_clock_drift(fault.drift_ppm, now); break;
        case FaultKind::clock_step: slave.controller().step_clock(fault.time, now); break;
        case FaultKind::forget_address: slave.controller().forget_station_address(); break;
        case FaultKind::drop:
        case FaultKind::drop_answers:
        case FaultKind::duplicate:
        case FaultKind::delay:
        case FaultKind::reorder:
        case FaultKind::corrupt: break;  // apply() knows them
    }
    return {};
}

void FaultInjector::step(Instant now) {
    while (next_event() <= now) {
        const auto first =
            std::min_element(waiting_.begin(), waiting_.end(), [](const Waiting& a, const Waiting& b) { return a.at < b.at; });
        const Waiting due = *first;
        waiting_.erase(first);
        (void)happen(due.fault, due.at);  // its slave was looked up when it was asked for
    }
}

Instant FaultInjector::next_event() const noexcept {
    Instant next = never;
    for (const auto& waiting : waiting_) next = std::min(next, waiting.at);
    return next;
}

}  // namespace taktwerk::ecat::sim
