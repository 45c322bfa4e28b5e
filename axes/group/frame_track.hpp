#pragma once
// A product's frame that moves with an axis, as it was asked for: MC_TrackConveyorBelt, MC_TrackRotaryTable. Plain data.
//
//     the object, seen from the world = origin * way of the axis since `reference` * object
//
// The way is along X of the origin (a belt), or a turn about its Z (a table). Why an object's place counts from a position of the axis, not from a moment:
// then it does not matter when the command was given (G-082).

#include <cstdint>

#include "axes/coupling/endless.hpp"
#include "axes/pose.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

struct FrameTrack {
    enum class Kind : std::uint8_t { none, belt, table } kind = Kind::none;
    AxisRef master{};
    std::uint32_t serial = 0;  ///< of this object: two of one belt are two frames
    SixNumbers origin{};       ///< of the belt or table, seen from the world
    SixNumbers object{};       ///< seen from the origin as it stands while the axis is at `reference`
    EndlessPlace reference{};  ///< of the axis
    SixNumbers machine{};      ///< of a command in it: the machine's frame that it took, seen from the world

    [[nodiscard]] constexpr bool moves() const noexcept { return kind != Kind::none; }
    friend bool operator==(const FrameTrack&, const FrameTrack&) = default;
};

/// Where the object is after this way of its axis, seen from the world. `turn`: u of the axis in a turn of the table.
[[nodiscard]] Pose object_at(const FrameTrack& track, double way, double turn) noexcept;

}  // namespace taktwerk::axes
