#pragma once
// What a person asks to be measured. Plain data: goes through the recorded inbox. Unit u is the axis' own.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace taktwerk::axes {

enum class MeasureKind : std::uint8_t {
    none,
    step,       ///< moves to and fro as fast as asked, rests after each: overshoot, settling, following error
    ramp,       ///< moves at one velocity: following error and ripple while it is constant
    friction,   ///< moves at several velocities: torque over velocity
    sweep,      ///< sines of rising frequency around where the axis stands: frequency response
    following,  ///< moves of different velocity and acceleration: what causes the following error and the torque
    cogging,    ///< moves slowly: torque and velocity over the position
};
inline constexpr std::array<std::string_view, 7> measure_words{"none", "step", "ramp", "friction", "sweep", "following", "cogging"};
[[nodiscard]] constexpr std::string_view name(MeasureKind kind) noexcept {
    const auto i = static_cast<std::size_t>(kind);
    return i < measure_words.size() ? measure_words[i] : measure_words[0];
}
[[nodiscard]] constexpr std::optional<MeasureKind> measure_kind_of(std::string_view word) noexcept {
    for (std::size_t i = 1; i < measure_words.size(); ++i)
        if (measure_words[i] == word) return static_cast<MeasureKind>(i);
    return std::nullopt;
}

/// Every number may be 0: then a small one is taken (excitation_plan.hpp says which).
struct MeasureOrder {
    MeasureKind kind = MeasureKind::none;
    std::uint16_t count = 0;  ///< times to and fro; friction, following: velocities; sweep: frequencies
    double distance = 0;      ///< u, signed: how far from where the axis stands; sweep: most amplitude, both ways
    double velocity = 0;      ///< u/s, the highest
    double acceleration = 0;  ///< u/s2, the highest
    double from_hz = 0, to_hz = 0;
    double period = 0;  ///< u: after it cogging repeats; 0 = a turn of the motor
    friend bool operator==(const MeasureOrder&, const MeasureOrder&) = default;
};
static_assert(std::is_trivially_copyable_v<MeasureOrder>);

}  // namespace taktwerk::axes
