// A stored path, in the cycle: what it asks for beside motion, in its turn. MC_MovePath.

#include "axes/group/axis_group.hpp"
#include "axes/group/path_note.hpp"
#include "axes/group/path_shelf.hpp"

namespace taktwerk::axes {
namespace {

void ask(PathView& shown, const PathNote& note) noexcept {
    shown.request = note.request;
    shown.request.line = note.line;
    ++shown.request_id;
}

void nothing_carried_out(PathView& shown) noexcept {
    shown.line = 0;
    shown.number = PathView::no_block_number;
}

}  // namespace

void AxisGroup::walk_path(Duration period) noexcept {
    PathView& shown = view_.path;
    const auto& active = queue_.active();
    elapsed_ += period;
    shown.path = active.command.path;
    if (run_.line() != 0) {
        shown.line = run_.line();
        shown.number = run_.number();
    }
    const bool goes = interrupting_ == 0;
    while (const PathNote* note = run_.note()) {
        if (!serve(*note, goes ? period : Duration{})) return;
        if (note->kind == PathNote::Kind::end) {
            nothing_carried_out(shown);
            return queue_.finish_active(Outcome::done);
        }
        if (note->kind == PathNote::Kind::fault) {
            nothing_carried_out(shown);
            refused(active, note->place);
            return queue_.finish_active(Outcome::error, note->place.error);
        }
        const bool told = note->kind == PathNote::Kind::tell;
        run_.drop_note();
        if (told) return;  // one a cycle, or nobody sees it
    }
    if (run_.stuck() != ErrorId::none && run_.over()) {
        shown.place = {.error = run_.stuck(), .line = shown.line};
        nothing_carried_out(shown);
        refused(active, shown.place);
        return queue_.finish_active(Outcome::error, run_.stuck());
    }
    if (goes) run_.go_over(active.id);
}

/// False: that takes longer.
bool AxisGroup::serve(const PathNote& note, Duration period) noexcept {
    PathView& shown = view_.path;
    if (note.kind != PathNote::Kind::tell) {
        shown.line = note.line;
        shown.number = note.number;
    }
    switch (note.kind) {
        case PathNote::Kind::tell: ask(shown, note); return true;
        case PathNote::Kind::dwell:
            path_.dwelt += period;
            if (to_seconds(path_.dwelt) < note.seconds) return false;
            path_.dwelt = {};
            return true;
        case PathNote::Kind::ask:
            if (path_.answered) {
                path_.answered = shown.waits = false;
                return true;
            }
            if (!shown.waits) {
                ask(shown, note);
                shown.waits = true;
            }
            return false;
        case PathNote::Kind::fault: shown.place = note.place; return true;
        case PathNote::Kind::end: return true;
    }
    return true;
}

ErrorId AxisGroup::acknowledge(std::uint32_t request, Owner owner) noexcept {
    if (members_.owned_by_other(owner)) return ErrorId::owned_by_other;
    if (!view_.path.waits || request != view_.path.request_id) return ErrorId::unknown_command;
    path_.answered = true;
    return ErrorId::none;
}

/// Nobody goes the path any more. What ended it on its way, and has no fault of the text to name, did so at this line.
void AxisGroup::forget_path() noexcept {
    path_ = {};
    view_.path.waits = false;
    if (view_.path.line == 0) return;
    if (view_.path.place.error == ErrorId::none) view_.path.place.line = view_.path.line;
    nothing_carried_out(view_.path);
}

void AxisGroup::selected(PathRef path) noexcept {
    const bool on_path = goes_stored_path(queue_.active().command.kind);
    if (!on_path) view_.path = {.path = path, .request_id = view_.path.request_id};
}

/// What was wrong with a path that was selected.
void AxisGroup::see_selection() noexcept {
    const auto* state = paths_ != nullptr ? paths_->state(view_.path.path) : nullptr;
    if (state != nullptr && state->kind == PathState::Kind::refused) view_.path.place = state->place;
}

/// It begins in its turn, and has no end: nothing waits behind it.
AxisRef AxisGroup::driver() const noexcept {
    if (queue_.active().command.kind == GroupCommandKind::driven_path) return queue_.active().command.driver.master;
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (queue_.waiting_at(i).command.kind == GroupCommandKind::driven_path) return queue_.waiting_at(i).command.driver.master;
    return {};
}

bool AxisGroup::driven_by(AxisRef axis) const noexcept { return axis.valid() && driver() == axis; }

ErrorId AxisGroup::refuse_driven(const GroupCommand& command) const noexcept {
    if (command.buffer_mode > mcBuffered) return ErrorId::buffer_mode_not_supported;
    if (const auto error = run_.refuse_driver(command.driver, members_); error != ErrorId::none) return error;
    for (const auto& slave : view_.slaves)  // it would follow its own way
        if (slave.id != 0 && slave.axis == command.driver.master) return ErrorId::coupling_loop;
    return refuse_stored(command);
}

bool AxisGroup::watch_driven() noexcept {
    if (run_.driver().axis.valid() && queue_.has_active()) {
        view_.path.line = run_.line();
        view_.path.number = run_.number();
    }
    if (run_.lets_go() == ErrorId::none && run_.fault() != ErrorId::path_limit) return true;
    const auto why = run_.lets_go() != ErrorId::none ? run_.lets_go() : run_.fault();
    const bool on_path = run_.fault() == ErrorId::none;
    fail(static_cast<std::uint16_t>(why));
    if (on_path) return true;
    leave(GroupEvent::error);  // each brakes on its own ramp
    return false;
}

bool AxisGroup::uses(PathRef path) const noexcept {
    const auto is = [&](const AcceptedGroupCommand& c) { return goes_stored_path(c.command.kind) && c.command.path == path; };
    if (queue_.has_active() && is(queue_.active())) return true;
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (is(queue_.waiting_at(i))) return true;
    return false;
}

}  // namespace taktwerk::axes
