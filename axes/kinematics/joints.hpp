#pragma once
// What an arm's joints stand at, and which of the ways of reaching a pose that is. Plain data.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace taktwerk::axes {

inline constexpr std::size_t max_joints = 6;

/// One value a joint, or an axis of the group, from the base on: rad or the unit of length; the rest behind the joints that there are is 0.
using Joints = std::array<double, max_joints>;

/// The flags by which vendors tell the ways of reaching a pose apart. Each is the sign of a number that vanishes exactly at its singularity
/// (docs/motion/kinematics.md says which, arm by arm); at 0 it counts as positive. `any` in what is wanted, and where an arm has no such choice.
enum class Shoulder : std::int8_t { any = 0, front = 1, back = -1 };
enum class Elbow : std::int8_t { any = 0, up = 1, down = -1 };
enum class Wrist : std::int8_t { any = 0, no_flip = 1, flip = -1 };

struct Branch {
    Shoulder shoulder = Shoulder::any;
    Elbow elbow = Elbow::any;
    Wrist wrist = Wrist::any;

    friend bool operator==(const Branch&, const Branch&) = default;
};

/// Does `found` do for somebody who wants `wanted`? Flags that are `any` in one of them do not matter: nobody asks, or the arm has no such choice.
[[nodiscard]] constexpr bool answers(const Branch& found, const Branch& wanted) noexcept {
    const auto agree = [](auto asked, auto is) { return static_cast<int>(asked) == 0 || static_cast<int>(is) == 0 || asked == is; };
    return agree(wanted.shoulder, found.shoulder) && agree(wanted.elbow, found.elbow) && agree(wanted.wrist, found.wrist);
}

/// Which turn a rotary joint stands in: 0 for (-180, 180] degrees, 1 for (180, 540], -1 for (-540, -180].
inline constexpr std::int8_t any_turn = std::numeric_limits<std::int8_t>::min();

/// Branch and turns: with them a pose names one stand of the joints.
struct Configuration {
    Branch branch;
    std::array<std::int8_t, max_joints> turns{any_turn, any_turn, any_turn, any_turn, any_turn, any_turn};

    friend bool operator==(const Configuration&, const Configuration&) = default;
};

}  // namespace taktwerk::axes
