#pragma once
// Set-points that no planner makes: tables over time, and set-points fed from outside. Both are checked before they are followed; neither
// takes an override, because their time is the program's (MC_PositionProfile has TimeScale).

#include <array>
#include <cstddef>
#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/time_curve.hpp"

namespace taktwerk::axes {

class GivenMotion {
public:
    GivenMotion(const AxisBody& body, AxisMotion& motion) noexcept : body_(body), motion_(motion) {}

    ErrorId refuse(const AxisCommand& command, bool starts_now) noexcept;
    ErrorId take(const AxisCommand& command) noexcept;
    /// ContinuousUpdate: the rest of the table, as it stands now, with the new scales, from where the axis is and as it moves.
    ErrorId update(const AxisCommand& command) noexcept;
    void start(double late) noexcept;
    [[nodiscard]] bool step(Duration period) noexcept;
    /// Largest velocity that the base is going to have in the sense 1 or -1, u/s, as far as anybody knows.
    [[nodiscard]] double base_speed(double sense) const noexcept;
    /// The next set-point, for a command that is fed.
    ErrorId feed(const SetpointFeed& fed) noexcept;

    /// Room for tables. Not real-time.
    void reserve(std::size_t rows) {
        for (auto& curve : profile_.curves) curve.reserve(rows);
    }
    /// The newest set-point was a fed one.
    [[nodiscard]] bool follows_feed() const noexcept { return feed_.followed; }
    /// u/s3 that a running feed keeps by its own word (AxisCommand::jerk), the axis' at most; 0: nobody limits that of a feed or a table.
    [[nodiscard]] double jerk() const noexcept;

private:
    /// What is superimposed when the curve begins: part of its start, or beside it all the time.
    enum class Addition : std::uint8_t { folded, stays };
    ErrorId make_curve(const AxisCommand& command, Addition addition, double behind = 0) noexcept;
    void follow_curve(double t) noexcept;
    [[nodiscard]] ErrorId check_feed(const MotionState& next) const noexcept;
    [[nodiscard]] bool follow_feed(Duration period) noexcept;

    const AxisBody& body_;
    AxisMotion& motion_;
    struct TableRun {
        std::array<TimeCurve, 2> curves;  // the running one, and one to check the next command with
        std::size_t current = 0;
        Duration elapsed{};
        double late = 0;    // s: it began this long before the cycle in which it was started
        double behind = 0;  // s of the table that the running curve leaves out

        [[nodiscard]] TimeCurve& running() noexcept { return curves[current]; }
        [[nodiscard]] const TimeCurve& running() const noexcept { return curves[current]; }
        [[nodiscard]] TimeCurve& spare() noexcept { return curves[1 - current]; }
        void take_spare() noexcept { current = 1 - current; }
    };
    struct Feed {
        MotionState next;
        bool fresh = false;     // given since the last plan()
        bool followed = false;  // the newest set-point was a fed one
        std::uint32_t missing = 0;
    };
    TableRun profile_;
    Feed feed_;
};

}  // namespace taktwerk::axes
