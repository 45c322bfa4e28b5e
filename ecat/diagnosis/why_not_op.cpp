#include "ecat/diagnosis/why_not_op.hpp"

#include <algorithm>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/presence.hpp"

namespace taktwerk::ecat {

namespace {

/// The bring-up goes one step at a time: what was asked of a slave that stopped is the next state.
AlState next_state(AlState reached) noexcept {
    switch (reached) {
        case AlState::preop: return AlState::safeop;
        case AlState::safeop:
        case AlState::op: return AlState::op;
        default: return AlState::preop;
    }
}

Script<void> examine(Bus& bus, BusSlave& slave, WhySlave& why, const Error& failure) {
    why.subject = slave.subject;
    why.position = slave.found.position;
    if (slave.away()) {  // it comes and goes as it likes
        why.answers = false;
        co_return;
    }
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    why.answers = status.ok();
    if (!status) {
        why.failed = true;
        why.cause = "it does not answer: no power, a cable before it, or it was power-cycled and lost its station address";
        why.remedy = "check its power and the cable before it (`bus scan`, `bus counters`)";
        co_return;
    }
    why.state = al_state(*status);
    why.al_error = (*status & al_status_error) != 0;
    why.al_code = static_cast<std::uint16_t>(slave.link.al.load() >> 16);
    const bool named = failure.subject == slave.subject;
    why.failed = named || why.al_error || slave.refusal.has_value();
    if (!why.failed) co_return;
    if (slave.refusal) {
        why.facts = slave.refusal;
        why.cause = slave.refusal->cause;
        why.remedy = slave.refusal->remedy;
        co_return;
    }
    // No state was refused: an SDO was, or what the slave says of its PDOs is not what was asked for.
    why.facts = co_await read_refusal(bus, slave, next_state(why.state));
    why.cause = named ? failure.what : why.facts->cause;
    why.remedy = named ? failure.remedy : why.facts->remedy;
}

/// Who stands behind a slave that is away is away with it, and to blame for nothing.
void blame_the_first_silent(const Bus& bus, WhyReport& report) {
    const auto& places = bus.topology.slaves;
    const auto silent_at = [&](std::size_t position) {
        return std::any_of(report.slaves.begin(), report.slaves.end(),
                           [&](const WhySlave& slave) { return slave.position == position && !slave.answers; });
    };
    const bool nobody = std::none_of(report.slaves.begin(), report.slaves.end(), [](const WhySlave& slave) { return slave.answers; });
    for (std::size_t i = 0; i < report.slaves.size(); ++i) {
        auto& slave = report.slaves[i];
        if (slave.answers || bus.slaves[i]->away()) continue;
        const bool behind = slave.position < places.size() && places[slave.position].parent && silent_at(*places[slave.position].parent);
        if (behind || (nobody && report.failure.subject == "bus")) slave.failed = false;
        const bool named = report.failure.subject == slave.subject;
        if (named) slave.cause = report.failure.what, slave.remedy = report.failure.remedy;
        else if (const auto cable = connection_text(bus, *bus.slaves[i]); !cable.empty()) slave.cause += "; " + cable;
    }
}

}  // namespace

Script<Result<WhyReport>> explain(Bus& bus, Error failure) {
    WhyReport report;
    report.failure = std::move(failure);
    report.notes = bus.notes;
    report.slaves.resize(bus.slaves.size());
    std::vector<Script<void>> scripts;
    for (std::size_t i = 0; i < bus.slaves.size(); ++i) scripts.push_back(examine(bus, *bus.slaves[i], report.slaves[i], report.failure));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    blame_the_first_silent(bus, report);
    // Nobody waits for a group that is not plugged in.
    std::erase_if(report.slaves, [](const WhySlave& slave) { return slave.position == not_on_the_cable && !slave.answers; });
    if (report.failure.code == "bus.foreign_master")
        for (auto& slave : report.slaves) slave.failed = false;  // it is not they
    co_return report;
}

}  // namespace taktwerk::ecat
