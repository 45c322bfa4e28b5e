#pragma once
// What a drive is told through real frames agrees with what its axis shows, in every cycle. From the process data a command is read back and
// given, with the view, to the one oracle of motion (tests/axes/axis/motion_oracle.hpp); what only the process data can break is looked at here:
//
//   6040h   an axis with power is told "enable operation"; homing and set-points of the drive are started (bit 4) by none but those who may; a
//           reset (bit 7) only while one was asked for; who is Disabled is not left enabled
//   6060h   the mode of what the axis does; once it rests, its own mode again
//   607Ah   the set position; while the drive does not follow it: where the motor is, so that nothing steps when it begins to follow
//   60FFh   nothing but in a mode of velocity
//   6071h   nothing but in a mode of torque
//   all     what the slave received is what was sent to it

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "axes/drives/cia402/words.hpp"
#include "tests/axes/axis/motion_oracle.hpp"
#include "tests/runtime/told_drive.hpp"

namespace taktwerk::runtime::testing {

class DriveOracle {
public:
    DriveOracle(const AxisBinding& binding, Duration cycle)
        : config_(binding.axis),
          motion_(binding.axis, cycle, binding.profile ? binding.profile->mode_rules.change_delay : Duration{}),
          counts_(binding.axis.gearing.counts_per_unit()),
          patience_(static_cast<int>(patience / cycle)) {
        if (!binding.profile) return;
        velocity_unit_ = binding.profile->velocity_counts_per_unit;
        position_bits_ = binding.profile->position_bits;
        patience_ += static_cast<int>((binding.profile->enable_delay + binding.profile->mode_rules.change_interval) / cycle);
        motion_.velocity_grain(0.51 / velocity_unit_);
    }

    /// Of an axis without a drive on the bus.
    void observe(const axes::AxisView& view) { motion_.observe(view); }
    /// After each cycle. `fresh`: the drive's answer is of this cycle.
    void observe(const axes::AxisView& view, const ToldDrive& told, bool fresh) {
        motion_.observe(view, command_of(view, told));
        check_control(view, told);
        check_mode(view, told);
        check_targets(view, told, fresh);
        before_ = told;
        from_ = {view.state, view.active_kind};
    }
    /// What the slave has is what was sent to it last, or just before: it takes its outputs with SYNC0. Only while frames reach it. `due`: in this
    /// cycle an answer was due, so the outputs of the cycle before did go out.
    void arrived(const ToldDrive& there, const ToldDrive& told, bool due) {
        if (due) {
            std::rotate(sent_.rbegin(), sent_.rbegin() + 1, sent_.rend());
            sent_[0] = newest_;
            ++known_;
        }
        newest_ = told;
        if (known_ <= static_cast<int>(sent_.size())) return;
        ++compared_;
        if (there.tells_like(told)) return;
        for (const auto& one : sent_)
            if (there.tells_like(one)) return;
        breach("the drive has 6040h {:04X}h 6060h {} 607Ah {}, it was sent 6040h {:04X}h 6060h {} 607Ah {}", there.control, there.mode,
               there.position.value_or(0), told.control, told.mode, told.position.value_or(0));
    }
    /// Frames are lost, or the slave is not in OP.
    void out_of_reach() { known_ = 0; }

    [[nodiscard]] bool clean() const { return motion_.clean() && breaches_ == 0; }
    [[nodiscard]] std::string report() const { return motion_.report() + report_; }
    /// Cycles in which what arrived was compared: the positive control, beside motion().compared().
    [[nodiscard]] long compared() const { return compared_; }
    [[nodiscard]] const axes::test::MotionOracle& motion() const { return motion_; }
    /// From here on nothing is said any more; for what a test does from outside, with the reason.
    void look_away(const char* reason) {
        away_ = reason;
        motion_.look_away(reason);
    }

private:
    template <class... Args>
    void breach(fmt::format_string<Args...> text, Args&&... args) {
        if (away_ != nullptr || ++breaches_ > 5) return;
        report_ += fmt::format("cycle {}, axis {}: ", motion_.cycles(), config_.name);
        report_ += fmt::format(text, std::forward<Args>(args)...);
        report_ += '\n';
    }

    [[nodiscard]] axes::DriveCommand command_of(const axes::AxisView& view, const ToldDrive& told) {
        axes::DriveCommand command;
        command.power = told.enables() ? axes::PowerRequest::on : axes::PowerRequest::off;
        // Who is told to leave "operation enabled" takes no target any more: its target is where the motor is (axes/drives/cia402/encode.cpp).
        command.mode = told.enables() ? axes::cia402::mode_of(told.mode) : axes::DriveMode::none;
        if (told.position) {
            const unsigned unused = 64u - position_bits_;
            const auto way = static_cast<std::uint64_t>(*told.position) - static_cast<std::uint64_t>(position_);
            position_ += static_cast<std::int64_t>(way << unused) >> unused;
        }
        command.position = position_;
        // What does not go with the frames cannot contradict.
        const bool by_velocity = command.mode == axes::DriveMode::cyclic_velocity;
        const auto& sent = by_velocity ? told.velocity : told.velocity_offset;
        command.velocity = sent ? static_cast<double>(*sent) / velocity_unit_ : config_.control.feed_forward * view.set_velocity * counts_;
        return command;
    }

