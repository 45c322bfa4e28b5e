#pragma once
// What comes out of a program: moves in machine coordinates, pauses, and what others have to do and acknowledge. Each carries its source line, feed and path mode: nothing has to be remembered between them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace taktwerk::gcode {

inline constexpr std::size_t axis_count = 6;
inline constexpr std::size_t linear_axes = 3;
inline constexpr char axis_letters[axis_count + 1] = "XYZABC";
/// x, y, z in mm; a, b, c in degrees.
using AxisValues = std::array<double, axis_count>;

struct Feed {
    enum class Kind : std::uint8_t {
        rapid,      ///< G0: as fast as the machine may; `value` is 0
        mm_per_s,   ///< of the tool's point along the path (x, y, z)
        deg_per_s,  ///< nothing but a, b, c moves: of the root of their squares
        seconds,    ///< this move takes so long (G93)
    } kind = Kind::rapid;
    double value = 0;
};

struct PathMode {
    enum class Kind : std::uint8_t {
        exact_path,  ///< G61: on the path; rest only where the direction changes
        exact_stop,  ///< G61.1: rest at the end of every move
        blend,       ///< G64: corners may be cut
    } kind = Kind::exact_path;
    double deviation_mm = std::numeric_limits<double>::infinity();  ///< blend: most distance from the programmed path (P); infinite: any
    double merge_mm = 0;  ///< blend: short lines within this of one line may become one (Q); 0: none
};

/// A straight line, or an arc in a plane of two axes; with an arc the other axes move evenly with the angle (a helix).
struct Move {
    enum class Kind : std::uint8_t { line, arc } kind = Kind::line;
    AxisValues from{}, to{};
    std::array<double, linear_axes> centre{};  ///< of an arc, in the plane of `from`
    std::uint8_t normal = 2;                   ///< of an arc: the axis across its plane: x 0, y 1, z 2
    double angle = 0;  ///< of an arc, rad: positive is the mathematical sense about the normal's positive direction; turns included
    Feed feed{};
    PathMode path{};
};

struct Handshake {
    enum class Kind : std::uint8_t {
        program_stop,       ///< M0: until somebody lets it go on
        optional_stop,      ///< M1, with the option
        end,                ///< M2, M30 (`number`), or the closing % (0): the last item
        tool_prepare,       ///< T: this tool comes next
        tool_change,        ///< M6: `number` is the tool to be put in; 0: none
        spindle_clockwise,  ///< M3, `value` 1/min
        spindle_counter,    ///< M4, `value` 1/min
        spindle_speed,      ///< S while it turns
        spindle_off,
        mist,   ///< M7
        flood,  ///< M8
        coolant_off,
        user,        ///< M100 to M199 (`number`), `value` P and `second` Q; NaN: not given
        block_stop,  ///< single block: a block is done
    } kind = Kind::program_stop;
    std::uint32_t number = 0;
    double value = 0, second = 0;
};

/// Whether the path before has to be at rest, and the answer there, before anything behind is carried out. What need not wait takes effect in its turn.
enum class Waits : std::uint8_t { no, at_rest };
[[nodiscard]] constexpr Waits waits_of(Handshake::Kind kind) noexcept {
    return kind == Handshake::Kind::tool_prepare || kind == Handshake::Kind::spindle_speed ? Waits::no : Waits::at_rest;
}

struct ProgramItem {
    enum class Kind : std::uint8_t {
        move,
        dwell,  ///< G4: at rest for `seconds`
        handshake,
        message,  ///< (MSG, ...): Interpreter::message()
        resume,  ///< start from a line: the program is at `move.to` now, and Interpreter::resume_state() says with what; the machine has to be brought there
    } kind = Kind::move;
    std::uint32_t line = 0;              ///< of the text, from 1
    std::uint32_t number = 0xFFFF'FFFF;  ///< N of its block; no_block_number
    Move move{};
    Handshake handshake{};
    double seconds = 0;
};

}  // namespace taktwerk::gcode
