#pragma once
// A counter or encoder terminal on EtherCAT as a DrivePort: it measures and latches, and takes no power. While the terminal says that its position
// does not hold nothing is fresh; a counter that was away, or did not hold, has lost pulses: its zero is another one, unless it is absolute.

#include <array>
#include <vector>

#include "axes/drives/encoder/counter_latch.hpp"
#include "axes/port/encoder_channel.hpp"
#include "core/process_image.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::encoder {

class EncoderPort final : public DrivePort {
public:
    /// `slave`: index in the bus configuration. `absolute`: it knows where it is after it was away (AxisConfig::memory).
    EncoderPort(ecat::Master& bus, std::size_t slave, EncoderChannel channel, bool absolute);

    /// Once the bus has planned its process data. Error drive.not_mapped: an object of the channel is not exchanged.
    [[nodiscard]] Result<void> resolve();

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override {
        return bus_.outputs_effective(slave_, send_time);
    }
    /// Of kind `encoder` while the terminal says that its position does not hold; it has no number for it.
    [[nodiscard]] DriveAlarm alarm() const noexcept override {
        DriveAlarm told;
        if (invalid_) told.kind = DriveAlarmKind::encoder;
        return told;
    }

private:
    struct Way {
        Signal arm, latched;
    };
    [[nodiscard]] Result<Signal> find(const ParameterAddress& address, bool output) const;
    [[nodiscard]] Result<void> find_latch();
    [[nodiscard]] bool holds() const noexcept;
    void decode_position() noexcept;
    void decode_latch() noexcept;
    [[nodiscard]] Way& way(LatchWay which) noexcept { return ways_[static_cast<std::size_t>(which)]; }

    ecat::Master& bus_;
    std::size_t slave_;
    EncoderChannel channel_;
    bool absolute_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    Signal position_, valid_, latch_;
    std::vector<Signal> errors_;
    std::array<Way, 4> ways_{};  // by LatchWay; the first is none
    CounterLatch probe_;
    Instant armed_from_{}, clear_from_{};  // when the terminal knows of it
    LatchWay sent_ = LatchWay::none;
    bool seeded_ = false, was_good_ = false, invalid_ = false;
    std::int64_t anchor_ = 0, anchor_raw_ = 0;
    Instant position_at_{};  // of the position before; none: it says nothing about a velocity
};

}  // namespace taktwerk::axes::encoder
