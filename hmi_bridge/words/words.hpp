#pragma once
// Enumerators of the machine as the stable words that go out in JSON: as they are spelled in the code.

#include <string_view>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "core/alarm.hpp"
#include "ecat/master.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

[[nodiscard]] std::string_view word(runtime::MachinePhase phase) noexcept;
[[nodiscard]] std::string_view word(runtime::Mode mode) noexcept;
[[nodiscard]] std::string_view word(runtime::ProgramState state) noexcept;
[[nodiscard]] std::string_view word(ecat::Master::Phase phase) noexcept;
[[nodiscard]] std::string_view word(axes::VelocityLimiter limiter) noexcept;
/// What moves the axis, by the name of its block: "MC_MoveAbsolute"; "" for none.
[[nodiscard]] std::string_view word(axes::CommandKind kind) noexcept;
[[nodiscard]] std::string_view word(axes::BrakeState state) noexcept;
/// As the machine file spells it.
[[nodiscard]] std::string_view word(axes::HomingKind kind) noexcept;
[[nodiscard]] std::string_view word(AlarmSource source) noexcept;
[[nodiscard]] std::string_view word(Reaction reaction) noexcept;
[[nodiscard]] std::string_view word(VariableType type) noexcept;

}  // namespace taktwerk::hmi
