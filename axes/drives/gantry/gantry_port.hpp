#pragma once
// Two drives on one rigid portal as one drive port. Positions are the leader's counts; the follower's are turned and shifted into them.
//
//   set-point    the same for both, in each cycle; the follower's is shifted by what lay between the two when it got its power, so nothing jumps
//   power        both are asked for it together; the axis sees the lesser of the two states
//                one that has it before the other holds its place
//   a side falls fault, or power lost while the other has it: the axis is told (fault, side_lost) and sees the other as enabled, so that this one ramps
//                down with the set-point instead of being let go; the fallen one stays without until power was given back for both
//   skew         how far the follower is ahead of the leader, beyond what lay between them when power came, or, once homing has found it, beyond what lies
//                between them where the portal is square
//   square       known until a drive was away; the follower is led there when it is found, and whenever power comes
//
// Only cyclic position: what a drive plans by itself, two drives plan differently. Real-time safe where DrivePort is.

#include <memory>

#include "axes/drives/gantry/squaring.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::gantry {

class GantryPort final : public DrivePort {
public:
    /// `mirrored`: the follower is mounted the other way round.
    GantryPort(std::unique_ptr<DrivePort> leader, std::unique_ptr<DrivePort> follower, bool mirrored);

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return capabilities_; }
    const DriveFeedback& decode(Instant now) noexcept override;
    void encode(const DriveCommand& command, Instant now) noexcept override;
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override { return leader_->setpoint_effective(send_time); }
    /// The leader's, or the follower's where only that one has one.
    [[nodiscard]] DriveAlarm alarm() const noexcept override;
    [[nodiscard]] double skew() const noexcept override { return skew_; }
    [[nodiscard]] bool side_lost() const noexcept override { return side_lost_; }
    [[nodiscard]] bool follower_home_switch() const noexcept override { return follower_home_switch_; }
    void square(std::int64_t further, const SquaringPace& pace) noexcept override;
    void stop_squaring() noexcept override { squaring_.stop(); }
    [[nodiscard]] bool squaring() const noexcept override { return squaring_.under_way(); }

    void step(Instant now) override;
    [[nodiscard]] ServiceTicket read_parameter(ParameterAddress address) override { return leader_->read_parameter(address); }
    [[nodiscard]] ServiceTicket write_parameter(ParameterAddress address, std::vector<std::byte> value) override {
        return leader_->write_parameter(address, std::move(value));
    }
    [[nodiscard]] std::optional<Result<ServiceAnswer>> service_answer(ServiceTicket ticket) override {
        return leader_->service_answer(ticket);
    }
    [[nodiscard]] std::vector<std::string> setup_problems() const override;

    /// alarm() is the follower's.
    [[nodiscard]] bool of_the_follower() const noexcept { return leader_->alarm().code == 0 && follower_->alarm().code != 0; }
    /// What the drives can do together; again once a bus is laid out.
    void join_capabilities() noexcept;

private:
    [[nodiscard]] std::int64_t turned(std::int64_t counts) const noexcept { return mirrored_ ? -counts : counts; }
    void lead_to_square(Instant now) noexcept;
    void join_power(const DriveFeedback& one, const DriveFeedback& other) noexcept;
    /// What a side that fell is asked for while the other one ramps down.
    [[nodiscard]] PowerRequest request_of_fallen() const noexcept;

    std::unique_ptr<DrivePort> leader_, follower_;
    bool mirrored_;
    DriveCapabilities capabilities_;
    DriveFeedback feedback_;
    double skew_ = 0;
    bool side_lost_ = false;
    std::int64_t shift_ = 0;   // follower's counts, turned, minus the leader's: when it got its power, and as far as it has been led since
    std::int64_t square_ = 0;  // the same where the portal is square
    bool square_known_ = false, has_had_power_ = false;
    std::uint16_t square_epoch_ = 0;  // of the positions from which it is known
    SquaringPace pace_;
    Squaring squaring_;
    Instant encoded_{};
    bool follower_home_switch_ = false;
    std::int64_t follower_at_ = 0;
    std::int64_t held_ = 0;  // what the leader was told last before it got its power
    PowerState leader_power_ = PowerState::unknown, follower_power_ = PowerState::unknown;
    enum class Fallen : std::uint8_t { none, leader, follower } fallen_ = Fallen::none;
    bool both_had_power_ = false;  // since it was asked for
    PowerRequest asked_ = PowerRequest::off;
};

}  // namespace taktwerk::axes::gantry
