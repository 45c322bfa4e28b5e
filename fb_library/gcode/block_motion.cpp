// What moves, and what moves the zeros: G0 to G3, G28, G30, G10, G92, G53.
#include <cmath>
#include <numbers>

#include "fb_library/gcode/block_run.hpp"

namespace taktwerk::gcode {
namespace {

using Motion = ModalState::Motion;
using Distance = ModalState::Distance;
using FeedMode = ModalState::FeedMode;

constexpr double furthest = 1e6;  // mm, deg
constexpr char offset_letters[] = "IJK";
constexpr std::array<std::string_view, linear_axes> not_in_plane{
    "does not lie in the plane in force, G19", "does not lie in the plane in force, G18", "does not lie in the plane in force, G17"};

}  // namespace

double BlockRun::zero(std::size_t axis) const noexcept {
    return program_.offsets_[state_.system][axis] + state_.shift[axis] + state_.length[axis];
}

bool BlockRun::target(Frame frame, AxisValues& to) noexcept {
    to = program_.position_;
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        const char letter = axis_letters[axis];
        if (!has(letter)) continue;
        const double value = block_.of(letter) * unit(axis);
        if (frame == Frame::machine) to[axis] = value;
        else if (state_.distance == Distance::relative) to[axis] += value;
        else to[axis] = value + zero(axis);
        if (!(std::fabs(to[axis]) <= furthest)) return fail(FaultKind::out_of_range, block_.column_of(letter));
    }
    return true;
}

bool BlockRun::non_modal() noexcept {
    const int code = g(Group::non_modal);
    const bool wants_axes = code == 100 || code == 280 || code == 300 || code == 920;
    if (!wants_axes && code != 921 && code != 922 && code != 923) return true;
    const auto column = code_column(Group::non_modal);
    if (wants_axes && axis_words() != 0 && g(Group::motion) >= 0) {
        fail(FaultKind::axis_words_twice, column);
        program_.fault_.other = word_at(block_.text, code_column(Group::motion));
        return false;
    }
    switch (code) {
        case 100: return set_system();
        case 280: return to_reference(program_.options_.reference);
        case 300: return to_reference(program_.options_.second_reference);
        case 920: return set_shift();
        case 921: state_.shift = state_.kept_shift = {}; return true;
        case 922: state_.shift = {}; return true;
        default: state_.shift = state_.kept_shift; return true;
    }
}

bool BlockRun::set_system() noexcept {
    const auto column = code_column(Group::non_modal);
    if (!has('L')) return fail_missing(column, "L2 or L20");
    if (!has('P')) return fail_missing(column, "P, the number of the coordinate system");
    if (axis_words() == 0) return fail_missing(column, "an axis word");
    double kind = 0;
    std::uint32_t system = 0;
    if (!take('L', kind)) return false;
    if (kind != 2 && kind != 20) return fail(FaultKind::g10_kind, block_.column_of('L'));
    if (!take_whole('P', largest_number, system)) return false;
    if (system > coordinate_systems) return fail(FaultKind::g10_system, block_.column_of('P'));
    const auto place = system == 0 ? state_.system : system - 1;
    take_axes();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        const char letter = axis_letters[axis];
        if (!has(letter)) continue;
        const double value = block_.of(letter) * unit(axis);
        // L20: what makes this number of where the machine stands.
        const double set = kind == 2 ? value : program_.position_[axis] - state_.shift[axis] - state_.length[axis] - value;
        if (!(std::fabs(set) <= furthest)) return fail(FaultKind::out_of_range, block_.column_of(letter));
        program_.offsets_[place][axis] = set;
    }
    return true;
}

bool BlockRun::to_reference(const AxisValues& reference) noexcept {
    const auto wanted = axis_words();
    Move move;
    move.from = program_.position_;
    if (wanted != 0) {
        if (!target(Frame::program, move.to)) return false;
        take_axes();
        put_move(move);
        move.from = program_.position_ = move.to;
    }
    move.to = move.from;
    const auto axes = program_.options_.rotary == InterpreterOptions::Rotary::offered ? axis_count : linear_axes;
    for (std::size_t axis = 0; axis < axes; ++axis)
        if (wanted == 0 || has(axis_letters[axis])) move.to[axis] = reference[axis];
    put_move(move);
    program_.position_ = move.to;
    return true;
}

