#pragma once
// A cam as a relation between two axes: where in the table the master is, which pass, and what that makes of the slave. Real-time safe.
//
//     slave = slave origin + slave scaling * (table((master - master origin) / master scaling) - table origin + passes * stroke)
//
// Passes count from the one in which the cam began.
// Origins are where the lowest master position of the table lies, and the slave's place there when its table value is `table origin`.
// A negative master scaling runs the table from its end, a negative slave scaling mirrors it.

#include <cstdint>

#include "axes/coupling/endless.hpp"
#include "axes/coupling/step_ratio.hpp"
#include "axes/tables/cam_table.hpp"

namespace taktwerk::axes {

struct CamFit {
    EndlessPlace master_origin{};
    EndlessPlace slave_origin{};
    double table_origin = 0;                       ///< u of the table
    double master_scaling = 1, slave_scaling = 1;  ///< finite, not 0 (the slave's may be 0)
    double master_feed = 1, slave_feed = 1;        ///< u
};

class CamCurve {
public:
    CamCurve() noexcept = default;
    /// `cam` must stay as it is while this is used. False when lengths and feeds cannot be compared exactly.
    [[nodiscard]] bool set(const PreparedCam& cam, const CamFit& fit) noexcept;

    [[nodiscard]] EndlessMotion at(const EndlessMotion& master) noexcept;

    /// Ends passed so far, at the last point forwards and at the first one backwards (EndOfProfile).
    [[nodiscard]] std::uint32_t ends() const noexcept { return ends_; }
    /// A cam that is not periodic was left: the slave holds the end it was left by, and does not enter again.
    [[nodiscard]] bool over() const noexcept { return phase_ == Phase::over; }
    /// The master's place at the end by which the cam was left last: where a cam that is chained to it begins.
    [[nodiscard]] const EndlessPlace& end() const noexcept { return end_; }
    /// Where the cam leaves the slave there; only when over().
    [[nodiscard]] EndlessPlace slave_end() const noexcept;
    void shift(double delta) noexcept { fit_.slave_origin.local += delta; }

private:
    enum class Phase : std::uint8_t { outside, inside, over };
    struct Spot {
        std::int64_t pass = 0;
        double at = 0;  // u of the master from the beginning of this pass, 0 <= at < pass length
    };
    [[nodiscard]] Spot locate(const EndlessPlace& master) noexcept;

    const PreparedCam* cam_ = nullptr;
    CamFit fit_;
    double sense_ = 1;        // sign of the master scaling
    double pass_length_ = 1;  // u of the master
    std::int64_t feeds_ = 0;  // of the master, counted so far
    StepRatio passes_;        // master feeds counted in passes
    StepRatio strokes_;       // passes counted in slave feeds
    std::int64_t pass_ = 0;
    bool seen_ = false;
    Phase phase_ = Phase::outside;
    double held_ = 0;  // table position while over
    std::uint32_t ends_ = 0;
    EndlessPlace end_;
};

}  // namespace taktwerk::axes
