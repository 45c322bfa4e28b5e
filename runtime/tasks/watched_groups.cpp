#include "runtime/tasks/watched_groups.hpp"

#include <algorithm>
#include <utility>

#include "runtime/tasks/program_record.hpp"

namespace taktwerk::runtime {

using axes::ErrorId;
using axes::GroupCommandKind;

namespace {

bool aborted(const axes::GroupView& view, axes::CommandId id) noexcept { return view.status(id) == axes::CommandStatus::aborted; }

/// Who gives one of these to his own command wants that.
bool stops(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::halt || kind == GroupCommandKind::stop || kind == GroupCommandKind::disable ||
           kind == GroupCommandKind::interrupt;
}

}  // namespace

/// The view says where, of the last one alone.
CommandEvent WatchedGroups::event_of(std::size_t group, const CommandGiver& giver, ErrorId error, axes::CommandId id) const noexcept {
    const auto& view = groups_[group].view();
    CommandEvent event;
    event.axis = axes::AxisRef{}.index;
    event.group = static_cast<std::uint16_t>(group);
    event.given = giver;
    event.error = error;
    if (view.state == axes::GroupState::GroupErrorStop) {
        event.axis_error = view.error;
        if (view.has(view.error_place)) event.error_axis = view.members[view.error_place].index;
    }
    if (view.refusal.id == id && view.refusal.why.error == error) event.place = view.refusal.why;
    return event;
}

const CommandGiver* WatchedGroups::giver_of(const Place& place, axes::CommandId id) noexcept {
    const auto given = std::find_if(place.given.begin(), place.given.end(), [&](const Given& g) { return g.id == id; });
    return id == 0 || given == place.given.end() ? nullptr : &given->giver;
}

void WatchedGroups::note_aborted(std::size_t group, axes::CommandId id, const CommandGiver& by) noexcept {
    const auto* loser = giver_of(places_[group], id);
    if (loser == nullptr) return;
    auto event = event_of(group, *loser, ErrorId::none, id);
    event.what = CommandEvent::What::aborted;
    event.by = by;
    axes_.note(event);
}

axes::Submitted WatchedGroups::submit(axes::GroupRef group, const axes::GroupCommand& command, axes::Owner owner,
                                      std::uint16_t program) noexcept {
    if (group.index >= places_.size()) return groups_.submit(group, command, owner);
    const auto before = groups_[group.index].view().active;
    const bool held = groups_[group.index].view().held;
    const auto answer = groups_.submit(group, command, owner);
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
    // A person was told that it comes to rest and stays there: he has to hear who moves it all the same.
    if (held && !groups_[group.index].view().held) {
        const CommandGiver person{axes::CommandKind::none, axes::Owner::operator_panel, no_program, nullptr, GroupCommandKind::interrupt};
        auto event = event_of(group.index, person, ErrorId::none, 0);
        event.what = CommandEvent::What::aborted;
        event.by = giver;
        axes_.note(event);
    }
    if (before != 0 && before != answer.id && aborted(groups_[group.index].view(), before)) {
        const auto* loser = giver_of(place, before);
        const bool own_stop = loser != nullptr && loser->program == program && stops(command.kind);
        if (!own_stop) note_aborted(group.index, before, giver);
        if (place.active == before) place.active = 0;
    }
    if (!axes::is_administrative(command.kind)) place.commander = program;
    place.given[place.next] = {answer.id, giver};
    place.next = static_cast<std::uint8_t>((place.next + 1) % place.given.size());
    return answer;
}

namespace {

bool has_ended(const CommandGiver& given, const ProgramRecords& programs) noexcept {
    return given.program < programs.size() && !programs[given.program].running();
}

}  // namespace

void WatchedGroups::end_of_cycle(bool everything_ends, const ProgramRecords& programs) noexcept {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        auto& place = places_[i];
        const auto& view = groups_[i].view();
        for (; place.ledger != view.ledger_next; place.ledger = static_cast<std::uint8_t>((place.ledger + 1) % view.ledger.size())) {
            const auto& over = view.ledger[place.ledger];
            // What waited behind an error ended with it: that one is told.
            if (over.outcome != axes::Outcome::error || over.error == ErrorId::aborted_by_axis_error) continue;
            const auto* given = giver_of(place, over.id);
            if (given == nullptr || everything_ends || has_ended(*given, programs)) continue;
            auto event = event_of(i, *given, over.error, over.id);
            // What stopped the group stands beside this as an alarm, or is the group's error: the command did not fail by itself.
            const bool stopped = event.axis_error != 0 && static_cast<std::uint16_t>(over.error) == event.axis_error;
            if (stopped) event.what = CommandEvent::What::aborted;
            axes_.note(event);
        }
        const bool by_hand = std::exchange(place.stops, view.stops_by_hand) != view.stops_by_hand;
        const auto ended = place.active != 0 ? place.active : by_hand ? place.waiting : 0;
        if (ended != 0 && ended != view.active && aborted(view, ended)) {
            const auto* given = giver_of(place, ended);
            CommandGiver by;
            if (by_hand) by = {axes::CommandKind::none, axes::Owner::operator_panel, no_program, nullptr, GroupCommandKind::halt};
            if (given != nullptr && !everything_ends && !has_ended(*given, programs)) note_aborted(i, ended, by);
        }
        place.active = view.active;
        place.waiting = view.active == 0 && view.queued_count > 0 ? view.queued[0] : 0;
    }
}

}  // namespace taktwerk::runtime