bool BlockRun::set_shift() noexcept {
    if (axis_words() == 0) return fail_missing(code_column(Group::non_modal), "an axis word");
    take_axes();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        const char letter = axis_letters[axis];
        if (!has(letter)) continue;
        const double value = block_.of(letter) * unit(axis);
        state_.shift[axis] = program_.position_[axis] - program_.offsets_[state_.system][axis] - state_.length[axis] - value;
        if (!(std::fabs(state_.shift[axis]) <= 2 * furthest)) return fail(FaultKind::out_of_range, block_.column_of(letter));
    }
    state_.kept_shift = state_.shift;
    return true;
}

bool BlockRun::motion() noexcept {
    switch (g(Group::motion)) {
        case 0: state_.motion = Motion::rapid; break;
        case 10: state_.motion = Motion::line; break;
        case 20: state_.motion = Motion::clockwise; break;
        case 30: state_.motion = Motion::counter_clockwise; break;
        case 800: state_.motion = Motion::none; break;
        default: break;
    }
    motion_column_ = code_column(Group::motion);
    const bool axes = axis_words() != 0 && !axes_taken_;
    const bool machine_frame = g(Group::non_modal) == 530;
    const bool arcs = state_.motion == Motion::clockwise || state_.motion == Motion::counter_clockwise;
    if (machine_frame) {
        const auto column = code_column(Group::non_modal);
        if (!axes || arcs || state_.motion == Motion::none) return fail(FaultKind::g53_motion, column);
        if (state_.distance == Distance::relative) return fail(FaultKind::g53_relative, column);
    }
    if (arcs && !axes_taken_) {
        const bool offsets = has('I') || has('J') || has('K') || has('R');
        if (axes || offsets || g(Group::motion) >= 0) {
            if (motion_column_ == 0)
                motion_column_ = axes ? first_axis_column() : block_.column_of(has('I') ? 'I' : has('J') ? 'J' : has('K') ? 'K' : 'R');
            return arc(state_.motion == Motion::clockwise);
        }
        return true;
    }
    if (!axes) return true;
    if (motion_column_ == 0) motion_column_ = first_axis_column();
    if (state_.motion == Motion::none) return fail(FaultKind::no_motion_mode, first_axis_column());
    return straight(state_.motion == Motion::rapid);
}

bool BlockRun::move_feed(const AxisValues& to, Feed& feed) noexcept {
    if (state_.feed_mode == FeedMode::inverse_time) {
        if (!has('F')) return fail(FaultKind::no_inverse_time, motion_column_);
        double value = 0;
        if (!take('F', value)) return false;
        if (value < 0) return fail(FaultKind::negative, block_.column_of('F'));
        if (value == 0) return fail(FaultKind::no_inverse_time, motion_column_);
        feed = {Feed::Kind::seconds, 60 / value};
        return true;
    }
    if (state_.feed == 0) return fail(FaultKind::no_feed, motion_column_);
    const auto& from = program_.position_;
    bool linear = false, rotary = false;
    for (std::size_t axis = 0; axis < axis_count; ++axis) (axis < linear_axes ? linear : rotary) |= to[axis] != from[axis];
    feed = rotary && !linear ? Feed{Feed::Kind::deg_per_s, state_.feed / 60}
                             : Feed{Feed::Kind::mm_per_s, state_.feed * state_.feed_unit_mm / 60};
    return true;
}

bool BlockRun::straight(bool rapid) noexcept {
    Move move;
    move.from = program_.position_;
    if (!target(g(Group::non_modal) == 530 ? Frame::machine : Frame::program, move.to)) return false;
    if (!rapid && !move_feed(move.to, move.feed)) return false;
    take_axes();
    put_move(move);
    program_.position_ = move.to;
    return true;
}

