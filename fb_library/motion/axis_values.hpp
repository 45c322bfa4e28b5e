#pragma once
// Single values of the axis in each call: MC_ReadActualVelocity, MC_ReadActualTorque (PLCopen Part 1 v2.0, 3.25, 3.26), and of the same form
// MC_ReadCommandPosition, MC_ReadCommandVelocity, MC_ReadCommandAcceleration. Real-time safe.
// Actual values: Error with drive_not_ready while the drive's feedback is missing or too old.

#include <string_view>

#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

struct MC_ReadActualVelocity : EnableBlock<MC_ReadActualVelocity> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Velocity = 0;

    static constexpr std::string_view summary = "Gives the axis' actual velocity.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(), out<&Self::Velocity>("u/s", "signed; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadActualVelocity>;
    Reading read(const axes::AxisView& view) noexcept {
        Velocity = view.actual_velocity;
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept { Velocity = 0; }
};

struct MC_ReadActualTorque : EnableBlock<MC_ReadActualTorque> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Torque = 0;

    static constexpr std::string_view summary = "Gives the axis' actual torque.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::Torque>("rated", "signed fraction of the motor's rated torque; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadActualTorque>;
    Reading read(const axes::AxisView& view) noexcept {
        Torque = view.actual_torque;
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept { Torque = 0; }
};

struct MC_ReadCommandPosition : EnableBlock<MC_ReadCommandPosition> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Position = 0;

    static constexpr std::string_view summary = "Gives the axis' set position.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::Position>("u", "set position; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadCommandPosition>;
    Reading read(const axes::AxisView& view) noexcept {
        Position = view.set_position;
        return Reading::valid();
    }
    void clear() noexcept { Position = 0; }
};

struct MC_ReadCommandVelocity : EnableBlock<MC_ReadCommandVelocity> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Velocity = 0;

    static constexpr std::string_view summary = "Gives the axis' set velocity.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(), out<&Self::Velocity>("u/s", "signed; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadCommandVelocity>;
    Reading read(const axes::AxisView& view) noexcept {
        Velocity = view.set_velocity;
        return Reading::valid();
    }
    void clear() noexcept { Velocity = 0; }
};

struct MC_ReadCommandAcceleration : EnableBlock<MC_ReadCommandAcceleration> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Acceleration = 0;

    static constexpr std::string_view summary = "Gives the axis' set acceleration.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::Acceleration>("u/s2", "signed; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadCommandAcceleration>;
    Reading read(const axes::AxisView& view) noexcept {
        Acceleration = view.set_acceleration;
        return Reading::valid();
    }
    void clear() noexcept { Acceleration = 0; }
};

}  // namespace taktwerk::fb
