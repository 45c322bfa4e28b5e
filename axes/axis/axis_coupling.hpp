#pragma once
// Following masters: what is accepted, the slave's part of a cycle, and how it ends. How a relation begins is in coupling_start.hpp.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class CouplingLinks;
class CouplingStart;
class MasterSide;

struct Link;

class AxisCoupling {
public:
    AxisCoupling(AxisBody& body, AxisMotion& motion, Aim& aim, CouplingLinks& links, CouplingStart& start, Conduct& conduct,
                 const MasterSide& as_master) noexcept
        : body_(body), motion_(motion), aim_(aim), links_(links), start_(start), conduct_(conduct), as_master_(as_master) {}

    [[nodiscard]] ErrorId refuse(const AxisCommand& command) const noexcept;
    /// A cam that repeats for ever.
    [[nodiscard]] bool never_ends(const AxisCommand& command) const noexcept;
    /// Behind it nothing gets its turn (P1-092), neither while it runs nor while it waits itself. Settings pass it.
    [[nodiscard]] bool waits_for_ever() const noexcept;
    ErrorId select_cam(const SelectCam& wanted) noexcept;
    /// The active command's coupling: it begins in the next follow_masters(), or when its master comes to the place where it begins.
    ErrorId join(const AcceptedCommand& accepted) noexcept;
    /// ContinuousUpdate of the active command: another coupling of the same kind, with the relative inputs of the first one's start.
    ErrorId update(const AxisCommand& command) noexcept;
    /// Whatever took the axis has ended the coupling.
    void settle() noexcept;
    void follow(Duration period) noexcept;
    void step(Duration period) noexcept;
    /// The same while the axis' limits, the command and what is on top of the base are as in the cycle before.
    void step_on(Duration period) noexcept;
    /// True: a cam that is over hands over at once (P1-092: EndOfProfile); other couplings when their Inxxx has been seen.
    [[nodiscard]] bool complete() noexcept;

private:
    [[nodiscard]] ErrorId refuse_master(AxisRef ref, MC_Source source) const noexcept;
    void plan_link(CommandId id, const AxisCommand& command, const Link* updated = nullptr) noexcept;

    AxisBody& body_;
    AxisMotion& motion_;
    Aim& aim_;
    CouplingLinks& links_;
    CouplingStart& start_;
    Conduct& conduct_;
    const MasterSide& as_master_;
};

}  // namespace taktwerk::axes
