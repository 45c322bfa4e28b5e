#pragma once
// What carries the load besides one motor: the other side of a portal, and an encoder of the load's own. Plain data.

#include <chrono>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes {

/// Two drives that move one portal: how far they may be apart.
struct GantryConfig {
    bool on = false;
    double warning = 0;          ///< u of skew: shown; 0 = never
    double error = 0;            ///< u of skew, > 0: the axis stops
    double square_velocity = 0;  ///< u/s at which homing squares the portal by the sides' switches; 0 = it does not
    double square_offset = 0;    ///< u that the follower's switch lies further than the leader's where the portal is square
};

/// A second encoder, at the load: an input of the machine says its counts.
struct LoadEncoderConfig {
    bool on = false;
    std::uint16_t input = 0xFFFF;                   ///< index of the input point; the machine puts it in
    double counts_per_unit = 0;                     ///< > 0
    bool inverted = false;                          ///< it counts against the axis' sense
    std::uint8_t bits = 32;                         ///< of its counter, which begins anew beyond them; 8 to 64
    double tolerance = 0;                           ///< u, > 0: motor and load may differ by it
    Duration time = std::chrono::milliseconds{10};  ///< longer than this: alarm
    bool shown = false;                             ///< the axis' actual position is the load's
};

}  // namespace taktwerk::axes
