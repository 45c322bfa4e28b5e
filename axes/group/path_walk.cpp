// A stored path pulled piece by piece, as far ahead as there is room: the planner's part of MC_MovePath.

#include <algorithm>

#include "axes/group/group_planner.hpp"

namespace taktwerk::axes {
namespace {

/// Placed at once: what is placed wants to be planned and gone, too.
constexpr int most_at_once = 200;
/// Room is used when so much of the whole is free: each stretch plans the braking before the former end again.
constexpr std::size_t enough_room = 4;
/// A corner may be cut by any amount: half of both pieces.
constexpr double any_deviation = 1e9;

PathNote::Kind kind_of(PathItem::Kind kind) noexcept {
    switch (kind) {
        case PathItem::Kind::dwell: return PathNote::Kind::dwell;
        case PathItem::Kind::ask: return PathNote::Kind::ask;
        case PathItem::Kind::tell: return PathNote::Kind::tell;
        case PathItem::Kind::fault: return PathNote::Kind::fault;
        default: return PathNote::Kind::end;
    }
}
bool moves(const PathItem& item) noexcept { return item.kind == PathItem::Kind::line || item.kind == PathItem::Kind::arc; }

void becomes_fault(PathItem& item, ErrorId error, const PathHindrance& at = {}) noexcept {
    item.kind = PathItem::Kind::fault;
    item.place = {.error = error, .line = item.line, .at = at};
}

}  // namespace

void GroupPlanner::open_path(const GroupOrder& move) {
    walk_ = std::make_unique<Walk>();
    walk_->id = move.id;
    walk_->began = end_;
    walk_->place.look = millimetre_;
    walk_->place.carried = move.place.carried;
    if (Run* run = last()) run->open = false;
    const auto program = paths_ != nullptr ? paths_->program(move.command.path) : nullptr;
    auto error = program ? place_of(end_, space_, walk_->place) : ErrorId::path_not_selected;
    if (error == ErrorId::none) {
        walk_->source = program->open(walk_->place.at);
        return;
    }
    becomes_fault(walk_->item, error);
    walk_->pending = true;
}

std::size_t GroupPlanner::room() const noexcept {
    const Run* run = last();
    if (run == nullptr || !run->open) return link_.tracks[0].most_sections;
    const std::size_t used = run->curve.forgotten + run->curve.seen.size() + 2 - run->track.part.load(std::memory_order_relaxed);
    return run->track.most_sections - std::min(used, run->track.most_sections);
}

bool GroupPlanner::walk(const GroupOrder& move) {
    if (!walk_ || walk_->id != move.id) open_path(move);
    Walk& w = *walk_;
    if (w.full && room() < link_.tracks[0].most_sections / enough_room) return false;
    w.full = false;
    for (int placed = 0; placed < most_at_once;) {
        if (!w.pending) {
            w.item = w.source->next();
            w.pending = true;
        }
        if (moves(w.item)) {
            if (!w.shape) w.shape = segment_of(w.item, w.place, end_, space_);
            if (w.shape->error != ErrorId::none) {
                becomes_fault(w.item, w.shape->error, w.shape->at);
                continue;
            }
            if (!w.shape->empty && !place_piece(move)) return false;
            ++placed;
        } else {
            if (!note()) return false;
            if (w.item.kind == PathItem::Kind::end || w.item.kind == PathItem::Kind::fault) {
                walk_.reset();
                return true;
            }
        }
        w.pending = false;
        w.shape.reset();
    }
    return false;
}

/// The stricter of both rules holds at the joint in front of it.
GroupOrder GroupPlanner::piece_of(const GroupOrder& move) const {
    using Joint = PathItem::Joint;
    const Walk& w = *walk_;
    GroupOrder piece = move;
    piece.line = w.item.line;
    piece.number = w.item.number;
    piece.command.dynamics.velocity = w.item.velocity;
    const Joint joint = std::min(w.joint, w.item.joint);
    piece.joins = !w.resting && joint != Joint::stop;
    piece.command.transition = joint == Joint::blend ? mcTMMaxCornerDeviation : mcTMNone;
    piece.command.transition_parameter = std::min({w.deviation, w.item.deviation, any_deviation});
    return piece;
}

bool GroupPlanner::place_piece(const GroupOrder& move) {
    Walk& w = *walk_;
    if (!place(piece_of(move), *w.shape)) {
        w.full = last() != nullptr && last()->open;
        return false;
    }
    end_ = w.shape->end;
    w.place.at = w.item.to;
    w.joint = w.item.joint;
    w.deviation = w.item.deviation;
    w.resting = false;
    return true;
}

bool GroupPlanner::note() {
    Walk& w = *walk_;
    PathNote note;
    note.kind = kind_of(w.item.kind);
    note.life = life_;
    note.id = w.id;
    note.line = w.item.line;
    note.number = w.item.number;
    note.seconds = w.item.seconds;
    note.request = w.item.request;
    note.place = w.item.place;
    Run* run = last();
    note.run = next_;
    if (note.kind == PathNote::Kind::tell && run != nullptr && run->open) {
        note.run = next_ - 1;
        note.part = run->curve.forgotten + static_cast<std::uint32_t>(run->curve.seen.size());
    }
    if (!link_.notes.try_push(note)) return false;
    if (note.kind == PathNote::Kind::tell) return true;
    if (run != nullptr) run->open = false;
    w.resting = true;
    return true;
}

}  // namespace taktwerk::axes
