#pragma once
// The machine's answer to a command in words: what, why, what to do.

#include "core/result.hpp"
#include "hmi_bridge/command_words.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

/// Stable code of a refusal: "command.no_control". Empty for accepted. Exit codes derive from it.
[[nodiscard]] std::string_view code(runtime::Answer answer) noexcept;

/// "axis x", "program cell", ...; empty when the command has no target.
[[nodiscard]] std::string subject_of(const runtime::MachineLayout& layout, TargetKind target, std::uint16_t axis, std::uint16_t index);

/// Who has continued what its program has interrupted, too.
inline constexpr std::string_view waits_for_program_note = "its program has interrupted it, too, and goes on with it by itself";
/// "limited to 20 mm/s by setup mode": for an accepted answer whose `limited_to` is above 0.
[[nodiscard]] std::string limit_note(const runtime::CommandAnswer& answer, std::string_view unit);

/// Only for refusals. `holder`: the block that moves or locks the axis, empty = none or without a name. `met`: what a group's jog has met, by its name
/// (met_by()).
[[nodiscard]] Error explain(const runtime::CommandAnswer& answer, CommandKind kind, std::string subject, std::string_view holder,
                            std::string_view met = {});

/// The axis whose limit it is, or the room of the group `index`; empty: neither, or it has none of that name.
[[nodiscard]] std::string_view met_by(const runtime::CommandAnswer& answer, const runtime::MachineLayout& layout, std::uint16_t index);

}  // namespace taktwerk::hmi
