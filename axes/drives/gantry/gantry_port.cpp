#include "axes/drives/gantry/gantry_port.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::axes::gantry {

namespace {

/// How far a drive is on its way to `enabled`; whatever is none of that way is behind it.
int progress(PowerState state) noexcept {
    switch (state) {
        case PowerState::enabled: return 5;
        case PowerState::quick_stop: return 4;
        case PowerState::switched_on: return 3;
        case PowerState::ready: return 2;
        case PowerState::disabled: return 1;
        default: return 0;
    }
}

bool faulted(const DriveFeedback& side) noexcept {
    return side.fault || side.power == PowerState::fault || side.power == PowerState::fault_reaction;
}

}  // namespace

GantryPort::GantryPort(std::unique_ptr<DrivePort> leader, std::unique_ptr<DrivePort> follower, bool mirrored)
    : leader_(std::move(leader)), follower_(std::move(follower)), mirrored_(mirrored) {
    join_capabilities();
}

void GantryPort::join_capabilities() noexcept {
    const auto& one = leader_->capabilities();
    const auto& other = follower_->capabilities();
    auto& both = capabilities_;
    both = one;
    both.modes = static_cast<std::uint16_t>(one.modes & other.modes & (1u << static_cast<unsigned>(DriveMode::cyclic_position)));
    both.velocity_feed_forward = one.velocity_feed_forward && other.velocity_feed_forward;
    both.torque_feed_forward = one.torque_feed_forward && other.torque_feed_forward;
    both.torque_limits = one.torque_limits && other.torque_limits;
    both.digital_outputs = both.drive_homing = both.homing_per_run = both.brake = both.velocity_limit = false;
    both.absolute_encoder = one.absolute_encoder && other.absolute_encoder;
    both.rated_velocity = std::min(one.rated_velocity, other.rated_velocity);
    both.minimum_cycle = std::max(one.minimum_cycle, other.minimum_cycle);
    both.enable_delay = std::max(one.enable_delay, other.enable_delay);
    both.services = both.profile_buffer = 0;
}

const DriveFeedback& GantryPort::decode(Instant now) noexcept {
    const auto& one = leader_->decode(now);
    const auto& other = follower_->decode(now);
    auto& both = feedback_;
    both = one;
    both.fresh = one.fresh && other.fresh;
    both.online = one.online && other.online;
    both.age = std::max(one.age, other.age);
    both.latched = std::min(one.latched, other.latched);
    both.mode = one.mode == other.mode ? one.mode : DriveMode::none;
    both.fault = one.fault || other.fault;
    both.warning = one.warning || other.warning;
    both.main_power = one.main_power && other.main_power;
    if (one.error_code == 0) both.error_code = other.error_code;
    both.torque = (one.torque + (mirrored_ ? -other.torque : other.torque)) / 2;
    // Either zero that changes may have changed the one between them.
    both.position_epoch = static_cast<std::uint16_t>(one.position_epoch + other.position_epoch);
    both.reference_epoch = static_cast<std::uint16_t>(one.reference_epoch + other.reference_epoch);
    both.commands_acknowledged = one.commands_acknowledged && other.commands_acknowledged;
    both.setup_refused = one.setup_refused || other.setup_refused;
    both.profile_accepted = 0;
    both.negative_limit = one.negative_limit || (mirrored_ ? other.positive_limit : other.negative_limit);
    both.positive_limit = one.positive_limit || (mirrored_ ? other.negative_limit : other.positive_limit);
    follower_at_ = other.position;
    leader_power_ = one.power;
    follower_home_switch_ = other.home_switch;
    if (both.position_epoch != square_epoch_) square_known_ = false;  // its counts mean something else now
    follower_power_ = other.power;
    skew_ = static_cast<double>(turned(other.position) - one.position - (square_known_ ? square_ : shift_));
    join_power(one, other);
    return both;
}

