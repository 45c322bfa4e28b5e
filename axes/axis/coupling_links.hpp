#pragma once
// The couplings of a slave, as they are followed: their masters' places, and the shift between.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/coupling_state.hpp"

namespace taktwerk::axes {

class MasterSide;

class CouplingLinks {
public:
    explicit CouplingLinks(AxisBody& body) noexcept : body_(body) {}

    void drop(Link& link) noexcept;
    [[nodiscard]] bool read(Link& link, Duration period) noexcept;
    [[nodiscard]] EndlessMotion seen(const Link& link, std::size_t master) const noexcept;
    void end_phasing(Outcome outcome) noexcept;
    /// The coupling it belonged to is over (U-16): so is the phasing, and its shift is gone.
    void clear_phase() noexcept;
    /// nullptr for an invalid handle.
    [[nodiscard]] const MasterSide* axis(AxisRef ref) const noexcept;

    /// Anchor and feed: what places of this slave are counted in.
    [[nodiscard]] SlaveFrame slave_frame() const noexcept { return {body_.units.anchor(), body_.units.feed()}; }

    CouplingState state;
    CamId selected;         ///< of the last SelectCam that was done
    SelectCam selected_as;  ///< that SelectCam
    AxisRef path_master;    ///< drives the path of the group that leads this axis (Axis::path_driven_by)

private:
    AxisBody& body_;
};

}  // namespace taktwerk::axes
