#pragma once
// MC_TouchProbe and MC_AbortTrigger: beside whatever the axis does, in every state, without moving anything or changing the state.
//
// Any party may probe: it commands no motion. A probe lives until its event, MC_AbortTrigger, or until the drive's feedback is lost; errors
// of the axis, power and other commands leave it alone.

#include <array>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/position_track.hpp"
#include "axes/axis/probe_board.hpp"

namespace taktwerk::axes {

class AxisProbes {
public:
    AxisProbes(AxisBody& body, const Measured& measured, const HomingRuns& runs) noexcept : body_(body), measured_(measured), runs_(runs) {}

    Submitted submit(const AxisCommand& command) noexcept;
    /// True: what is shown of probes may have changed.
    [[nodiscard]] bool watch() noexcept;

    /// What watch() does in every cycle, after a feedback of the same counting.
    void track() noexcept {
        track_.add(measured_.feedback.latched, measured_.feedback.position);
        feedback_age_ = body_.now - measured_.feedback.latched;
    }
    /// One waits, or the drive has not been told yet that none does.
    [[nodiscard]] bool in_use() const noexcept { return board_.in_use(); }

    [[nodiscard]] bool any() const noexcept { return board_.id(0) != 0 || board_.id(1) != 0; }
    [[nodiscard]] CommandId id(std::size_t slot) const noexcept { return board_.id(slot); }
    /// u, of the last latch of each slot, and the command it ended; 0: none so far.
    [[nodiscard]] const std::array<double, 2>& positions() const noexcept { return positions_; }
    [[nodiscard]] const std::array<CommandId, 2>& latched() const noexcept { return latched_; }
    void command(std::array<ProbeCommand, 2>& to_drive) noexcept { board_.command(to_drive); }

private:
    [[nodiscard]] ProbeBoard::Signals signals() const noexcept;
    [[nodiscard]] double program_position(const FinePosition& place) const noexcept;
    Submitted arm(const ProbeDetails& probe) noexcept;
    Submitted abort_trigger(const TriggerRef& trigger) noexcept;
    void end(CommandId id, Outcome outcome, ErrorId error) noexcept;
    void observe() noexcept;

    PositionTrack track_;
    Duration feedback_age_{};
    std::uint16_t track_epoch_ = 0;
    AxisBody& body_;
    const Measured& measured_;
    const HomingRuns& runs_;

    ProbeBoard board_;
    std::array<double, 2> positions_{};
    std::array<CommandId, 2> latched_{};
};

}  // namespace taktwerk::axes
