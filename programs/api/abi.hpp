#pragma once
// The ABI hash: a program is loaded only where the runtime's is the same. It covers what a compiler can measure (the layout of
// every block, of the views and contexts a program touches) and one number for what it cannot.

#include <cstddef>
#include <cstdint>

#include "axes/axis/motion_context.hpp"
#include "axes/group/group_access.hpp"
#include "fb_library/block_abi.hpp"
#include "programs/api/program.hpp"

namespace taktwerk {

inline constexpr const char* sdk_version = "0.1.0";

/// Raise it by one, in the same commit, when
///  - a virtual function of Program, Declaration, AxisRequests or GroupAccess is added, removed, moved, or changes its signature or meaning;
///  - an enumerator that passes between program and runtime gets another number (AxisState, ErrorId, Owner, CommandKind, Outcome,
///    CommandStatus, Reaction, VariableType, MC_...); appending one is no change;
///  - the members of a struct that both sides touch change in a way the sizes and offsets below do not show (two of one type
///    swapped, another unit, another meaning);
///  - a block's function and the axis agree on something new (what a command id means, who renews a lease).
/// Not for: new blocks or pins (hashed), documentation, anything behind the virtual functions. It is never lowered or reused.
inline constexpr std::uint64_t program_interface_version = 10;

[[nodiscard]] constexpr std::uint64_t abi_hash() noexcept {
    std::uint64_t hash = fb::block_abi_hash;
    const auto add = [&hash](std::uint64_t number) {
        for (int i = 0; i < 8; ++i) hash = (hash ^ ((number >> (8 * i)) & 0xFF)) * 0x100000001B3;
    };
    add(program_interface_version);
    add(sizeof(axes::AxisView));
    add(offsetof(axes::AxisView, ledger));
    add(offsetof(axes::AxisView, queued));
    add(offsetof(axes::AxisView, error));
    add(offsetof(axes::AxisView, set_position));
    add(offsetof(axes::AxisView, actual_position));
    add(offsetof(axes::AxisView, drive_state));
    add(offsetof(axes::AxisView, active));
    add(offsetof(axes::AxisView, last_id));
    add(sizeof(axes::AxisCommand));
    add(offsetof(axes::AxisCommand, position));
    add(offsetof(axes::AxisCommand, velocity));
    add(offsetof(axes::AxisCommand, jerk));
    add(sizeof(axes::Submitted));
    add(sizeof(axes::GroupView));
    add(offsetof(axes::GroupView, set_position));
    add(offsetof(axes::GroupView, ledger));
    add(sizeof(axes::GroupCommand));
    add(sizeof(axes::GroupSetting));
    add(sizeof(axes::MotionContext));
    add(sizeof(axes::MotionTables));
    add(sizeof(TaskContext));
    add(sizeof(TaskInfo));
    add(sizeof(ParameterSpec));
    add(sizeof(OperatorValueSpec));
    add(static_cast<std::uint64_t>(__cplusplus));
    return hash;
}

}  // namespace taktwerk