    void check_control(const axes::AxisView& view, const ToldDrive& told) {
        using State = axes::AxisState;
        const bool runs = view.state != State::Disabled && view.state != State::ErrorStop;
        if (runs && view.powered && view.online && view.drive_state == axes::PowerState::enabled && !told.enables())
            breach("is in {}, its drive is told {:04X}h", axes::name(view.state), told.control);
        const bool left_on =
            view.state == State::Disabled && view.online && view.drive_state == axes::PowerState::enabled && told.enables();
        left_on_ = left_on ? left_on_ + 1 : 0;
        if (left_on_ == patience_) breach("is Disabled, its drive runs and is told to");
        const bool start = (told.control & 0x10) != 0;
        const auto mode = axes::cia402::mode_of(told.mode);
        if (start && mode == axes::DriveMode::homing && !either(view.state, State::Homing))
            breach("is in {}, its drive is told to home", axes::name(view.state));
        if (start && mode == axes::DriveMode::profile_position && !(before_.control & 0x10) && !by_drive(view.active_kind))
            breach("runs no profile of the drive, which gets a set-point all the same");
        if (start && mode != axes::DriveMode::homing && mode != axes::DriveMode::profile_position)
            breach("tells its drive {:04X}h in mode {}", told.control, told.mode);
        if ((told.control & 0x80) != 0 && !view.resetting && view.state != State::ErrorStop)
            breach("is in {}, its drive is told to reset", axes::name(view.state));
    }

    void check_mode(const axes::AxisView& view, const ToldDrive& told) {
        using Mode = axes::DriveMode;
        const auto mode = axes::cia402::mode_of(told.mode);
        const bool own = mode == Mode::cyclic_position || mode == Mode::cyclic_velocity;
        if (mode == Mode::none) return breach("tells its drive mode {}", told.mode);
        // Into another mode with the command that wants it; out of it when the motor has stopped, or another mode goes on from there.
        const bool changed = told.mode != before_.mode;
        const bool wanted = (mode == Mode::homing && view.state == axes::AxisState::Homing) ||
                            (mode == Mode::cyclic_torque && (view.active_kind == axes::CommandKind::torque ||
                                                             view.active_kind == axes::CommandKind::set_controller_mode)) ||
                            by_drive(view.active_kind) || waits_to_leave(view);
        if (changed && !own && !wanted) breach("is in {}, its drive is told mode {}", axes::name(view.state), told.mode);
        const bool rests = view.state == axes::AxisState::Standstill && view.online && view.powered;
        apart_ = rests && told.mode != told.shown_mode ? apart_ + 1 : 0;
        if (apart_ == patience_) breach("stands still, its drive is told mode {} and shows {}", told.mode, told.shown_mode);
        resting_ = rests && (mode == Mode::homing || by_profile(mode)) ? resting_ + 1 : 0;
        if (resting_ == patience_) breach("stands still, its drive is left in mode {}", told.mode);
    }

    void check_targets(const axes::AxisView& view, const ToldDrive& told, bool fresh) {
        const bool velocity = of_velocity(told.mode) || of_velocity(told.shown_mode) || of_velocity(before_.shown_mode);
        if (told.velocity.value_or(0) != 0 && !velocity) breach("tells its drive 60FFh {} in mode {}", *told.velocity, told.mode);
        const bool torque = of_torque(told.mode) || of_torque(told.shown_mode) || of_torque(before_.shown_mode);
        if (told.torque.value_or(0) != 0 && !torque) breach("tells its drive 6071h {} in mode {}", *told.torque, told.mode);
        if (!told.position || !fresh || view.drive_state == axes::PowerState::enabled) return;
        if (*told.position != told.actual_position)
            breach("the drive is {}, its target 607Ah is {} and the motor at {}", axes::name(view.drive_state), *told.position,
                   told.actual_position);
    }

    [[nodiscard]] bool either(axes::AxisState now, axes::AxisState state) const { return now == state || from_.state == state; }
    [[nodiscard]] static bool by_drive(axes::CommandKind kind) { return kind >= axes::CommandKind::drive_move_absolute; }
    [[nodiscard]] bool waits_to_leave(const axes::AxisView& view) const {
        return by_drive(from_.kind) || from_.kind == axes::CommandKind::torque || view.state == axes::AxisState::ErrorStop;
    }
    [[nodiscard]] static bool by_profile(axes::DriveMode mode) {
        using Mode = axes::DriveMode;
        return mode == Mode::profile_position || mode == Mode::profile_velocity || mode == Mode::profile_torque;
    }
    [[nodiscard]] static bool of_velocity(std::int64_t code) { return code == 3 || code == 9; }
    [[nodiscard]] static bool of_torque(std::int64_t code) { return code == 4 || code == 10; }

    static constexpr Duration patience = std::chrono::milliseconds{600};

    axes::AxisConfig config_;
    axes::test::MotionOracle motion_;
    double counts_, velocity_unit_ = 1;
    unsigned position_bits_ = 32;
    std::int64_t position_ = 0;  // unwrapped 607Ah
    ToldDrive before_;
    struct {
        axes::AxisState state = axes::AxisState::Disabled;
        axes::CommandKind kind = axes::CommandKind::none;
    } from_;
    std::array<ToldDrive, 2> sent_;
    ToldDrive newest_;
    int known_ = 0;
    int patience_, left_on_ = 0, apart_ = 0, resting_ = 0;
    long compared_ = 0, breaches_ = 0;
    const char* away_ = nullptr;
    std::string report_;
};

}  // namespace taktwerk::runtime::testing
