#pragma once
// A CiA 402 drive axis over EtherCAT behind DrivePort. What differs between vendors comes from the profile: quirks by name,
// units, timing, bit positions. One object per axis; a six-axis drive gives six, each at its object offset.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "axes/drives/cia402/alarm_reader.hpp"
#include "axes/drives/cia402/drive_on_bus.hpp"
#include "axes/drives/cia402/held_target.hpp"
#include "axes/drives/cia402/homing_answer.hpp"
#include "axes/drives/cia402/homing_setup.hpp"
#include "axes/drives/cia402/mapped_output.hpp"
#include "axes/drives/cia402/mode_request.hpp"
#include "axes/drives/cia402/position_unwrap.hpp"
#include "axes/drives/cia402/probe_latch.hpp"
#include "axes/drives/cia402/profile_handshake.hpp"
#include "axes/drives/cia402/ramp_writer.hpp"
#include "axes/drives/cia402/reset_pulse.hpp"
#include "axes/drives/cia402/settings_check.hpp"
#include "axes/drives/cia402/starting_values.hpp"
#include "axes/drives/cia402/status_reading.hpp"
#include "axes/drives/cia402/torque_limit_writer.hpp"
#include "axes/drives/cia402/turn_clearing.hpp"
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
    /// `cycle` the bus cycle (the drive interpolates over it). `wants`: with what else of the drive it must not be enabled.
    Cia402Drive(ecat::Master& bus, std::size_t slave, std::uint8_t axis, std::shared_ptr<const DriveProfile> profile, Duration cycle,
                AxisWants wants = {});

    /// Finds the mapped objects; call once the bus has laid out its process image. Errors name the missing object and the
    /// PDO that should carry it. Mapped objects that nobody writes each cycle start at what the start-up list or else the
    /// dictionary says: a zero there would override it (SE-808X 6081h, 6083h, 6084h; SV33-E 607Fh).
    [[nodiscard]] Result<void> resolve();

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override;
    [[nodiscard]] DriveAlarm alarm() const noexcept override;
    void step(Instant now) override;
    [[nodiscard]] ServiceTicket read_parameter(ParameterAddress address) override;
    [[nodiscard]] ServiceTicket write_parameter(ParameterAddress address, std::vector<std::byte> value) override;
    [[nodiscard]] ServiceTicket start_service(DriveService service) override;
    [[nodiscard]] std::optional<Result<ServiceAnswer>> service_answer(ServiceTicket ticket) override;
    [[nodiscard]] std::vector<std::string> setup_problems() const override { return settings_.problems(); }

private:
    struct OwnMode {
        DriveMode wanted;                  ///< in which the axis is moved
        std::optional<DriveMode> fixed{};  ///< the only one: 6060h and 6061h are not both in the process data
    };
    struct Outputs {
        MappedOutput control, mode, target_position, target_velocity, target_torque, velocity_offset, torque_offset, torque_max,
            torque_positive, torque_negative, digital, digital_mask, probe_function, profile_velocity, profile_acceleration,
            profile_deceleration, velocity_limit, torque_slope;
    };
    struct Inputs {
        Signal status, mode, position, velocity, torque, error, digital, probe_status;
        std::array<std::array<Signal, 2>, 2> probe_position;  // [probe][rising, falling]
    };

    [[nodiscard]] Result<void> take_own_modes(bool sends, bool shows);
    [[nodiscard]] Result<void> check_own_mode() const;
    void find_probes();
    void find_homing_setup();
    void drop_modes_without_target() noexcept;
    void collect_starting_values();
    void find_ramps();
    void find_torque_limits();
    void decode_motion() noexcept;
    void decode_homing(std::uint16_t status, Instant now) noexcept;
    void decode_probes() noexcept;
    [[nodiscard]] std::uint16_t control_word(const DriveCommand& command, bool mode_confirmed) noexcept;
    [[nodiscard]] bool profile_prepared(const DriveCommand& command, bool follows) noexcept;
    void hold_profile_target(DriveCommand& command, bool follows, bool prepared) noexcept;
    void write_targets(std::span<std::byte> image, const DriveCommand& command, bool follows) const noexcept;
    void write_limits(std::span<std::byte> image, const DriveCommand& command) const noexcept;
    void ask_torque_limits(const DriveCommand& command) noexcept;
    void write_brake(std::span<std::byte> image, bool open) const noexcept;
    void write_probes(std::span<std::byte> image, const DriveCommand& command) noexcept;

    DriveOnBus place_;
    std::shared_ptr<const DriveProfile> profile_;
    Duration interpolation_;
    StatusReading status_;
    OwnMode own_;
    Outputs out_;
    Inputs in_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    StartingValues starting_;

    bool was_online_ = false;
    PositionUnwrap position_;
    ModeRequest mode_;
    ResetPulse reset_;
    HomingAnswer homing_;
    std::array<ProbeLatch, 2> probes_{};
    HomingSetup homing_setup_;
    TurnClearing turns_;
    ProfileHandshake handshake_;
    RampWriter ramps_;
    TorqueLimitWriter torque_limits_;
    HeldTarget held_;
    AlarmReader alarm_;
    SettingsCheck settings_;
    std::atomic<bool> enabled_{false};  // for the service side
};

}  // namespace taktwerk::axes::cia402
