#pragma once
// What a block inherits from those before it.

#include "fb_library/gcode/interpreter_options.hpp"

namespace taktwerk::gcode {

/// The plane's axes: G17 XY, G18 ZX, G19 YZ; the third one is its normal.
struct ArcPlane {
    std::uint8_t first = 0, second = 1, normal = 2;
};

struct ModalState {
    enum class Motion : std::uint8_t { none, rapid, line, clockwise, counter_clockwise } motion = Motion::none;
    enum class Distance : std::uint8_t { absolute, relative } distance = Distance::absolute, arc_distance = Distance::relative;
    enum class FeedMode : std::uint8_t { per_minute, inverse_time } feed_mode = FeedMode::per_minute;
    ArcPlane plane{};
    double unit_mm = 1;                ///< of a linear number: 1 or 25.4
    double feed = 0;                   ///< F as written, per minute; 0: none
    double feed_unit_mm = 1;           ///< the unit in which it was written
    std::size_t system = 0;            ///< G54 is 0
    AxisValues shift{}, kept_shift{};  ///< G92: in force, and what G92.3 brings back
    AxisValues length{};               ///< G43
    PathMode path{};
};

/// What was switched on, for whoever goes on in the middle of a program.
struct ProgramOutputs {
    enum class Spindle : std::uint8_t { off, clockwise, counter } spindle = Spindle::off;
    double speed = -1;  ///< S, 1/min; negative: never given
    bool mist = false, flood = false;
    std::uint32_t tool = 0;                 ///< in the spindle; 0: none
    std::int64_t selected = -1;             ///< T; negative: never given
    std::uint32_t user_codes_left_out = 0;  ///< M100 to M199 before a start line: what they did is not known here
};

}  // namespace taktwerk::gcode
