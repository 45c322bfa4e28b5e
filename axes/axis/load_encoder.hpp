#pragma once
// A second encoder at the load: how far the load is from where the motor says it is. It is compared, and shown where the machine file wants it; the
// position loop stays the drive's, on the motor.
//
// Only differences count: both begin alike when the axis first hears of both, and again after whatever gives the motor's counts another zero (its drive was
// away, or homed) and after a reset of this alarm. Bounded, real-time safe.

#include <cmath>
#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/following_error.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class LoadEncoder {
public:
    LoadEncoder(AxisBody& body, const Measured& measured, Conduct& conduct) noexcept
        : body_(body), measured_(measured), conduct_(conduct) {}

    /// Once a cycle, where the axis has one.
    void watch() noexcept {
        const auto& config = body_.config.load_encoder;
        if (!measured_.seeded || config.input >= body_.scene.inputs.size()) return;
        count(body_.scene.inputs[config.input]);
        const auto& feedback = measured_.feedback;
        if (failed_ && body_.state != AxisState::ErrorStop) aligned_ = failed_ = false;
        const bool other_zero = feedback.position_epoch != epoch_ || !measured_.online() || feedback.mode == DriveMode::homing;
        if (!aligned_ || other_zero) align();
        if (!feedback.fresh) return;
        const double load =
            static_cast<double>(counts_ - counts_at_) / (config.inverted ? -config.counts_per_unit : config.counts_per_unit);
        const double motor = static_cast<double>(measured_.counts - motor_at_) / body_.units.counts_per_unit();
        difference_ = load - motor;
        const bool beyond = body_.power.on() && std::abs(difference_) > config.tolerance;
        if (!beyond) {
            timer_.clear();
            if (!body_.alarms.active().empty()) conduct_.warning_is_over(AxisAlarm::load_deviation);
        } else if (timer_.lasts(feedback.latched, config.time) && body_.state != AxisState::ErrorStop) {
            conduct_.fail(AxisAlarm::load_deviation, difference_, config.tolerance);
            failed_ = body_.state == AxisState::ErrorStop;
            if (failed_) body_.homed = false;  // nobody knows which of the two is right
        }
    }
    /// u that the load is ahead of the motor.
    [[nodiscard]] double difference() const noexcept { return difference_; }

private:
    void align() noexcept {
        aligned_ = true;
        epoch_ = measured_.feedback.position_epoch;
        counts_at_ = counts_;
        motor_at_ = measured_.counts;
        difference_ = 0;
        timer_.clear();
    }
    /// On from the count before, whichever way is shorter.
    void count(std::int64_t raw) noexcept {
        const unsigned unused = 64u - body_.config.load_encoder.bits;
        const auto way = static_cast<std::uint64_t>(raw) - static_cast<std::uint64_t>(raw_);
        counts_ += static_cast<std::int64_t>(way << unused) >> unused;
        raw_ = raw;
    }

    AxisBody& body_;
    const Measured& measured_;
    Conduct& conduct_;
    FollowingErrorTimer timer_;
    std::int64_t raw_ = 0, counts_ = 0;          // as read; without end
    std::int64_t counts_at_ = 0, motor_at_ = 0;  // where both began alike
    double difference_ = 0;
    std::uint16_t epoch_ = 0;
    bool aligned_ = false, failed_ = false;
};

}  // namespace taktwerk::axes