void GantryPort::join_power(const DriveFeedback& one, const DriveFeedback& other) noexcept {
    const bool first = one.power == PowerState::enabled, second = other.power == PowerState::enabled;
    if (asked_ == PowerRequest::off) {
        both_had_power_ = false;
        fallen_ = Fallen::none;
    }
    both_had_power_ = both_had_power_ || (asked_ != PowerRequest::off && first && second);
    if (both_had_power_ && asked_ == PowerRequest::on && first != second && fallen_ == Fallen::none)
        fallen_ = first ? Fallen::follower : Fallen::leader;
    side_lost_ = asked_ == PowerRequest::on && ((fallen_ == Fallen::follower && first) || (fallen_ == Fallen::leader && second));
    if (side_lost_) feedback_.power = PowerState::enabled;  // the one that has power is to ramp down with it
    else if (faulted(one) || faulted(other)) feedback_.power = faulted(one) ? one.power : other.power;
    else if (asked_ == PowerRequest::quick_stop) feedback_.power = progress(one.power) >= progress(other.power) ? one.power : other.power;
    else feedback_.power = progress(one.power) <= progress(other.power) ? one.power : other.power;
    if (first != second && asked_ != PowerRequest::quick_stop) feedback_.mode = first ? one.mode : other.mode;
    const bool supervised = first && second;
    if (!supervised && !side_lost_) skew_ = 0;
}

void GantryPort::square(std::int64_t further, const SquaringPace& pace) noexcept {
    const auto between = turned(follower_at_) - feedback_.position;
    square_ = between + further;
    square_known_ = true;
    square_epoch_ = feedback_.position_epoch;
    pace_ = pace;
    squaring_.begin(shift_, square_, pace);
}

/// What has no power is where it is. With power it is led to square, if that is known.
void GantryPort::lead_to_square(Instant now) noexcept {
    const bool powered = follower_power_ == PowerState::enabled && feedback_.power == PowerState::enabled && !side_lost_;
    if (powered && !has_had_power_ && square_known_ && square_ != shift_) squaring_.begin(shift_, square_, pace_);
    if (!powered && !side_lost_) squaring_.forget();
    if (side_lost_ || asked_ != PowerRequest::on) squaring_.stop();
    has_had_power_ = powered;
    if (squaring_.under_way() && encoded_ != Instant{}) shift_ = squaring_.step(now - encoded_);
    encoded_ = now;
}

void GantryPort::encode(const DriveCommand& command, Instant now) noexcept {
    asked_ = command.power;
    const bool on = asked_ == PowerRequest::on;
    auto one = command;
    if (on && fallen_ == Fallen::leader) one.power = request_of_fallen();
    const bool alone = on && leader_power_ == PowerState::enabled && follower_power_ != PowerState::enabled && !both_had_power_;
    if (alone) one.position = held_;  // the axis' set-point still follows the motor: that would give way to any load
    else held_ = command.position;
    leader_->encode(one, now);

    auto other = command;
    if (on && fallen_ == Fallen::follower) other.power = request_of_fallen();
    // Until it has power it is where it is: with its power it gets this as its target.
    if (follower_power_ != PowerState::enabled && follower_power_ != PowerState::quick_stop && !side_lost_)
        shift_ = turned(follower_at_) - command.position;
    lead_to_square(now);
    other.position = turned(command.position + shift_);
    if (mirrored_) {
        other.velocity = -command.velocity;
        other.torque = -command.torque;
        std::swap(other.torque_limit_positive, other.torque_limit_negative);
    }
    other.probes = {};
    other.start_homing = false;
    follower_->encode(other, now);
}

/// Its set-point has gone on without it: with power it would jump there. A quick stop of its own it may finish.
PowerRequest GantryPort::request_of_fallen() const noexcept {
    const auto power = fallen_ == Fallen::leader ? leader_power_ : follower_power_;
    return power == PowerState::quick_stop ? PowerRequest::quick_stop : PowerRequest::off;
}

DriveAlarm GantryPort::alarm() const noexcept {
    const auto one = leader_->alarm();
    return one.code != 0 ? one : follower_->alarm();
}

void GantryPort::step(Instant now) {
    leader_->step(now);
    follower_->step(now);
}

std::vector<std::string> GantryPort::setup_problems() const {
    auto out = leader_->setup_problems();
    for (auto& problem : follower_->setup_problems()) out.push_back("follower: " + problem);
    return out;
}

}  // namespace taktwerk::axes::gantry
