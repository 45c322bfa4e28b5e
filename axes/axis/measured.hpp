#pragma once
// What the drive says, and what it means for the axis: where the load is, whether it stands, which switches it is on.

#include <cmath>
#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/compensation.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

struct Measured {
    explicit Measured(const AxisBody& of_axis);

    const AxisBody& body;
    DriveFeedback feedback;
    bool seeded = false;      ///< an actual position has arrived
    std::uint32_t stale = 0;  ///< cycles since the last one
    std::uint32_t stale_limit;
    std::int64_t counts = 0;  ///< the newest actual position
    std::uint16_t position_epoch = 0, reference_epoch = 0;
    bool negative_switch = false, positive_switch = false;  ///< in the axis' sense
    Compensation compensation;

    [[nodiscard]] bool online() const noexcept { return seeded && feedback.online && stale <= stale_limit; }
    [[nodiscard]] bool faulted() const noexcept {
        return feedback.fault || feedback.power == PowerState::fault || feedback.power == PowerState::fault_reaction;
    }
    [[nodiscard]] bool stands() const noexcept {
        return std::abs(feedback.velocity) <= body.config.windows.standstill_velocity * std::abs(body.units.counts_per_unit());
    }
    /// u, local: of the load, where compensation tells it apart from the motor.
    [[nodiscard]] double local() const noexcept {
        const double motor = body.units.local(counts);
        return compensation.none() ? motor : compensated(motor);
    }
    [[nodiscard]] double velocity() const noexcept { return feedback.velocity / body.units.counts_per_unit(); }
    [[nodiscard]] double motor_velocity() const noexcept { return stands() ? 0 : velocity(); }
    [[nodiscard]] double torque() const noexcept { return body.config.gearing.inverted ? -feedback.torque : feedback.torque; }

    /// Neither a switch nor whoever gave power is in the way.
    [[nodiscard]] bool permitted(double direction) const noexcept;
    [[nodiscard]] bool absolute_encoder() const noexcept {
        return body.config.memory.absolute || body.port.capabilities().absolute_encoder;
    }
    /// counts, after which the encoder begins anew.
    [[nodiscard]] std::int64_t encoder_range() const noexcept;
    /// counts; the encoder's (or the drive's) own zero. Its raw position may have wrapped: zero is the nearest multiple of the range.
    [[nodiscard]] std::int64_t encoder_zero() const noexcept;

private:
    [[nodiscard]] double compensated(double motor) const noexcept;
};

}  // namespace taktwerk::axes
