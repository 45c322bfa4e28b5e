#pragma once
// How the axis is and how it moves: MC_ReadAxisInfo, MC_ReadMotionState: PLCopen Part 1 v2.0, 3.29, 3.28. Real-time safe.

#include <cmath>
#include <string_view>

#include "axes/axis/parameters.hpp"
#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

/// What comes from the drive is FALSE while CommunicationReady is.
struct MC_ReadAxisInfo : EnableBlock<MC_ReadAxisInfo> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool HomeAbsSwitch = false, LimitSwitchPos = false, LimitSwitchNeg = false, Simulation = false, CommunicationReady = false,
         ReadyForPowerOn = false, PowerOn = false, IsHomed = false, AxisWarning = false;

    static constexpr std::string_view summary = "Gives switches, readiness and reference of the axis.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(), out<&Self::HomeAbsSwitch>("", "home switch is on"),
                         out<&Self::LimitSwitchPos>("", "limit switch in positive direction is on"),
                         out<&Self::LimitSwitchNeg>("", "limit switch in negative direction is on"),
                         out<&Self::Simulation>("", "the drive is simulated"),
                         out<&Self::CommunicationReady>("", "the drive's feedback is fresh"),
                         out<&Self::ReadyForPowerOn>("", "MC_Power would switch it on: no fault, no ErrorStop"),
                         out<&Self::PowerOn>("", "the power stage is on"), out<&Self::IsHomed>("", "the absolute position is known"),
                         out<&Self::AxisWarning>("", "the drive warns"));
    }

private:
    friend EnableBlock<MC_ReadAxisInfo>;
    Reading read(const axes::AxisView& view) noexcept {
        using axes::PowerState;
        const bool online = view.online;
        const auto drive = view.drive_state;
        const bool able = drive == PowerState::disabled || drive == PowerState::ready || drive == PowerState::switched_on ||
                          drive == PowerState::enabled || drive == PowerState::quick_stop;
        HomeAbsSwitch = online && view.home_switch;
        LimitSwitchPos = online && view.positive_limit_switch;
        LimitSwitchNeg = online && view.negative_limit_switch;
        Simulation = view.simulated;
        CommunicationReady = online;
        ReadyForPowerOn = online && able && view.state != axes::AxisState::ErrorStop;
        PowerOn = online && (drive == PowerState::enabled || drive == PowerState::quick_stop || drive == PowerState::fault_reaction);
        IsHomed = view.homed;
        AxisWarning = online && view.warning;
        return Reading::valid();
    }
    void clear() noexcept {
        HomeAbsSwitch = LimitSwitchPos = LimitSwitchNeg = Simulation = CommunicationReady = ReadyForPowerOn = PowerOn = IsHomed =
            AxisWarning = false;
    }
};

/// Of the set-point it is exact (mcCommandedValue and mcSetValue are the same here). Of the actual value there is a window, because
/// measured velocities jitter: the velocity counts as constant until it has left parameter 1012 StandstillVelocity around the value it
/// was constant at, and again once it has stayed inside for `settle`. So an actual acceleration below window / settle is not seen.
/// Within the window around zero there is no direction.
struct MC_ReadMotionState : EnableBlock<MC_ReadMotionState> {
    AxisRef Axis{};
    bool Enable = false;
    MC_Source Source = mcSetValue;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool ConstantVelocity = false, Accelerating = false, Decelerating = false, DirectionPositive = false, DirectionNegative = false;

    double reference = 0;   ///< not a pin: actual velocity that the window lies around
    Instant left{};         ///< not a pin: when the actual velocity last left it
    int change = 0;         ///< not a pin: of the actual speed: 1 up, -1 down, 0 constant
    bool watching = false;  ///< not a pin: `reference` means something

    static constexpr Duration settle = std::chrono::milliseconds{20};

    static constexpr std::string_view summary =
        "Says whether the axis accelerates, decelerates or keeps its velocity, and which way it goes.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), in<&Self::Source>("", "whose velocity: the set-point's or the actual one"),
                         reading<Self>(), out<&Self::ConstantVelocity>("", "velocity is constant, also zero"),
                         out<&Self::Accelerating>("", "absolute velocity grows"), out<&Self::Decelerating>("", "absolute velocity shrinks"),
                         out<&Self::DirectionPositive>("", "position increases"), out<&Self::DirectionNegative>("", "position decreases"));
    }

    /// Not for programs: what the core calls.
    Reading read(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(Axis);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_axis);
        if (Source != mcActualValue) {
            watching = false;
            show(view->set_velocity, 0, change_of(view->set_velocity, view->set_acceleration));
            return Reading::valid();
        }
        if (!view->online) return Reading::unless(ErrorId::drive_not_ready);
        const double window = view->parameters[axes::place_of(axes::standstill_velocity)];
        watch(view->actual_velocity, window, ctx.now);
        show(view->actual_velocity, window, change);
        return Reading::valid();
    }

private:
    friend EnableBlock<MC_ReadMotionState>;
    [[nodiscard]] static int change_of(double velocity, double acceleration) noexcept {
        if (acceleration == 0) return 0;
        return velocity == 0 || (velocity > 0) == (acceleration > 0) ? 1 : -1;
    }
    void watch(double velocity, double window, Instant now) noexcept {
        if (!watching) {
            watching = true;
            reference = velocity;
            change = 0;
        }
        if (std::abs(velocity - reference) > window) {
            change = std::abs(velocity) > std::abs(reference) ? 1 : -1;
            reference = velocity;
            left = now;
        } else if (now - left >= settle) {
            change = 0;
        }
    }
    void show(double velocity, double window, int speed_change) noexcept {
        ConstantVelocity = speed_change == 0;
        Accelerating = speed_change > 0;
        Decelerating = speed_change < 0;
        DirectionPositive = velocity > window;
        DirectionNegative = velocity < -window;
    }
    void clear() noexcept {
        ConstantVelocity = Accelerating = Decelerating = DirectionPositive = DirectionNegative = false;
        watching = false;
    }
};

}  // namespace taktwerk::fb
