#pragma once
// Short lines that lie within a tolerance of one straight line, or of one arc about an axis of the machine, become that: G64 Q. Pure; bounded memory, at most `most` compares a line.
//
// Why arcs: CAM systems write curves as chords of 0.01 to 1 mm. A straight line for many of them has corners whose curves want as much jerk as they are short; an
// arc has what the curve had.

#include <array>
#include <cstddef>
#include <cstdint>

namespace taktwerk::gcode {

using Point = std::array<double, 3>;

class LineMerger {
public:
    static constexpr std::size_t most = 256;

    struct Arc {
        Point centre{};
        std::uint8_t normal = 2;  ///< x 0, y 1, z 2
        double angle = 0;         ///< rad, in the mathematical sense about the normal
    };

    /// The line from here on begins at `from`.
    void begin(const Point& from, const Point& to) noexcept;
    /// Takes one more point if all lines so far, and the one to it, lie within `tolerance` of the straight line to it or of an arc to it, in their order. False: it does not fit.
    [[nodiscard]] bool extend(const Point& to, double tolerance) noexcept;
    [[nodiscard]] const Point& end() const noexcept { return ends_[count_ - 1]; }
    [[nodiscard]] std::size_t lines() const noexcept { return count_; }
    /// nullptr: a straight line.
    [[nodiscard]] const Arc* arc() const noexcept { return bent_ ? &arc_ : nullptr; }

private:
    // How far they are off it; more than any tolerance: it is none of that kind.
    [[nodiscard]] double off_line(const Point& to) const noexcept;
    [[nodiscard]] double off_arc(const Point& to, double tolerance, Arc& arc) const noexcept;

    Point from_{};
    std::array<Point, most> ends_{};
    std::size_t count_ = 0;
    Arc arc_;
    bool bent_ = false;
};

}  // namespace taktwerk::gcode
