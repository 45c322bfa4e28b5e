#pragma once
// Which axes are where in the group, and the group's hand on them: all of them follow, or none. Real-time safe.

#include <array>
#include <cstdint>
#include <span>

#include "axes/axis/axis.hpp"
#include "axes/group/group_types.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

class GroupMembers {
public:
    explicit GroupMembers(std::span<Axis> axes) noexcept : axes_(axes) {}

    /// `ident` from 1 to most_members. Errors: invalid_axis, invalid_member, not_supported (a modulo axis, one without set-points, a ninth).
    ErrorId add(AxisRef axis, std::uint8_t ident) noexcept;
    ErrorId remove(std::uint8_t ident) noexcept;
    void remove_all() noexcept { members_ = {}; }

    [[nodiscard]] std::size_t count() const noexcept;
    [[nodiscard]] bool has(std::size_t place) const noexcept { return members_[place].valid(); }
    [[nodiscard]] bool contains(AxisRef axis) const noexcept;
    [[nodiscard]] const std::array<AxisRef, most_members>& refs() const noexcept { return members_; }
    /// Only where has(place).
    [[nodiscard]] Axis& axis(std::size_t place) noexcept { return axes_[members_[place].index]; }
    [[nodiscard]] const Axis& axis(std::size_t place) const noexcept { return axes_[members_[place].index]; }

    /// The first reason of a member not to follow; none: all of them can.
    [[nodiscard]] ErrorId refuse(Owner owner) noexcept;
    /// Another party than `owner` has one of them.
    [[nodiscard]] bool owned_by_other(Owner owner) const noexcept;
    /// All or none.
    ErrorId join(const void* instance, Owner owner) noexcept;
    struct Refused {
        ErrorId error = ErrorId::none;
        std::uint8_t place = most_members;  ///< whose; most_members: nobody's
    };
    /// A set-point for each that follows; `of(place)` says it. The first that cannot follow it: its error.
    template <class Of>
    Refused lead(const Of& of) noexcept {
        Refused first;
        for (std::size_t i = 0; i < most_members; ++i) {
            if (joined_[i] == 0) continue;
            const MotionState next = of(i);
            const auto error = axis(i).lead({next.position, next.velocity, next.acceleration});
            if (error == ErrorId::none) continue;
            joined_[i] = 0;
            if (first.error == ErrorId::none) first = {error, static_cast<std::uint8_t>(i)};
        }
        return first;
    }
    void leave() noexcept;
    /// By which axis the length of their path goes, or will; invalid: none.
    void path_driven_by(AxisRef driver) noexcept;
    /// At least one follows.
    [[nodiscard]] bool led() const noexcept;

    struct Loss {
        bool any = false;
        std::uint16_t error = 0;            ///< the axis' own; 0: it has none
        std::uint8_t place = most_members;  ///< whose; most_members: nobody's
    };
    /// Of those that followed one does not any more; it is forgotten.
    [[nodiscard]] Loss lost() noexcept;
    /// The first that is in ErrorStop, whether it followed or not; error 0: none is.
    [[nodiscard]] Loss error_of_any() const noexcept;

    [[nodiscard]] JointVector set_positions() const noexcept;

private:
    std::span<Axis> axes_;
    std::array<AxisRef, most_members> members_{};
    std::array<CommandId, most_members> joined_{};  // the axis' command; 0: does not follow
    AxisRef driver_{};
};

}  // namespace taktwerk::axes
