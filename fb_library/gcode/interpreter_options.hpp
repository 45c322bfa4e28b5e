#pragma once
// What a program meets on its machine: tools, offsets, reference positions; and how it is to be run. Plain data.

#include <cstdint>
#include <vector>

#include "fb_library/gcode/arc_geometry.hpp"
#include "fb_library/gcode/program_item.hpp"

namespace taktwerk::gcode {

/// G43: what the tool's point is away from the place that coordinates mean without a tool.
struct ToolEntry {
    std::uint32_t number = 0;  ///< 1 and up
    AxisValues offset{};
};

inline constexpr std::size_t coordinate_systems = 9;             ///< G54 to G59, G59.1 to G59.3
using OffsetTable = std::array<AxisValues, coordinate_systems>;  ///< the zeros of each, in machine coordinates

struct InterpreterOptions {
    std::vector<ToolEntry> tools{};
    OffsetTable offsets{};
    AxisValues start{};                                                              ///< where the machine stands, in machine coordinates
    AxisValues reference{}, second_reference{};                                      ///< of G28 and G30, in machine coordinates
    enum class Rotary : std::uint8_t { refused, offered } rotary = Rotary::refused;  ///< A, B, C: somebody has to have said what they mean
    enum class Units : std::uint8_t { mm, inch } units = Units::mm;                  ///< until G20 or G21
    PathMode path{};                                                                 ///< until G61, G61.1 or G64
    ArcTolerance arc{};
    bool block_delete = false;     ///< blocks that begin with / are left out
    bool optional_stop = false;    ///< M1 stops
    bool single_block = false;     ///< a stop behind every block that did something
    std::uint32_t start_line = 1;  ///< of the text: what stands before is computed and not carried out
};

}  // namespace taktwerk::gcode
