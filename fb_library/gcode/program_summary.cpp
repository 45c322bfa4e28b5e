#include "fb_library/gcode/program_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taktwerk::gcode {
namespace {

using std::numbers::pi;

struct InPlane {
    std::size_t first, second;
};
InPlane plane_of(const Move& move) noexcept { return {(move.normal + 1u) % 3, (move.normal + 2u) % 3}; }

}  // namespace

double length_of(const Move& move) noexcept {
    if (move.kind == Move::Kind::line) return std::hypot(move.to[0] - move.from[0], move.to[1] - move.from[1], move.to[2] - move.from[2]);
    const auto [first, second] = plane_of(move);
    const double radius = std::hypot(move.from[first] - move.centre[first], move.from[second] - move.centre[second]);
    return std::hypot(radius * move.angle, move.to[move.normal] - move.from[move.normal]);
}

AxisValues point_of(const Move& move, double share) noexcept {
    AxisValues point;
    for (std::size_t axis = 0; axis < axis_count; ++axis) point[axis] = move.from[axis] + share * (move.to[axis] - move.from[axis]);
    if (move.kind == Move::Kind::line || share == 0 || share == 1) return share == 1 ? move.to : point;
    const auto [first, second] = plane_of(move);
    const double a = move.from[first] - move.centre[first], b = move.from[second] - move.centre[second];
    const double cosine = std::cos(share * move.angle), sine = std::sin(share * move.angle);
    point[first] = move.centre[first] + cosine * a - sine * b;
    point[second] = move.centre[second] + sine * a + cosine * b;
    return point;
}

void ProgramSummary::reach(const AxisValues& point) noexcept {
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
        auto& extent = extents_[axis];
        extent.least = std::min(extent.least, point[axis]), extent.most = std::max(extent.most, point[axis]);
    }
}

void ProgramSummary::add_move(const Move& move) {
    if (moves() == 0)
        for (std::size_t axis = 0; axis < axis_count; ++axis) extents_[axis].least = extents_[axis].most = move.from[axis];
    reach(move.from), reach(move.to);
    for (std::size_t axis = 0; axis < axis_count; ++axis) extents_[axis].moved |= move.from[axis] != move.to[axis];
    if (move.kind == Move::Kind::arc) {
        // The circle's outermost points in each axis of the plane, where the arc passes them.
        const auto [first, second] = plane_of(move);
        extents_[first].moved = extents_[second].moved = true;
        const double start = std::atan2(move.from[second] - move.centre[second], move.from[first] - move.centre[first]);
        for (int quarter = 0; quarter < 4; ++quarter) {
            double way = quarter * pi / 2 - start;
            if (move.angle < 0) way = -way;
            way -= 2 * pi * std::floor(way / (2 * pi));
            if (way < std::fabs(move.angle)) {
                const double radius = std::hypot(move.from[first] - move.centre[first], move.from[second] - move.centre[second]);
                auto point = move.from;
                if (quarter % 2 == 0) point[first] = move.centre[first] + (quarter == 0 ? radius : -radius);
                else point[second] = move.centre[second] + (quarter == 1 ? radius : -radius);
                reach(point);
            }
        }
    }
    const double length = length_of(move);
    auto& moves = move.feed.kind == Feed::Kind::rapid ? rapids_ : move.kind == Move::Kind::arc ? arcs_ : lines_;
    ++moves.count, moves.length_mm += length;

    double speed = move.feed.value;
    switch (move.feed.kind) {
        case Feed::Kind::rapid: return;
        case Feed::Kind::seconds: seconds_ += move.feed.value, speed = length / move.feed.value; break;
        case Feed::Kind::mm_per_s: seconds_ += length / move.feed.value; break;
        case Feed::Kind::deg_per_s: {
            const double turn = std::hypot(move.to[3] - move.from[3], move.to[4] - move.from[4], move.to[5] - move.from[5]);
            seconds_ += turn / move.feed.value;
            return;
        }
    }
    if (length == 0) return;
    feeds_.least = feeds_.most == 0 ? speed : std::min(feeds_.least, speed);
    feeds_.most = std::max(feeds_.most, speed);
}

void ProgramSummary::add_handshake(const Handshake& handshake) {
    using Kind = Handshake::Kind;
    ++handshakes_[static_cast<std::size_t>(handshake.kind)];
    if (handshake.kind == Kind::tool_change && handshake.number > 0 &&
        std::find(tools_.begin(), tools_.end(), handshake.number) == tools_.end())
        tools_.push_back(handshake.number);
    if (handshake.kind == Kind::spindle_clockwise || handshake.kind == Kind::spindle_counter || handshake.kind == Kind::spindle_speed) {
        spindle_.least = spindle_.used ? std::min(spindle_.least, handshake.value) : handshake.value;
        spindle_.most = std::max(spindle_.most, handshake.value);
        spindle_.used = true;
    }
}

void ProgramSummary::add(const ProgramItem& item) {
    switch (item.kind) {
        case ProgramItem::Kind::move: add_move(item.move); break;
        case ProgramItem::Kind::handshake: add_handshake(item.handshake); break;
        case ProgramItem::Kind::dwell:
            ++dwells_.count, dwells_.seconds += item.seconds, seconds_ += item.seconds;
            if (item.seconds > dwells_.longest) dwells_.longest = item.seconds, dwells_.longest_line = item.line;
            break;
        case ProgramItem::Kind::message: ++messages_; break;
        case ProgramItem::Kind::resume: break;
    }
}

}  // namespace taktwerk::gcode
