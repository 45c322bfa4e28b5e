#pragma once
// A simulated encoder at a counter terminal: something turns it, the terminal counts, and latches where it was armed to. Built once; turn() is
// real-time safe.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class TurnedEncoder {
public:
    /// The terminal that counts, or a drive, by its objects.
    struct Device {
        std::function<void(axes::ParameterAddress, std::int64_t)> set;
        std::function<std::int64_t(axes::ParameterAddress)> get;
    };
    /// `bits`: of the object in which it counts.
    TurnedEncoder(const AxisBinding& binding, Device device, unsigned bits);

    [[nodiscard]] const std::string& axis() const noexcept { return axis_; }
    /// The axis whose motor turns it; empty: it turns by itself.
    [[nodiscard]] const std::string& turned_by() const noexcept { return simulation_.turned_by; }
    /// u: where it is so long after the start, turned by itself.
    [[nodiscard]] double by_itself(Duration since_start) const noexcept {
        return simulation_.start + simulation_.velocity * to_seconds(since_start);
    }
    /// The load is at `u` now. Without power a counter forgets what it counted.
    void turn(double u, bool powered) noexcept;
    /// The terminal says that the position does not hold, or takes it back. Meanwhile a counter counts nothing.
    void fail(bool holds_not) noexcept;

private:
    void latch(double from, double to) noexcept;
    [[nodiscard]] std::int64_t raw(double counts) const noexcept;
    void set(const axes::ParameterAddress& object, std::int64_t value) const;

    std::string axis_;
    axes::EncoderChannel channel_;
    AxisSimulation simulation_;
    Device device_;
    double counts_per_unit_;
    double turn_;  // counts between two index pulses
    bool absolute_;
    unsigned bits_;
    bool fails_ = false;
    double zero_ = 0;  // counts where the counter is 0
    std::optional<double> before_;
};

}  // namespace taktwerk::runtime
