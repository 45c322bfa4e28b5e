#pragma once
// MC_ReadStatus, MC_ReadActualPosition, MC_ReadAxisError: PLCopen Part 1 v2.0, 3.27, 3.24, 3.30. Real-time safe.
// What they give is the axis view of this scan. Values go back to 0 or FALSE whenever Valid is FALSE.

#include <cstdint>
#include <string_view>

#include "fb_library/motion/enable_core.hpp"

namespace taktwerk::fb {

struct MC_ReadStatus : EnableBlock<MC_ReadStatus> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool ErrorStop = false, Disabled = false, Stopping = false, Homing = false, Standstill = false, DiscreteMotion = false,
         ContinuousMotion = false, SynchronizedMotion = false;

    static constexpr std::string_view summary = "Gives the axis' state: exactly one of eight outputs is TRUE while Valid.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::ErrorStop>("", "stopped by an axis error; MC_Reset leads out"), out<&Self::Disabled>("", "power off"),
                         out<&Self::Stopping>("", "MC_Stop stops or locks the axis"), out<&Self::Homing>("", "MC_Home runs"),
                         out<&Self::Standstill>("", "power on, nothing to do"),
                         out<&Self::DiscreteMotion>("", "a motion that ends by itself"),
                         out<&Self::ContinuousMotion>("", "a motion without end"), out<&Self::SynchronizedMotion>("", "follows a master"));
    }

private:
    friend EnableBlock<MC_ReadStatus>;
    Reading read(const axes::AxisView& view) noexcept {
        if (!core_.valid() || view.state != shown_) show(view.state);
        return Reading::valid();
    }
    void clear() noexcept {
        ErrorStop = Disabled = Stopping = Homing = Standstill = DiscreteMotion = ContinuousMotion = SynchronizedMotion = false;
    }
    void show(axes::AxisState state) noexcept {
        ErrorStop = state == axes::AxisState::ErrorStop;
        Disabled = state == axes::AxisState::Disabled;
        Stopping = state == axes::AxisState::Stopping;
        Homing = state == axes::AxisState::Homing;
        Standstill = state == axes::AxisState::Standstill;
        DiscreteMotion = state == axes::AxisState::DiscreteMotion;
        ContinuousMotion = state == axes::AxisState::ContinuousMotion;
        SynchronizedMotion = state == axes::AxisState::SynchronizedMotion;
        shown_ = state;
    }

    axes::AxisState shown_ = axes::AxisState::Disabled;
};

/// Error with drive_not_ready while the drive's feedback is missing or too old; Valid comes back with it.
struct MC_ReadActualPosition : EnableBlock<MC_ReadActualPosition> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Position = 0;

    static constexpr std::string_view summary = "Gives the axis' actual position.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::Position>("u", "actual position; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadActualPosition>;
    Reading read(const axes::AxisView& view) noexcept {
        Position = view.actual_position;
        return Reading::unless(view.online ? ErrorId::none : ErrorId::drive_not_ready);
    }
    void clear() noexcept { Position = 0; }
};

/// Errors of axis, drive and bus, not of blocks: a refused command leaves AxisErrorID at 0.
struct MC_ReadAxisError : EnableBlock<MC_ReadAxisError> {
    AxisRef Axis{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint16_t AxisErrorID = 0;

    static constexpr std::string_view summary = "Gives the error that holds the axis in ErrorStop.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), reading<Self>(),
                         out<&Self::AxisErrorID>("", "alarm id of the axis; 0 = none"));
    }

private:
    friend EnableBlock<MC_ReadAxisError>;
    Reading read(const axes::AxisView& view) noexcept {
        AxisErrorID = view.state == axes::AxisState::ErrorStop ? view.error : std::uint16_t{0};
        return Reading::valid();
    }
    void clear() noexcept { AxisErrorID = 0; }
};

}  // namespace taktwerk::fb
