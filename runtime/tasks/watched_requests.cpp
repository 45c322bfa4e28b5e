#include "runtime/tasks/watched_requests.hpp"

#include "axes/axis/command_kinds.hpp"
#include "runtime/tasks/program_record.hpp"

namespace taktwerk::runtime {

using axes::AxisState;
using axes::CommandKind;
using axes::CommandStatus;
using axes::ErrorId;
using What = CommandEvent::What;

const CommandGiver* WatchedRequests::giver_of(const Place& place, axes::CommandId id) noexcept {
    if (id != 0)
        for (const auto& given : place.given)
            if (given.id == id) return &given.giver;
    return nullptr;
}

bool WatchedRequests::cut_short(const axes::AxisView& view, axes::CommandId id) noexcept {
    const auto status = view.status(id);
    return status == CommandStatus::aborted || status == CommandStatus::error;
}

void WatchedRequests::rival(Place& place, std::uint16_t loser) noexcept {
    if (program_ == no_program || loser == no_program || loser == program_) return;
    place.rivals = {program_, loser, now_ + rivals_shown};
}

bool WatchedRequests::disturbs_person(axes::AxisRef axis, const axes::AxisCommand& command) const noexcept {
    using axes::kind_table::Slot;
    if (program_ == no_program || groups_ == nullptr) return false;
    const auto slot = axes::slot_of(command.kind);
    const bool stops =
        command.kind == CommandKind::halt || command.kind == CommandKind::stop || command.kind == CommandKind::halt_superimposed;
    if (stops || (slot != Slot::queue && slot != Slot::superimposed)) return false;
    const auto* group = groups_->view(groups_->group_of(axis));
    return group != nullptr && group->held;
}

axes::Submitted WatchedRequests::submit(axes::AxisRef axis, const axes::AxisCommand& command, axes::Owner owner) noexcept {
    if (axis.index >= axes_.size()) return direct_.submit(axis, command, owner);
    auto& place = places_[axis.index];
    const auto& view = axes_[axis.index].view();
    const auto before = view.active;
    // Over as it was meant to end: an endless motion at its velocity is taken on by the next, a released key stops its jog.
    const bool reached = view.active_in_target || (view.active_kind == CommandKind::jog && command.kind == CommandKind::halt);
    // Who stops what a program moves does so in the program's name (HandMotion::stop), and is a person all the same.
    const bool hand = program_ == no_program && owner == axes::Owner::program;
    const CommandGiver asking{command.kind, hand ? axes::Owner::operator_panel : owner, program_, command.instance};

    CommandEvent event;
    event.axis = axis.index;
    event.given = asking;
    event.state = view.state;
    event.axis_error = view.state == AxisState::ErrorStop ? view.error : std::uint16_t{0};
    event.held = view.lock != 0;
    const auto* holder = giver_of(place, view.lock != 0 ? view.lock : view.active);
    // A command that was given by another way than this has at least its kind and its owner.
    if (holder) event.by = *holder;
    else if (view.active != 0) event.by = {view.active_kind, view.owner, no_program, view.holder};

    const auto answer = disturbs_person(axis, command) ? axes::Submitted{0, ErrorId::held_by_person} : direct_.submit(axis, command, owner);
    if (answer.error != ErrorId::none) {
        event.error = answer.error;
        if (answer.error == ErrorId::owned_by_other && event.by.owner == axes::Owner::none) event.by.owner = view.owner;
        if (event.by.program != no_program && event.by.program != program_ && program_ != no_program)
            place.rivals = {event.by.program, program_, now_ + rivals_shown};  // who has the axis has won
        events_.note(event, now_);
        return answer;
    }
    if (answer.id == 0) return answer;
    if (before != 0 && before != answer.id && cut_short(view, before)) {
        const auto loser = event.by;
        rival(place, loser.program);
        const bool stops = command.kind == CommandKind::halt || command.kind == CommandKind::stop;
        const bool own_stop = stops && loser.program == program_;
        const bool persons_stop = loser.program == no_program && loser.kind == CommandKind::halt && stops;  // it comes to rest all the same
        const bool another_program = loser.program != program_ && loser.program != no_program && program_ != no_program;
        if (hand || another_program || !(reached || own_stop || persons_stop)) {
            event.what = What::aborted;
            event.given = loser;
            event.by = asking;
            event.held = false;
            events_.note(event, now_);
        }
        if (place.active == before) place.active = 0;  // told
    }
    place.given[place.next] = {answer.id, asking};
    place.next = static_cast<std::uint8_t>((place.next + 1) % place.given.size());
    return answer;
}

axes::ErrorId WatchedRequests::power(axes::AxisRef axis, bool enable, bool positive, bool negative, axes::Owner owner) noexcept {
    const auto error = direct_.power(axis, enable, positive, negative, owner);
    if (axis.index >= axes_.size()) return error;
    auto& place = places_[axis.index];
    if (error != ErrorId::power_conflict) {
        if (error != ErrorId::owned_by_other) place.power = program_;
        return error;
    }
    // Drives come up in their own time, and an interlock has its alarm; two holders of one level are a mistake in the programs.
    CommandEvent event;
    event.axis = axis.index;
    event.given = {CommandKind::none, owner, program_, nullptr};
    event.by = {CommandKind::none, owner, place.power, nullptr};
    event.state = axes_[axis.index].view().state;
    event.error = error;
    if (place.power != program_ && place.power != no_program && program_ != no_program)
        place.rivals = {place.power, program_, now_ + rivals_shown};
    events_.note(event, now_);
    return error;
}

void WatchedRequests::end_of_cycle(Instant now, bool everything_ends, const ProgramRecords& programs) noexcept {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        auto& place = places_[i];
        const auto& view = axes_[i].view();
        if (place.active != 0 && place.active != view.active && cut_short(view, place.active)) {
            CommandEvent event;
            event.what = What::aborted;
            event.axis = static_cast<std::uint16_t>(i);
            if (const auto* giver = giver_of(place, place.active)) event.given = *giver;
            event.state = view.state;
            event.axis_error = view.state == AxisState::ErrorStop ? view.error : std::uint16_t{0};
            (void)view.status(place.active, &event.error);
            const auto program = event.given.program;
            const bool ends_too = everything_ends || (program < programs.size() && !programs[program].running());
            if (event.given.kind != CommandKind::none && event.given.kind != CommandKind::jog && !ends_too) events_.note(event, now);
        }
        place.active = view.active_in_target ? 0 : view.active;
    }
}

}  // namespace taktwerk::runtime
