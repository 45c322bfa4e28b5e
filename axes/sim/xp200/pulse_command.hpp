#pragma once
// The command of position mode: pulses times the gear, the rest carried (manual 4.2.3).

#include <cstdint>

namespace taktwerk::axes::sim::xp200 {

class PulseCommand {
public:
    /// Command pulses, before the gear.
    void add(std::int64_t pulses) noexcept { waiting_ += pulses; }
    [[nodiscard]] bool waits() const noexcept { return waiting_ != 0; }
    /// What waits becomes way, or is lost.
    void take(std::int64_t numerator, std::int64_t denominator) noexcept {
        raw_ += waiting_;
        at_ += static_cast<double>(waiting_) * static_cast<double>(numerator) / static_cast<double>(denominator);
        waiting_ = 0;
    }
    void drop() noexcept { waiting_ = 0; }
    /// The command is where the motor is.
    void hold(double position) noexcept { at_ = position; }
    void forget_raw() noexcept { raw_ = 0; }

    [[nodiscard]] double at() const noexcept { return at_; }          ///< counts of the plant
    [[nodiscard]] std::int64_t raw() const noexcept { return raw_; }  ///< pulses since power-on

private:
    std::int64_t waiting_ = 0, raw_ = 0;
    double at_ = 0;
};

}  // namespace taktwerk::axes::sim::xp200
