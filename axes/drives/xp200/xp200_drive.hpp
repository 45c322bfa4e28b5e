#pragma once
// An XP200 behind DrivePort. The cycle writes a wish and reads the newest sample, both without waiting; the schedule of the line turns the
// one into requests and the answers into the other, on the service side. Positioning is the axis' business: it closes its loop over speed.
//
// Torque where Pr004 = 5 and Pr164 = 1 are asked for (schedule.hpp); its velocity is the drive's to keep (Pr078).
// Not supported over this port, and refused by the axis or here: cyclic set-points (couplings, cams, fed set-points, profiles over time),
// homing by the drive, touch probes, torque limits, outputs, clearing turns, restoring defaults.

#include "axes/drives/xp200/schedule.hpp"
#include "axes/port/drive_port.hpp"
#include "core/latest_value.hpp"

namespace taktwerk::axes::xp200 {

class Xp200Drive final : public DrivePort {
public:
    /// `line`: what the requests travel on, for the times they take.
    Xp200Drive(DriveConfig config, const modbus::LineSettings& line);

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override { return send_time + usual_latency_; }
    [[nodiscard]] DriveAlarm alarm() const noexcept override;

    [[nodiscard]] ServiceTicket read_parameter(ParameterAddress address) override;
    [[nodiscard]] ServiceTicket write_parameter(ParameterAddress address, std::vector<std::byte> value) override;
    [[nodiscard]] ServiceTicket start_service(DriveService service) override;
    [[nodiscard]] std::optional<Result<ServiceAnswer>> service_answer(ServiceTicket ticket) override;
    [[nodiscard]] std::vector<std::string> setup_problems() const override { return schedule_.problems(); }

    // --- the line's side ----------------------------------------------------------------------------------------------------
    [[nodiscard]] std::optional<modbus::Request> next_request(Instant now);
    [[nodiscard]] bool urgent() noexcept;
    void take(const modbus::Answer& answer, Instant now);
    [[nodiscard]] const DriveConfig& config() const noexcept { return config_; }

    /// Real-time safe, cycle side: the line has been heard lately and the axis may move. What the watchdog output follows.
    [[nodiscard]] bool supervised(Instant now) const noexcept;
    /// Cycle side, for the recording: the newest sample, and what is asked for.
    [[nodiscard]] const Sample& newest() const noexcept { return newest_; }
    [[nodiscard]] const Wish& wish() const noexcept { return wish_; }
    /// In the place of the line, where it is not asked: the drive says this.
    void replay(const Sample& sample) noexcept;

private:
    [[nodiscard]] double turns_per_minute(double counts_per_second) const noexcept {
        return counts_per_second * 60 / static_cast<double>(config_.counts_per_turn);
    }
    [[nodiscard]] ServiceTicket start(const modbus::Request& request);

    const DriveConfig config_;
    Schedule schedule_;
    DriveCapabilities capabilities_;
    Duration usual_latency_{};

    // cycle side
    DriveFeedback feedback_;
    Sample newest_;
    Wish wish_;
    std::int16_t speed_ = 0;      // as sent last, for the rounding
    std::uint16_t seen_off_ = 0;  // Wish::session

    LatestValue<Wish> wishes_;
    LatestValue<Sample> samples_;

    // line side
    struct Open {
        ServiceTicket ticket = 0;
        std::optional<modbus::Answer> answer;
    };
    std::vector<Open> open_;
    ServiceTicket last_ticket_ = 0;
    std::uint32_t revision_ = 0;
};

}  // namespace taktwerk::axes::xp200
