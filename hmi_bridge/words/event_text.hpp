#pragma once
// A command that was refused or ended early, in words: whose it was, who stands in the way, what to do. Not real-time.

#include <string>

#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

struct EventText {
    std::string who;     ///< "'cell.pick' (MC_MoveAbsolute of program cell)"
    std::string by;      ///< who has or took the axis, likewise; empty: nobody else
    std::string what;    ///< one sentence, with both
    std::string remedy;  ///< one or more, with a full stop
};
/// "axis x", "group arm".
[[nodiscard]] std::string event_subject(const runtime::CommandEvent& event, const runtime::MachineLayout& layout);
[[nodiscard]] EventText describe(const runtime::CommandEvent& event, const runtime::MachineLayout& layout);
/// Whose an error of a group is: "drive_fault of axis elbow".
[[nodiscard]] std::string of_axis(std::string_view error, std::string_view axis);
/// "refused", "aborted".
[[nodiscard]] std::string_view word(runtime::CommandEvent::What what) noexcept;

}  // namespace taktwerk::hmi
