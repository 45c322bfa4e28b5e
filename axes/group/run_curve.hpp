#pragma once
// A run as its timing sees it: a path, through the arm where it is one of poses, with the limits that hold now. Service side.

#include <cstdint>
#include <span>
#include <vector>

#include "axes/group/group_link.hpp"
#include "axes/path_time/along_limits.hpp"

namespace taktwerk::axes {

class RunCurve final : public TimedCurve {
public:
    /// `tool_velocity`: u/s of the tool's point that no place of the path is passed faster with; it takes an arm that has a point.
    RunCurve(const Kinematics* arm, std::size_t members, std::span<const MemberLimits> limits, double tool_velocity = unlimited);

    /// What the planner keeps of a section beside the path's own.
    struct Seen {
        RunSection run;
        std::vector<MemberVector> members;  ///< at even distances along its command's element; one: everywhere near it
        double velocity = 0;                ///< of a blend: what its BufferMode asks for; 0 = the section's own
    };
    Path path;
    std::vector<Seen> seen;  ///< one a section
    std::uint32_t forgotten = 0;

    /// Sections that the cycle has left; `part`: that it is on.
    void forget_before(std::uint32_t part);
    /// `own_ramp`: who stands does it as softly as the command says.
    void wish(bool stands, bool own_ramp, const Override& factors, const PathDynamics& ramp) noexcept;

    [[nodiscard]] std::span<const PathAxisLimits> axis_limits() const noexcept { return limits_; }
    [[nodiscard]] WayPoint place(std::size_t index, double s) const noexcept;
    /// What the members and the command leave along the path.
    [[nodiscard]] AlongLimits along(double s) const noexcept;
    /// The command's dynamics there, with nothing left out, whatever override or ramp of a stop holds now: what a transition by velocity asks for (G-053).
    [[nodiscard]] PathFeed feed_at(double s) const noexcept;

    [[nodiscard]] int axes() const noexcept override { return static_cast<int>(limits_.size()); }
    [[nodiscard]] double begin() const noexcept override { return path.sections().empty() ? 0 : path.sections().front().begin; }
    [[nodiscard]] double end() const noexcept override { return path.length(); }
    [[nodiscard]] TimedCurvePoint at(double s, CurveSide side) const noexcept override;
    [[nodiscard]] double next_break(double s) const noexcept override;
    [[nodiscard]] std::uint32_t part_at(double s) const noexcept override {
        return forgotten + static_cast<std::uint32_t>(path.index_at(s));
    }
    [[nodiscard]] double next_stop(double s) const noexcept override;
    [[nodiscard]] double feature(double s, CurveSide side) const noexcept override;

private:
    [[nodiscard]] std::size_t index(double s, CurveSide side) const noexcept;
    [[nodiscard]] const MemberVector& near(std::size_t index, double s) const noexcept;
    /// How its motion shall be, beside what its commands say.
    struct Manner {
        bool ramps = false;  // by `ramp`, not by the command
        Override factors{};
        PathDynamics ramp{};
    };
    [[nodiscard]] TimedCurvePoint on(std::size_t index, double s, const Manner& manner) const noexcept;

    /// By how much the tool's point moves per length of the path.
    [[nodiscard]] double tool_rate(std::size_t index, double s, const WayPoint& at) const noexcept;
    [[nodiscard]] bool tool_limited() const noexcept { return tool_velocity_ < unlimited; }

    const Kinematics* arm_;
    double tool_velocity_;
    std::vector<PathAxisLimits> limits_;
    Manner manner_{};
};

}  // namespace taktwerk::axes
