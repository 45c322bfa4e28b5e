#pragma once
// A cam: the slave's position as a function of the master's. What a program writes (CamSource) and what a slave follows (PreparedCam).
// Master u and slave u are the axes' own units.

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "axes/tables/cam_law.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// As the velocity of the first or last point of a cam that begins or ends with a spline: the slope is free, the acceleration there is 0
/// (a natural spline).
inline constexpr double cam_free_end = std::numeric_limits<double>::quiet_NaN();

/// A point and the segment that leads from it to the next point of the list. Derivatives are with respect to the master: du/dM, d2u/dM2.
///
/// A run of splines leaves its first and reaches its last point with the slope of the neighbouring segment where that is linear, else with
/// the velocity given at the point (so it meets a quintic one smoothly, and dwells at the ends of the cam unless told otherwise).
/// Where the run is all of a periodic cam it is closed: what is given at its ends is not used, and nothing jumps at the wrap.
/// Laws and quintic segments take the velocity that is given at their points, whatever their neighbours do (cam_check.hpp compares).
struct CamPoint {
    double master = 0, slave = 0;
    double velocity = 0, acceleration = 0;  ///< quintic segments, laws, and the ends of spline runs
    CamSegment segment = CamSegment::quintic;
};

struct CamSource {
    std::vector<CamPoint> points;  ///< never grows after declaration
    std::size_t used = 0;          ///< points that count, from the first
    [[nodiscard]] std::span<const CamPoint> rows() const noexcept { return {points.data(), used}; }
};

/// Ready to follow. The master runs over [0, length] from the lowest point on; outside of it a cam that is not periodic holds its ends.
class PreparedCam {
public:
    PreparedCam() = default;
    /// Takes room for so many points. Not real-time.
    explicit PreparedCam(std::size_t room);

    /// Real-time safe, linear in the number of points: invalid_table when the master neither rises nor falls strictly, a number is not
    /// finite (cam_free_end excepted), a law cannot join its points, there are fewer than two points or more than the room. Nothing can be
    /// followed then.
    [[nodiscard]] ErrorId prepare(std::span<const CamPoint> points, bool periodic, bool master_absolute, bool slave_absolute) noexcept;

    [[nodiscard]] std::size_t room() const noexcept { return segments_.size(); }
    [[nodiscard]] bool periodic() const noexcept { return periodic_; }
    [[nodiscard]] bool master_absolute() const noexcept { return master_absolute_; }
    [[nodiscard]] bool slave_absolute() const noexcept { return slave_absolute_; }
    /// Lowest master position of the table, and from there to the highest.
    [[nodiscard]] double begin() const noexcept { return begin_; }
    [[nodiscard]] double length() const noexcept { return length_; }
    /// How far the slave is moved by one whole pass.
    [[nodiscard]] double stroke() const noexcept { return stroke_; }

    /// At `master`, 0 <= master <= length() from the lowest point on. Bounded: a binary search.
    [[nodiscard]] CamValue at(double master) const noexcept;

    /// The same curve with the same options. Linear in the number of points.
    [[nodiscard]] bool same_as(const PreparedCam& other) const noexcept;

private:
    /// Polynomial in (master - begin), coefficients from the constant on; or a law.
    struct Segment {
        double begin = 0;
        double coefficients[6] = {};
        CamLawCurve law;
        friend bool operator==(const Segment&, const Segment&) = default;
    };
    void solve_open_run(std::span<const CamPoint> points, std::size_t first, std::size_t count) noexcept;
    void solve_closed_run(std::span<const CamPoint> points) noexcept;

    std::vector<Segment> segments_;
    std::size_t count_ = 0;
    double begin_ = 0, length_ = 0, stroke_ = 0;
    bool periodic_ = false, master_absolute_ = true, slave_absolute_ = true;
};

}  // namespace taktwerk::axes
