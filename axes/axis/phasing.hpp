#pragma once
// MC_PhasingAbsolute, MC_PhasingRelative, MC_HaltPhasing: a motion of its own, of the master's position as this slave sees it, beside the coupling.

#include "axes/axis/axis_body.hpp"

namespace taktwerk::axes {

class AxisCoupling;
class CouplingLinks;

class Phasing {
public:
    Phasing(AxisBody& body, CouplingLinks& links, const AxisCoupling& coupling) noexcept
        : body_(body), links_(links), coupling_(coupling) {}

    Submitted submit(const AxisCommand& command, Owner owner) noexcept;
    void settle_waiting() noexcept;
    void complete() noexcept;

private:
    Submitted submit_halt(const AxisCommand& command, Owner owner) noexcept;
    /// A coupling runs, or is about to.
    [[nodiscard]] bool coupled() const noexcept;
    [[nodiscard]] ErrorId refuse(const AxisCommand& command) const noexcept;
    [[nodiscard]] const AcceptedCommand& coupling_before_phasing(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool lets_phasing_begin() const noexcept;
    /// Of the master; of the slave itself where nobody is.
    [[nodiscard]] const AxisConfig& config_of(AxisRef axis) const noexcept;
    void begin(const AcceptedCommand& accepted) noexcept;
    void halt(const AcceptedCommand& accepted) noexcept;

    AxisBody& body_;
    CouplingLinks& links_;
    const AxisCoupling& coupling_;
};

}  // namespace taktwerk::axes
