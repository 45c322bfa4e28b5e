#pragma once
// A drive without a bus: follows its target exactly, one cycle later. For purely virtual axes and for axes that are taken out
// one by one while commissioning (`simulated: true`). Its switches never answer; homing it is `set_here`.

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::sim {

class VirtualDrive final : public DrivePort {
public:
    explicit VirtualDrive(Duration cycle) noexcept : cycle_(cycle) {
        capabilities_.modes = 1u << static_cast<unsigned>(DriveMode::cyclic_position);
        capabilities_.motor_has_encoder = false;
        feedback_.online = true;
        feedback_.power = PowerState::disabled;
        feedback_.mode = DriveMode::cyclic_position;
    }
    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override {
        feedback_.fresh = true;
        feedback_.latched = now;
        feedback_.velocity = static_cast<double>(target_ - feedback_.position) / to_seconds(cycle_);
        feedback_.position = target_;
        return feedback_;
    }
    void encode(const DriveCommand& command, Instant) noexcept override {
        const bool on = command.power == PowerRequest::on;
        if (on && feedback_.power == PowerState::enabled) target_ = command.position;
        feedback_.power = on ? PowerState::enabled : PowerState::disabled;
    }
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override { return send_time + cycle_; }
    [[nodiscard]] DriveAlarm alarm() const noexcept override { return {}; }

private:
    Duration cycle_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    std::int64_t target_ = 0;
};

}  // namespace taktwerk::axes::sim
