#pragma once
// Short lines that lie within a tolerance of one straight line become that line: G64 Q. Pure; bounded memory, at most `most` compares a line.

#include <array>
#include <cstddef>

namespace taktwerk::gcode {

using Point = std::array<double, 3>;

class LineMerger {
public:
    static constexpr std::size_t most = 256;

    /// The line from here on begins at `from`.
    void begin(const Point& from, const Point& to) noexcept;
    /// Takes one more point if all ends of lines so far lie within `tolerance` of the straight line to it, in their order. False: it does not fit.
    [[nodiscard]] bool extend(const Point& to, double tolerance) noexcept;
    [[nodiscard]] const Point& end() const noexcept { return ends_[count_ - 1]; }
    [[nodiscard]] std::size_t lines() const noexcept { return count_; }

private:
    Point from_{};
    std::array<Point, most> ends_{};
    std::size_t count_ = 0;
};

}  // namespace taktwerk::gcode
