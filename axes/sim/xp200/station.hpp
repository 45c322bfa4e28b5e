#pragma once
// The Modbus slave of a simulated XP200 (manual 9.3 to 9.6): hears frames, asks the servo, answers or stays silent. Which condition gives
// which exception the manual does not say; the choices stand at their places.

#include "axes/sim/xp200/servo.hpp"
#include "modbus/line/station.hpp"

namespace taktwerk::axes::sim::xp200 {

class Drive final : public modbus::Station {
public:
    Drive(const DriveProfile& profile, const PlantConfig& plant, const Options& options = {}) : servo_(profile, plant, options) {}

    [[nodiscard]] Servo& servo() noexcept { return servo_; }
    [[nodiscard]] const Servo& servo() const noexcept { return servo_; }

    void advance(Instant now) override { servo_.advance(now); }
    bool hear(std::span<const std::byte> frame, Instant now, modbus::Frame& answer) override;
    [[nodiscard]] Duration turnaround() const noexcept override { return servo_.options().turnaround; }
    /// Pr182 and Pr183 as they counted at the last restart.
    [[nodiscard]] modbus::LineSettings line() const noexcept override;

private:
    [[nodiscard]] modbus::ExceptionCode execute(const modbus::Request& request, std::array<std::uint16_t, modbus::words_in_frame>& words);
    [[nodiscard]] modbus::ExceptionCode read(const modbus::Request& request, std::array<std::uint16_t, modbus::words_in_frame>& words);
    [[nodiscard]] modbus::ExceptionCode write(const modbus::Request& request);

    Servo servo_;
};

}  // namespace taktwerk::axes::sim::xp200
