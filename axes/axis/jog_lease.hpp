#pragma once
// A jog lives by its lease: whoever holds the key renews it.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;

class JogLease {
public:
    JogLease(AxisBody& body, const Measured& measured, Aim& aim, Conduct& conduct) noexcept
        : body_(body), measured_(measured), aim_(aim), conduct_(conduct) {}

    void watch() noexcept;
    ErrorId renew(CommandId id, double velocity) noexcept;
    void begin() noexcept;

    [[nodiscard]] bool expired() const noexcept { return expired_; }

private:
    AxisBody& body_;
    const Measured& measured_;
    Aim& aim_;
    Conduct& conduct_;

    Instant renewed_{};
    bool expired_ = false;
};

}  // namespace taktwerk::axes
