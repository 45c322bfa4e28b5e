#pragma once
// Which floor an alarm number belongs to (core/alarm.hpp), where the machine has to know it.

#include <cstddef>

#include "core/alarm.hpp"

namespace taktwerk::runtime {

struct AlarmRange {
    AlarmId first = 0;
    AlarmId count = 0;
    [[nodiscard]] constexpr bool has(AlarmId id) const noexcept { return id >= first && id < first + count; }
    [[nodiscard]] constexpr AlarmId id(std::size_t number) const noexcept { return static_cast<AlarmId>(first + number); }
    /// Of an alarm that is in it, from 0.
    [[nodiscard]] constexpr std::size_t number(AlarmId id) const noexcept { return static_cast<std::size_t>(id - first); }
};

namespace alarm_range {
inline constexpr AlarmRange bus{0x1000, 0x1000};
inline constexpr AlarmRange programs{0x5000, 64};  ///< alarms are numbered per program: its index says whose
}  // namespace alarm_range

}  // namespace taktwerk::runtime
