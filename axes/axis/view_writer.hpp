#pragma once
// Writes what everybody else sees of an axis. In parts, since a cycle changes them at different points; who shifts coordinates writes all.

#include "axes/axis/axis_view.hpp"

namespace taktwerk::axes {

class AxisCore;

class ViewWriter {
public:
    ViewWriter(AxisCore& axis, AxisView& view);

    void publish() noexcept;
    /// State, owner, error, commands: what any call may change.
    void states() noexcept;
    void resets() noexcept;
    void probes() noexcept;
    void passive_homing() noexcept;
    void brake() noexcept;
    void skew() noexcept;
    void load() noexcept;
    void feedback(double actual) noexcept;
    void setpoint() noexcept;
    /// Local: of a drive that makes the profile.
    void target(double place) noexcept;
    /// Nobody moves or locks the axis any more.
    void no_holder() noexcept { view_.holder = nullptr; }

private:
    void side(SideSlot slot, CommandId id) noexcept { view_.side[static_cast<std::size_t>(slot)] = id; }
    void couplings() noexcept;

    AxisCore& axis_;
    AxisView& view_;
};

}  // namespace taktwerk::axes
