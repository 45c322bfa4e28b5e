#pragma once
// Groups of axes as people have them: what they ask of a group, and what they see of it. Who may do what, and when, stands in operator_command.hpp.

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/machine/group_hand.hpp"
#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/seen_group.hpp"

namespace taktwerk::runtime {

class GroupDesk {
public:
    /// After the groups were built.
    GroupDesk(MachineBody& body, HandMotion& hands);

    /// OperatorAction::group_...; `command.index`: the group. Real-time safe.
    Verdict execute(const OperatorCommand& command) noexcept;
    /// Step 10, once a cycle, in front of who tells it. Nothing where there is no group. Real-time safe.
    void look() noexcept;
    [[nodiscard]] std::span<const SeenGroup> seen() const noexcept { return seen_; }
    [[nodiscard]] GroupHand& hand() noexcept { return hand_; }

    /// The newest stop level of a member (HandMotion::newest_stop).
    [[nodiscard]] std::uint64_t newest_stop(std::size_t group) const noexcept;
    /// Whose the members are; none: it has none.
    [[nodiscard]] axes::Owner owner_of(std::size_t group) const noexcept;
    /// Whose axis of it keeps `owner` from moving it; nobody's: as owner_of().
    [[nodiscard]] axes::Owner owner_against(std::size_t group, axes::Owner owner) const noexcept;

private:
    [[nodiscard]] axes::GroupRef ref(std::size_t group) const noexcept { return {static_cast<std::uint16_t>(group)}; }
    Verdict submit(std::size_t group, axes::GroupCommandKind kind, axes::Owner owner) noexcept;
    Verdict halt(std::size_t group) noexcept;
    Verdict interrupt(std::size_t group) noexcept;
    Verdict go_on(std::size_t group) noexcept;
    void look_at(std::size_t group) noexcept;
    static void look_at_frames(const axes::GroupFrames& frames, SeenGroup& seen) noexcept;
    void look_at_use(const axes::GroupView& view, std::size_t place, SeenGroup& seen) noexcept;

    MachineBody& body_;
    HandMotion& hands_;
    GroupHand hand_;
    std::vector<SeenGroup> seen_;
    std::vector<axes::JointVector> accelerations_;  // of the cycle before
};

}  // namespace taktwerk::runtime
