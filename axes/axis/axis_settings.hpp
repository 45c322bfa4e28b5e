#pragma once
// What is set of an axis beside motion, at once or in its turn behind motion.

#include <utility>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Aim;
class AxisCoupling;
class AxisParameters;
class Conduct;
class GivenMotion;
class SuperimposedMotion;

class AxisSettings {
public:
    AxisSettings(AxisBody& body, const Measured& measured, AxisMotion& motion, SuperimposedMotion& addition, Aim& aim, GivenMotion& given,
                 Conduct& conduct, AxisCoupling& coupling, AxisParameters& parameters) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          addition_(addition),
          aim_(aim),
          given_(given),
          conduct_(conduct),
          coupling_(coupling),
          parameters_(parameters) {}

    /// With nothing before it its turn is now. It waits behind motion in any state, moves nothing and changes no state.
    Submitted submit(const AxisCommand& command, Owner owner) noexcept;
    void carry_out(const AcceptedCommand& setting) noexcept;
    /// A motion without end lets pass what waits behind it once it is at its velocity, and goes on.
    void carry_out_due() noexcept;
    ErrorId apply(const AxisSetting& setting, Owner owner) noexcept;
    /// Whoever owns the axis.
    ErrorId set_operators_override(double factor) noexcept;

    /// Once: something was set that the whole view shows.
    [[nodiscard]] bool changed() noexcept { return std::exchange(changed_, false); }

private:
    ErrorId set_position(const SetPosition& wanted) noexcept;
    ErrorId feed_in(const SetpointFeed& fed) noexcept;
    ErrorId set_override(const Override& factors) noexcept;
    void override_changed() noexcept;
    ErrorId set_brake(const SetBrake& wanted) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    GivenMotion& given_;
    Conduct& conduct_;
    AxisCoupling& coupling_;
    AxisParameters& parameters_;

    bool changed_ = false;
};

}  // namespace taktwerk::axes
