#pragma once
// Power that is asked for, taken back and asked for again faster than the line is asked, and what must hold of it in each cycle.

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "tests/axes/drives/xp200/axis_rig.hpp"

namespace taktwerk::axes::xp200 {

/// DI6 is EMG with Pr164 = 0: closed, it takes the current away at once (5.4.2), with no alarm and while every order still stands.
class PowerRig {
public:
    PowerRig() : rig_{{{97, 33}, {105, 15}, {108, 9}, {136, 1}, {164, 0}, {63, 200}}} {
        rig_.drive.servo().power_on(rig_.now);
        EXPECT_TRUE(rig_.until([&] { return rig_.axis.view().online; }, 5s));
    }

    /// One cycle. What is not as it must be is said once, by problem().
    void step() {
        wished_ = rig_.port.wish().power;
        rig_.step();
        const auto& view = rig_.axis.view();
        const bool energised = rig_.drive.servo().energised();
        if (energised) last_energised_ = rig_.now;
        if (view.powered && rig_.now - last_energised_ > told_within_) say("the axis shows power and the motor has none");
        const bool bears = error_allowed_ || (silence_allowed_ && view.error == id(AxisAlarm::axis_feedback_lost));
        if (view.state == AxisState::ErrorStop && !bears) say(fmt::format("ErrorStop, error {:x}h", view.error));
        if (rig_.drive.servo().enabled_in_motion() > 0) say("enabled in motion");
    }
    void run(Duration time) {
        for (const auto until = rig_.now + time; rig_.now < until;) step();
    }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        for (const auto end = rig_.now + patience; rig_.now < end;) {
            step();
            if (condition()) return true;
        }
        return false;
    }
    void power(bool on) { rig_.power(on); }
    /// The drive shows the power that is wanted now.
    [[nodiscard]] bool has_its_power() { return wished_ == PowerRequest::on && rig_.axis.view().drive_state == PowerState::enabled; }
    [[nodiscard]] bool stands_enabled() { return rig_.axis.view().state == AxisState::Standstill; }
    /// On, off, on. What ends the story is power that stays, and then none.
    void flicker(Duration on, Duration off) {
        power(true);
        run(on);
        power(false);
        run(off);
        power(true);
    }
    /// Within this it has power, keeps it beyond what Pr166 would have left of the first one, and loses it when it shall.
    void must_come_and_stay_and_go(Duration comes_within) {
        if (!until([&] { return stands_enabled(); }, comes_within)) return say("no power");
        if (until([&] { return !rig_.drive.servo().energised(); }, 800ms)) say("the motor has lost its power");
        power(false);
        if (!until([&] { return !rig_.drive.servo().energised() && rig_.axis.view().state == AxisState::Disabled; }, 2s))
            say("the power does not go");
        run(100ms);
    }
    void error_is_allowed() { error_allowed_ = true; }
    /// A line without an answer for three rounds of questions stops the axis (docs/drives/xp200.md).
    void silence_is_allowed() { silence_allowed_ = true; }
    /// True: it has stopped for that, and after a reset has been asked for power again.
    bool came_back_from_silence() {
        if (rig_.axis.view().state != AxisState::ErrorStop) return false;
        power(false);
        run(1500ms);
        (void)rig_.axis.reset(Owner::program);
        if (!until([&] { return rig_.axis.view().state == AxisState::Disabled; }, 3s)) say("the reset fails");
        power(true);
        return true;
    }
    /// How long the axis may show power that is gone.
    void allow(Duration told_within) { told_within_ = told_within; }
    void open_power_stage(bool open) { rig_.drive.servo().inputs().contact(5, open); }
    [[nodiscard]] AxisRig& rig() { return rig_; }
    [[nodiscard]] std::string problem() { return std::exchange(problem_, {}); }

private:
    void say(const std::string& what) {
        if (problem_.empty()) problem_ = fmt::format("{:.3f} s: {}", to_seconds(rig_.now.time_since_epoch()), what);
    }

    AxisRig rig_;
    PowerRequest wished_ = PowerRequest::off;  // when the drive's feedback of this cycle was made
    Instant last_energised_{};
    Duration told_within_{};
    bool error_allowed_ = false, silence_allowed_ = false;
    std::string problem_;
};

/// docs/drives/xp200.md, at 38400 baud: four questions of 14 ms until the terminals are asked for again, their answer, the question for an alarm, and
/// the two words of the ramps of 13 ms that are written after enabling.
inline constexpr Duration loss_told_at_rest = 110ms;
/// Two words of 13 ms before each of the four questions and before the one for the alarm: 70 + 130 ms, and the answer.
inline constexpr Duration loss_told_in_motion = 230ms;

}  // namespace taktwerk::axes::xp200
