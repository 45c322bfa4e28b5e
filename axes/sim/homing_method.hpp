#pragma once
// CiA 402 homing methods as a table. A method brings the axis into its start condition, if it is not in it, and then makes the same moves
// from wherever it came. Sources: SV33-E manual 3.4.3(9), tables 3-77 to 3-92; SE-808X 3.2.7 and SV-DA200 3.4.6 have the same shapes
// for those methods that they know. Methods 5, 6 and 27 from beside the switch are lost in the print of the SV33-E: as 21, 22 and 11.

#include <array>
#include <cstdint>

namespace taktwerk::axes::sim {

enum class Switch : std::uint8_t { none, negative_limit, positive_limit, home };
enum class Way : std::uint8_t { forward, reverse };
enum class Pace : std::uint8_t { fast, slow };                                         ///< 6099h:01, 6099h:02
enum class Until : std::uint8_t { nothing, switched_on, switched_off, index, block };  ///< block: the mechanics end

struct HomingMove {
    Way way = Way::forward;
    Pace pace = Pace::slow;
    Until until = Until::nothing;  ///< nothing: there is no such move
};

struct HomingMethod {
    std::int8_t number = 0;
    Switch sees = Switch::home;
    Switch turns_at = Switch::none;  ///< a limit met before the switch: the search goes the other way; none: it fails there
    HomingMove approach{};           ///< only when the switch is inactive at the start
    HomingMove retreat{};            ///< only when it is active
    std::array<HomingMove, 3> moves{};
};

namespace homing {
inline constexpr HomingMove forward_fast(Until e) { return {Way::forward, Pace::fast, e}; }
inline constexpr HomingMove forward_slow(Until e) { return {Way::forward, Pace::slow, e}; }
inline constexpr HomingMove reverse_fast(Until e) { return {Way::reverse, Pace::fast, e}; }
inline constexpr HomingMove reverse_slow(Until e) { return {Way::reverse, Pace::slow, e}; }

inline constexpr auto on = Until::switched_on, off = Until::switched_off;

// clang-format off
inline constexpr std::array<HomingMethod, 18> methods{{
    {17, Switch::negative_limit, Switch::none, reverse_fast(on), {}, {forward_slow(off)}},
    {18, Switch::positive_limit, Switch::none, forward_fast(on), {}, {reverse_slow(off)}},
    {19, Switch::home, Switch::none, forward_fast(on), {}, {reverse_slow(off)}},
    {20, Switch::home, Switch::none, {}, reverse_fast(off), {forward_slow(on)}},
    {21, Switch::home, Switch::none, reverse_fast(on), {}, {forward_slow(off)}},
    {22, Switch::home, Switch::none, {}, forward_fast(off), {reverse_slow(on)}},
    {23, Switch::home, Switch::positive_limit, forward_fast(on), {}, {reverse_slow(off)}},
    {24, Switch::home, Switch::positive_limit, forward_fast(on), {}, {reverse_slow(off), forward_slow(on)}},
    {25, Switch::home, Switch::positive_limit, forward_fast(on), {}, {forward_slow(off), reverse_slow(on)}},
    {26, Switch::home, Switch::positive_limit, forward_fast(on), {}, {forward_slow(off)}},
    {27, Switch::home, Switch::negative_limit, reverse_fast(on), {}, {forward_slow(off)}},
    {28, Switch::home, Switch::negative_limit, reverse_fast(on), {}, {forward_slow(off), reverse_slow(on)}},
    {29, Switch::home, Switch::negative_limit, reverse_fast(on), {}, {reverse_slow(off), forward_slow(on)}},
    {30, Switch::home, Switch::negative_limit, reverse_fast(on), {}, {reverse_slow(off)}},
    {33, Switch::none, Switch::none, {}, {}, {reverse_slow(Until::index)}},
    {34, Switch::none, Switch::none, {}, {}, {forward_slow(Until::index)}},
    {-1, Switch::none, Switch::none, reverse_fast(Until::block), {}, {forward_slow(Until::index)}},
    {-2, Switch::none, Switch::none, forward_fast(Until::block), {}, {reverse_slow(Until::index)}},
}};
// clang-format on

inline constexpr std::int64_t here = 35;  ///< the present position, without a move
/// Methods 1 to 14 are 17 to 30 with the first index pulse after the edge (SV33-E, before table 3-83).
inline constexpr std::int64_t with_index = 16;
}  // namespace homing

/// Empty `moves` and no number: there is no such method (15, 16, 31, 32: SV33-E A.D35).
[[nodiscard]] constexpr HomingMethod homing_method(std::int64_t number) noexcept {
    const bool pulsed = number >= 1 && number <= 14;
    for (auto method : homing::methods) {
        if (method.number != (pulsed ? number + homing::with_index : number)) continue;
        if (!pulsed) return method;
        method.number = static_cast<std::int8_t>(number);
        std::size_t last = 0;
        while (method.moves[last + 1].until != Until::nothing) ++last;
        method.moves[last + 1] = {method.moves[last].way, Pace::slow, Until::index};
        return method;
    }
    if (number == homing::here) return {.number = homing::here, .sees = Switch::none};
    return {};
}

}  // namespace taktwerk::axes::sim
