#pragma once
// Why homing does not believe the index pulse it was to find, as the first number of the alarm homing_failed, beyond those of a search's phases.

#include <string_view>

namespace taktwerk::axes {

struct IndexDoubt {
    double number = 0;
    std::string_view english, chinese, cause, remedy;
};

/// A drive that is asked over a line finds its pulses by the single-turn value, which means something after the first pulse only.
inline constexpr IndexDoubt index_unknown{
    101, "Homing failed: nobody can say where the encoder's index pulse is", "回零失败:无法确定编码器 Z 脉冲的位置",
    "The motor has not made a full turn since the drive was switched on, or did not come to rest after the switch",
    "Jog it by more than a turn, or start homing further away from the switch; then reset and home again"};
/// The switch is looked at now and then: within an eighth of a turn beside the pulse it may once be this pulse and once the next.
inline constexpr IndexDoubt index_near_edge{
    102, "Homing failed: the index pulse lies within an eighth of a turn of the switch's edge",
    "回零失败:Z 脉冲距离原点开关边沿不足八分之一转",
    "The switch is looked at over a slow line: next time it might be the pulse before or after, a whole turn away",
    "Move the switch by half a turn of the motor; then reset and home again"};

/// nullptr: another number.
[[nodiscard]] constexpr const IndexDoubt* find_index_doubt(double number) noexcept {
    if (number == index_unknown.number) return &index_unknown;
    return number == index_near_edge.number ? &index_near_edge : nullptr;
}

}  // namespace taktwerk::axes
