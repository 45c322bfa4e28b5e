#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::array<std::string_view, step_count> step_names{"receive", "inbox",  "decode", "update",   "supervise", "tasks",
                                                              "plan",    "encode", "send",   "snapshot", "total"};

}  // namespace

std::string_view name(Step step) noexcept { return step_names[static_cast<std::size_t>(step)]; }

std::string_view MachineLayout::block_at(const void* instance) const noexcept {
    const auto at = reinterpret_cast<std::uintptr_t>(instance);
    for (const auto& block : blocks)
        if (const auto begin = reinterpret_cast<std::uintptr_t>(block.begin); at >= begin && at - begin < block.size) return block.name;
    return {};
}

}  // namespace taktwerk::runtime
