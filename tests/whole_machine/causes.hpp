#pragma once
// Which alarm may come of what: the one table that says whether an alarm of a run is explained.

#include <span>
#include <string_view>
#include <variant>

#include "tests/whole_machine/trouble.hpp"

namespace taktwerk::whole {

/// Of which part of the machine an alarm is, seen from what was done.
enum class Where : std::uint8_t {
    here,     ///< of the axis, slave, program or line that it was done to, or of what hangs at it
    anywhere  ///< of others, or of the machine
};

struct Consequence {
    std::string_view alarm;  ///< one that ends with _: each that begins so
    Where where = Where::anywhere;
};

[[nodiscard]] inline bool is(const Consequence& consequence, std::string_view alarm) noexcept {
    return consequence.alarm.ends_with('_') ? alarm.starts_with(consequence.alarm) : alarm == consequence.alarm;
}
[[nodiscard]] std::span<const Consequence> consequences(Trouble trouble) noexcept;
[[nodiscard]] std::span<const Consequence> consequences(Deed deed) noexcept;

}  // namespace taktwerk::whole
