#pragma once
// An amplifier over +-10 V with an encoder of its own as a DrivePort: it runs in cyclic velocity alone, and the axis closes the position loop. The
// encoder is a port, too; what lies on wires (volts, enable, ready, fault, switches) is taken and given once a cycle by whoever has the wires.
//
// Where the loop cannot be closed any more (its encoder does not hold, or is away, or counts the wrong way) it gets 0 V in the same cycle, so that the
// amplifier brakes by its own velocity loop, and loses its enable `stop_time` later.

#include <memory>

#include "axes/drives/analog/polarity_watch.hpp"
#include "axes/drives/analog/slope.hpp"
#include "axes/port/analog_drive.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::analog {

class AnalogPort final : public DrivePort {
public:
    /// `counts_per_unit`: of the axis, with its sense. `runaway`: u (AnalogDrive::runaway). `switches`: some of them are wired.
    AnalogPort(std::unique_ptr<DrivePort> encoder, const AnalogDrive& drive, double counts_per_unit, double runaway, bool switches);

    /// Once the encoder knows what it can.
    void join_capabilities() noexcept;

    /// Before decode(), in each cycle.
    void wires(const AnalogWiresIn& in) noexcept { in_ = in; }
    /// After encode().
    [[nodiscard]] const AnalogWiresOut& wires() const noexcept { return out_; }

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override { return encoder_->setpoint_effective(send_time); }
    [[nodiscard]] DriveAlarm alarm() const noexcept override;

private:
    enum class Stage : std::uint8_t { off, rising, on, stopping };
    void measure(const DriveFeedback& from) noexcept;
    void fall(PortFault fault) noexcept;
    [[nodiscard]] bool cause_present() const noexcept;
    [[nodiscard]] PowerState power() const noexcept;
    void step_power(PowerRequest request, Instant now) noexcept;
    void go(Stage to, Instant now) noexcept {
        stage_ = to;
        since_ = now;
    }

    std::unique_ptr<DrivePort> encoder_;
    AnalogDrive drive_;
    double volts_per_count_;  // for each count/s
    PolarityWatch polarity_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    Slope slope_;
    AnalogWiresIn in_;
    AnalogWiresOut out_;
    Stage stage_ = Stage::off;
    PowerRequest asked_ = PowerRequest::off;
    PortFault fault_ = PortFault::none;
    Instant since_{};    // of the stage
    double driven_ = 0;  // counts/s that it was told last
    double ran_away_ = 0;
};

}  // namespace taktwerk::axes::analog
