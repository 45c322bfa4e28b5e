#include "runtime/tasks/watched_groups.hpp"

#include <algorithm>

#include "runtime/tasks/program_record.hpp"

namespace taktwerk::runtime {

using axes::ErrorId;

/// The view says where, of the last one alone.
CommandEvent WatchedGroups::event_of(std::size_t group, const CommandGiver& giver, ErrorId error, axes::CommandId id) const noexcept {
    const auto& view = groups_[group].view();
    CommandEvent event;
    event.axis = axes::AxisRef{}.index;
    event.group = static_cast<std::uint16_t>(group);
    event.given = giver;
    event.error = error;
    event.axis_error = view.state == axes::GroupState::GroupErrorStop ? view.error : std::uint16_t{0};
    if (view.refusal.id == id && view.refusal.why.error == error) event.place = view.refusal.why;
    return event;
}

axes::Submitted WatchedGroups::submit(axes::GroupRef group, const axes::GroupCommand& command, axes::Owner owner,
                                      std::uint16_t program) noexcept {
    const auto answer = groups_.submit(group, command, owner);
    if (group.index >= places_.size()) return answer;
    CommandGiver giver;
    giver.group_kind = command.kind;
    giver.owner = owner;
    giver.program = program;
    giver.block = command.instance;
    if (answer.error != ErrorId::none) {
        axes_.note(event_of(group.index, giver, answer.error, 0));
        return answer;
    }
    auto& place = places_[group.index];
    place.given[place.next] = {answer.id, giver};
    place.next = static_cast<std::uint8_t>((place.next + 1) % place.given.size());
    return answer;
}

void WatchedGroups::end_of_cycle(bool everything_ends, const ProgramRecords& programs) noexcept {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        auto& place = places_[i];
        const auto& view = groups_[i].view();
        for (; place.ledger != view.ledger_next; place.ledger = static_cast<std::uint8_t>((place.ledger + 1) % view.ledger.size())) {
            const auto& over = view.ledger[place.ledger];
            // What waited behind an error ended with it: that one is told.
            if (over.outcome != axes::Outcome::error || over.error == ErrorId::aborted_by_axis_error) continue;
            const auto given = std::find_if(place.given.begin(), place.given.end(), [&](const Given& g) { return g.id == over.id; });
            if (over.id == 0 || given == place.given.end()) continue;
            const auto program = given->giver.program;
            if (everything_ends || (program < programs.size() && !programs[program].running())) continue;
            auto event = event_of(i, given->giver, over.error, over.id);
            // What stopped the group stands beside this as an alarm, or is the group's error: the command did not fail by itself.
            const bool stopped = event.axis_error != 0 && static_cast<std::uint16_t>(over.error) == event.axis_error;
            if (stopped) event.what = CommandEvent::What::aborted;
            axes_.note(event);
        }
    }
}

}  // namespace taktwerk::runtime
