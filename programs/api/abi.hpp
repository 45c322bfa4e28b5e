#pragma once
// The ABI hash: two builds agree on it exactly when programs of one run on the other. It covers the layout of every block, of
// the views and contexts a program touches, and a number that is raised when the virtual functions of programs/api change.

#include <cstddef>
#include <cstdint>

#include "axes/axis/motion_context.hpp"
#include "fb_library/all_blocks.hpp"
#include "programs/api/program.hpp"

namespace taktwerk {

inline constexpr const char* sdk_version = "0.1.0";

/// Raise when a virtual function of Program, Declaration or AxisRequests is added, removed, moved or changed.
inline constexpr std::uint64_t program_interface_version = 1;

[[nodiscard]] constexpr std::uint64_t abi_hash() noexcept {
    std::uint64_t hash = fb::block_abi_hash;
    const auto add = [&hash](std::uint64_t number) {
        for (int i = 0; i < 8; ++i) hash = (hash ^ ((number >> (8 * i)) & 0xFF)) * 0x100000001B3;
    };
    add(program_interface_version);
    add(sizeof(axes::AxisView));
    add(offsetof(axes::AxisView, ledger));
    add(offsetof(axes::AxisView, queued));
    add(offsetof(axes::AxisView, actual_position));
    add(sizeof(axes::AxisCommand));
    add(sizeof(axes::MotionContext));
    add(sizeof(TaskContext));
    add(sizeof(ParameterSpec));
    add(static_cast<std::uint64_t>(__cplusplus));
    return hash;
}

}  // namespace taktwerk
