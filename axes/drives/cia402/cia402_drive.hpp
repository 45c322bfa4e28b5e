#pragma once
// A CiA 402 drive axis over EtherCAT behind DrivePort. What differs between vendors comes from the profile: quirks by name,
// units, timing, bit positions. One object per axis; a six-axis drive gives six, each at its object offset.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "axes/port/drive_port.hpp"
#include "axes/port/drive_profile.hpp"
#include "core/process_image.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class Cia402Drive final : public DrivePort {
public:
    /// `bus` outlives the drive. `slave` is the index in the bus configuration, `axis` the 0-based axis on that slave,
    /// `cycle` the bus cycle (the drive interpolates over it).
    Cia402Drive(ecat::Master& bus, std::size_t slave, std::uint8_t axis, std::shared_ptr<const DriveProfile> profile, Duration cycle);

    /// Finds the mapped objects; call once the bus has laid out its process image. Errors name the missing object and the
    /// PDO that should carry it.
    [[nodiscard]] Result<void> resolve();

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override;
    [[nodiscard]] DriveAlarm alarm() const noexcept override;
    void step(Instant now) override;

private:
    struct Outputs {
        Signal control, mode, target_position, target_velocity, target_torque, velocity_offset, torque_offset, torque_max,
            torque_positive, torque_negative, digital, probe_function, profile_velocity, profile_acceleration, profile_deceleration;
    };
    struct Inputs {
        Signal status, mode, position, velocity, torque, error, digital, probe_status;
        std::array<std::array<Signal, 2>, 2> probe_position;  // [probe][rising, falling]
    };

    [[nodiscard]] std::uint16_t object(std::uint16_t base) const noexcept;
    void decode_position(Instant now) noexcept;
    void decode_homing(std::uint16_t status) noexcept;
    void decode_probes() noexcept;
    void note_alarm() noexcept;
    [[nodiscard]] std::uint16_t control_word(const DriveCommand& command, bool mode_confirmed) noexcept;
    [[nodiscard]] std::uint16_t fault_reset_word() noexcept;
    void write_probes(const DriveCommand& command) noexcept;

    ecat::Master& bus_;
    std::size_t slave_;
    std::uint8_t axis_;
    std::shared_ptr<const DriveProfile> profile_;
    Duration interpolation_;
    bool fault_quirk_;
    Outputs out_;
    Inputs in_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    bool position_known_ = false;
    std::int64_t raw_position_ = 0;
    Instant position_at_{};
    std::uint32_t reset_cycle_ = 0;
    std::uint32_t homing_cycles_ = 0;   // fresh cycles since bit 4 was set; attained bits of an earlier homing are ignored
    bool homing_cleared_ = false;
    DriveAlarm alarm_;

    // The detail of an ambiguous alarm is read acyclically: the cycle names the code, the service side answers.
    std::atomic<std::uint16_t> detail_wanted_{0};
    std::atomic<std::uint64_t> detail_answer_{0};  // code << 32 | detail
    ecat::SdoTicket detail_ticket_ = 0;
    std::uint16_t detail_asked_ = 0;
};

}  // namespace taktwerk::axes::cia402
