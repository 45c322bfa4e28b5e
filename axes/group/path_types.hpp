#pragma once
// What a stored path asks for beside motion, and what everyone sees of one. Plain data. MC_PathSelect, MC_MovePath: docs/motion/group-decisions.md.

#include <array>
#include <cstdint>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// A program's handle on a stored path of the machine (`paths` of the machine file). Trivially copyable; invalid by default.
struct PathRef {
    std::uint16_t index = 0xFFFF;
    [[nodiscard]] constexpr bool valid() const noexcept { return index != 0xFFFF; }
    friend constexpr bool operator==(PathRef, PathRef) = default;
};

/// How it is to be gone; counts from the next MC_PathSelect on.
struct PathOptions {
    std::uint32_t start_line = 1;  ///< of its text: what stands before is computed and not carried out
    bool single_block = false;     ///< asks for an acknowledgement behind each block
    bool optional_stop = false;    ///< M1 stops
    bool block_delete = false;     ///< blocks that begin with / are left out
    friend bool operator==(const PathOptions&, const PathOptions&) = default;
};

/// What somebody has to do. Those that ask stand until they are acknowledged; the others are told in their turn.
enum MC_PATH_REQUEST : std::uint8_t {
    mcPathNothing,
    mcPathStop,          ///< M0
    mcPathOptionalStop,  ///< M1
    mcPathBlockStop,     ///< a block is done, and blocks are gone one by one
    mcPathResume,        ///< started from a line: from here a straight line leads to where the program is there
    mcPathToolPrepare,   ///< T; told, not asked
    mcPathToolChange,    ///< M6
    mcPathSpindleClockwise,
    mcPathSpindleCounter,
    mcPathSpindleSpeed,  ///< S while it turns; told, not asked
    mcPathSpindleOff,
    mcPathMist,
    mcPathFlood,
    mcPathCoolantOff,
    mcPathUser,  ///< M100 to M199: Number; Value is P, Second Q
};

struct PathRequest {
    MC_PATH_REQUEST kind = mcPathNothing;
    std::uint32_t number = 0;  ///< of a tool, of an M word
    double value = 0;          ///< spindle: 1/min; mcPathUser: P, not a number where it has none
    double second = 0;         ///< mcPathUser: Q, likewise
    std::uint32_t line = 0;    ///< of the text, that asks for it
};

/// What a path meets where it cannot be gone, and where that is.
struct PathHindrance {
    static constexpr std::uint8_t none = 0xFF;
    std::uint8_t room =
        none;  ///< outside_workspace: the one that is kept free and entered, else the one that is left; its place in the workspace
    std::uint8_t place = none;      ///< the member whose limit it is (beyond_software_limit), or that is not ready (not_homed, not_powered)
    bool on_path = false;           ///< `part` is known
    bool in_space = false;          ///< `point` is
    bool limit_known = false;       ///< `position` and `limit` are
    double part = 0;                ///< 0 to 1, of the command's own way, from where it begins
    double length = 0;              ///< u of that way of the tool's point; 0: it is one of axes, or of turns
    std::array<double, 3> point{};  ///< X Y Z of the tool's point in the machine (MCS), u
    double position = 0, limit = 0;  ///< where that member would be, and what it may: in its own unit
};

/// Where in the text and on the path, and why.
struct PathPlace {
    ErrorId error = ErrorId::none;
    std::uint32_t line = 0;    ///< from 1; 0: nowhere
    std::uint32_t column = 0;  ///< bytes, from 1; 0: the line as a whole
    std::uint16_t fault = 0;   ///< ErrorId::path_program: of the language that it is written in (gcode::FaultKind)
    PathHindrance at{};
};

/// Of a stored path: what MC_PathSelect made of it.
struct PathState {
    enum class Kind : std::uint8_t { empty, preparing, ready, refused } kind = Kind::empty;
    std::uint32_t ticket = 0;  ///< of the selection that this is about
    std::uint32_t lines = 0;   ///< of its text, where it is ready
    PathPlace place{};         ///< why it was refused
};

/// Of the path that a group is on, or was on last.
struct PathView {
    PathRef path{};
    std::uint32_t line = 0;        ///< of the text: what the set-point carries out; 0: nothing
    std::uint32_t number = 0;      ///< its N word; no_block_number: none
    std::uint32_t request_id = 0;  ///< counts requests, from 1 in each group
    bool waits = false;            ///< the request wants to be acknowledged
    PathRequest request{};         ///< the last one
    PathPlace place{};             ///< why the last path ended with an error; of a stop, or the group's error, the line alone

    static constexpr std::uint32_t no_block_number = 0xFFFF'FFFF;
};

}  // namespace taktwerk::axes
