#pragma once
// The target of PV and PT: the set-point itself, so the old one stays while the ramps of the next are being written. Real-time safe.

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::cia402 {

class HeldTarget {
public:
    void forget() noexcept { velocity_ = torque_ = 0; }
    void take(const DriveCommand& command) noexcept {
        velocity_ = command.velocity;
        torque_ = command.torque;
    }
    void put(DriveCommand& command) const noexcept {
        command.velocity = velocity_;
        command.torque = torque_;
    }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    [[nodiscard]] double torque() const noexcept { return torque_; }

private:
    double velocity_ = 0, torque_ = 0;
};

}  // namespace taktwerk::axes::cia402
