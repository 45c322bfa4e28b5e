#pragma once
// The closed loop from the set-point in effect to the actual position, tone by tone (MeasureKind::sweep), and the open loop that follows from it.
//
// L = T / (1 - T) is the open loop only where nothing but the following error drives the axis: with velocity or torque feed-forward T is
// nearer to 1 than the loop alone would make it, and margins look better than they are. Not real-time.

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

struct FrequencyPoint {
    double frequency = 0;         ///< Hz
    double amplitude = 0;         ///< u, of the set-point: what was asked for or what the limits allow
    bool limited = false;         ///< by the axis' limits, not by what was asked
    std::complex<double> closed;  ///< T
    std::complex<double> open;    ///< L
    double deviation = 0;         ///< of |T|
    double quality = 0;           ///< part of the motion that is this tone, 0 to 1
    bool usable = false;          ///< the answer stands above noise and resolution
    bool open_usable = false;     ///< 1 - T does too
};

/// A margin and the frequency at which it is read.
struct Margin {
    double value = 0, frequency = 0;
};

struct LoopMargins {
    std::optional<Margin> phase;            ///< degrees, where |L| = 1
    std::optional<Margin> gain;             ///< dB, where the phase of L is -180 degrees
    std::optional<Margin> bandwidth;        ///< Hz: the first time |T| is below -3 dB
    std::optional<Margin> phase_bandwidth;  ///< Hz: the first time the phase of T is below -90 degrees
    std::optional<Margin> resonance;        ///< dB: the highest |T| above 1 dB, inside the sweep
    std::optional<Margin> notch;            ///< dB: the deepest valley of |T|, 3 dB or more below both sides: what swings behind the motor
};

struct FrequencyResponse {
    Doubt doubt = Doubt::none;
    std::vector<FrequencyPoint> points;  ///< frequency rises
    LoopMargins margins;
};

[[nodiscard]] FrequencyResponse frequency_response(const AlignedRun& run, const ExcitationPlan& plan);

/// Of the usable points, between them linear in the logarithms.
[[nodiscard]] LoopMargins margins_of(std::span<const FrequencyPoint> points);

/// Phases in degrees, without leaps from one point to the next; the first in (-180, 180].
[[nodiscard]] std::vector<double> phases_of(std::span<const FrequencyPoint> points, std::complex<double> FrequencyPoint::*which);

}  // namespace taktwerk::axes::measuring
