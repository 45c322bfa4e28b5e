#pragma once
// A path: sections one behind the other, fixed when a move is accepted. Service side; what runs gets copies of sections.

#include <cstdint>
#include <vector>

#include "axes/path/blend.hpp"
#include "axes/path/path_chart.hpp"
#include "axes/path/path_element.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// What a move asks of the way along its path: u/s, u/s2, u/s3 of its position (where only its orientation moves: rad/s, ...). > 0.
struct PathFeed {
    double velocity = 0;
    double acceleration = 0;
    double deceleration = 0;
    double jerk = 0;
};

/// A move as accepted: its curve, in which chart, how fast, whose.
struct PathMove {
    PathElement element;
    PathChart chart{};
    PathFeed feed{};
    std::uint32_t command = 0;
};

/// A part of one element: [from, from + length] of it is [begin, begin + length] of the path.
struct PathSection {
    PathElement element;
    PathChart chart{};
    PathFeed feed{};
    double from = 0;
    double begin = 0;
    double length = 0;
    std::uint32_t command = 0;  ///< of a blend: the one that it leads to
    bool blend = false;
    bool stop_before = false;  ///< the corner in front of it can only be passed at rest

    [[nodiscard]] double end() const noexcept { return begin + length; }
    [[nodiscard]] PathPoint at(double s) const noexcept { return element.at(from + (s - begin)); }
};

/// How a move was joined to the one before it.
enum class PathJoint : std::uint8_t {
    first,   ///< nothing before it
    blend,   ///< by a curve as asked
    cut,     ///< by a curve smaller than asked: too little room, or too late
    smooth,  ///< tangent and curvature agree: nothing to be done
    stop,    ///< at rest: no curve was asked for, or none can be passed
};

class Path {
public:
    /// Appends a move, which begins where the last one ends. What lies before `frozen` [s] is not changed any more.
    /// Errors: path.empty_move (nothing moves), path.gap (it begins elsewhere; nothing is changed).
    [[nodiscard]] Result<PathJoint> append(const PathMove& move, const BlendRequest& transition, double frozen = 0);

    /// A curve that somebody has made for a joint of two kinds of points, and the move behind it: the curve leaves the last section `before` its end, and the
    /// move goes on `behind` its beginning.
    void append_over(const PathSection& curve, double before, const PathMove& move, double behind);

    [[nodiscard]] const std::vector<PathSection>& sections() const noexcept { return sections_; }
    [[nodiscard]] double length() const noexcept { return sections_.empty() ? 0 : sections_.back().end(); }
    /// The section that holds s; at a joint the one behind it, or before it at the path's end. Only where there are sections.
    [[nodiscard]] const PathSection& section_at(double s) const noexcept { return sections_[index_at(s)]; }
    [[nodiscard]] std::size_t index_at(double s) const noexcept;

    /// Takes out the first `count` sections, which nobody goes any more; the others stay where they are.
    void forget(std::size_t count) {
        sections_.erase(sections_.begin(), sections_.begin() + static_cast<std::ptrdiff_t>(count));
        begins_.erase(begins_.begin(), begins_.begin() + static_cast<std::ptrdiff_t>(count));
    }

    /// To take an append() back.
    struct Mark {
        std::size_t count = 0;
        PathSection last{};
    };
    [[nodiscard]] Mark mark() const noexcept { return sections_.empty() ? Mark{} : Mark{sections_.size(), sections_.back()}; }
    void back_to(const Mark& mark) {
        sections_.resize(mark.count);
        begins_.resize(mark.count);
        if (mark.count > 0) sections_.back() = mark.last;
        if (mark.count > 0) begins_.back() = mark.last.begin;
    }

    void clear() noexcept {
        sections_.clear();
        begins_.clear();
    }

private:
    void push(const PathSection& section) {
        sections_.push_back(section);
        begins_.push_back(section.begin);
    }

    std::vector<PathSection> sections_;
    std::vector<double> begins_;  // of them: who searches a place reads these alone
};

}  // namespace taktwerk::axes
