#pragma once
// CiA 402 homing methods as tables: from the state of the switch at the start follows a list of moves, each until an edge.
// Sources: SV33-E manual 3.4.3(9) (methods 17..22 and 35 as printed), SE-808X manual 3.2.7 (same shapes for 17..22).

#include <array>
#include <cstdint>

namespace taktwerk::axes::sim {

enum class Switch : std::uint8_t { negative_limit, positive_limit, home };
enum class Edge : std::uint8_t { rising, falling };

struct HomingMove {
    bool forward = false;
    bool fast = false;
    Edge until = Edge::rising;
};

struct HomingMethod {
    std::int8_t number = 0;
    Switch uses = Switch::home;
    std::uint8_t inactive_count = 0, active_count = 0;
    std::array<HomingMove, 2> inactive{};  ///< the switch is inactive at the start
    std::array<HomingMove, 2> active{};
};

inline constexpr HomingMove forward_fast(Edge e) { return {true, true, e}; }
inline constexpr HomingMove forward_slow(Edge e) { return {true, false, e}; }
inline constexpr HomingMove reverse_fast(Edge e) { return {false, true, e}; }
inline constexpr HomingMove reverse_slow(Edge e) { return {false, false, e}; }

inline constexpr std::array<HomingMethod, 6> homing_methods{{
    {17, Switch::negative_limit, 2, 1, {reverse_fast(Edge::rising), forward_slow(Edge::falling)}, {forward_slow(Edge::falling)}},
    {18, Switch::positive_limit, 2, 1, {forward_fast(Edge::rising), reverse_slow(Edge::falling)}, {reverse_slow(Edge::falling)}},
    {19, Switch::home, 2, 1, {forward_fast(Edge::rising), reverse_slow(Edge::falling)}, {reverse_slow(Edge::falling)}},
    {20, Switch::home, 1, 2, {forward_slow(Edge::rising)}, {reverse_fast(Edge::falling), forward_slow(Edge::rising)}},
    {21, Switch::home, 2, 1, {reverse_fast(Edge::rising), forward_slow(Edge::falling)}, {forward_slow(Edge::falling)}},
    {22, Switch::home, 1, 2, {reverse_slow(Edge::rising)}, {forward_fast(Edge::falling), reverse_slow(Edge::rising)}},
}};

[[nodiscard]] constexpr const HomingMethod* find_homing_method(std::int64_t number) noexcept {
    for (const auto& method : homing_methods)
        if (method.number == number) return &method;
    return nullptr;
}

}  // namespace taktwerk::axes::sim