bool BlockRun::centre_of(PlanePoint& centre) noexcept {
    const auto& plane = state_.plane;
    if (has(offset_letters[plane.normal])) {
        fail(FaultKind::arc_offset_plane, block_.column_of(offset_letters[plane.normal]));
        program_.fault_.reason = not_in_plane[plane.normal];
        return false;
    }
    double offset[2] = {0, 0};
    const std::uint8_t axes[2] = {plane.first, plane.second};
    for (int i = 0; i < 2; ++i) {
        const char letter = offset_letters[axes[i]];
        const bool absolute = state_.arc_distance == Distance::absolute;
        if (!has(letter)) {
            if (absolute) return fail_missing(motion_column_, "a word of the centre: under G90.1 both are needed");
            offset[i] = program_.position_[axes[i]];
            continue;
        }
        if (!take(letter, offset[i])) return false;
        offset[i] *= state_.unit_mm;
        offset[i] += absolute ? zero(axes[i]) : program_.position_[axes[i]];
    }
    centre = {offset[0], offset[1]};
    return true;
}

bool BlockRun::turns(double& more) noexcept {
    if (!has('P')) return true;
    double value = 0;
    if (!take('P', value)) return false;
    if (!(value >= 1 && value <= 10'000) || value != std::floor(value)) return fail(FaultKind::turns, block_.column_of('P'));
    more = value - 1;
    return true;
}

bool BlockRun::arc(bool clockwise) noexcept {
    Move move;
    move.kind = Move::Kind::arc;
    move.from = program_.position_;
    if (!target(Frame::program, move.to)) return false;
    const auto& plane = state_.plane;
    const bool centre_words = has('I') || has('J') || has('K');
    if (!centre_words && !has('R')) return fail(FaultKind::arc_nothing, motion_column_);
    if (centre_words && has('R')) return fail(FaultKind::arc_both, motion_column_);
    const PlanePoint from{move.from[plane.first], move.from[plane.second]}, to{move.to[plane.first], move.to[plane.second]};
    const auto turn = clockwise ? ArcTurn::clockwise : ArcTurn::counter_clockwise;
    ArcAnswer answer;
    if (centre_words) {
        PlanePoint centre;
        if (!centre_of(centre)) return false;
        answer = arc_about(from, to, centre, turn, program_.options_.arc);
    } else {
        double radius = 0;
        if (!take('R', radius)) return false;
        answer = arc_with_radius(from, to, radius * state_.unit_mm, turn, program_.options_.arc);
    }
    switch (answer.kind) {
        case ArcAnswer::Kind::found: break;
        case ArcAnswer::Kind::zero_radius: return fail(FaultKind::arc_zero_radius, motion_column_);
        case ArcAnswer::Kind::radii: return fail(FaultKind::arc_radii, motion_column_, answer.a, answer.b);
        case ArcAnswer::Kind::ends: return fail(FaultKind::arc_ends, motion_column_, answer.a, answer.b);
        case ArcAnswer::Kind::same_point: return fail(FaultKind::arc_same_point, motion_column_);
        case ArcAnswer::Kind::too_far: return fail(FaultKind::arc_too_far, motion_column_, answer.a, answer.b);
    }
    double more = 0;
    if (!turns(more)) return false;
    move.centre[plane.first] = answer.arc.centre.first, move.centre[plane.second] = answer.arc.centre.second;
    move.centre[plane.normal] = move.from[plane.normal];
    move.normal = plane.normal;
    move.angle = answer.arc.angle + (clockwise ? -2 : 2) * std::numbers::pi * more;
    if (std::hypot(to.first - from.first, to.second - from.second) <= same_point_mm)
        move.to[plane.first] = from.first, move.to[plane.second] = from.second;
    if (!move_feed(move.to, move.feed)) return false;
    if (move.feed.kind == Feed::Kind::deg_per_s) move.feed = {Feed::Kind::mm_per_s, state_.feed * state_.feed_unit_mm / 60};
    take_axes();
    put_move(move);
    program_.position_ = move.to;
    return true;
}

}  // namespace taktwerk::gcode
