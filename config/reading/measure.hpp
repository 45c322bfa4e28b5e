#pragma once
// Numbers whose unit is free: what a sensor measures is bar, degC, %, kN, parts. Two that belong together have the same one.

#include <string>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

struct Measure {
    double value = 0;
    std::string unit;  ///< empty: written without one
};
[[nodiscard]] Codec<Measure> measure();

/// [low, high] in one unit; they differ.
struct MeasurePair {
    double first = 0, second = 0;
    std::string unit;
};
[[nodiscard]] Codec<MeasurePair> measure_pair();

/// mA, such as `130 mA`.
[[nodiscard]] Codec<std::int16_t> milliampere();

}  // namespace taktwerk::config
