#pragma once
// Names of axes, programs, parameters and outputs to their indices, with suggestions. Not real-time.

#include <cstdint>
#include <string_view>

#include "core/result.hpp"
#include "hmi_bridge/command_words.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

inline constexpr std::uint16_t all_axes = 0xFFFF;

/// What a person calls it, and the key of a request that names it; "" for none.
[[nodiscard]] std::string_view noun(TargetKind kind);

/// Index of `name`; all_axes for "all" where the kind allows it. A parameter is "program.name", or "name" when that is unique.
/// Errors: command.unknown_name, command.ambiguous_name.
[[nodiscard]] Result<std::uint16_t> find_target(const runtime::MachineLayout& layout, TargetKind kind, std::string_view name);

}  // namespace taktwerk::hmi
