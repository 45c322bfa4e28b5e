#include "axes/coupling/master_track.hpp"

#include <cmath>

namespace taktwerk::axes {

namespace {

// A tracking filter whose two poles lie at the same place of the unit circle (critically damped): e^(-1 / settling_cycles).
constexpr double pole = 0.88249690258459546;
static_assert(MasterTrack::settling_cycles == 8);
constexpr double position_gain = 1 - pole * pole;
constexpr double velocity_gain = (1 - pole) * (1 - pole);

}  // namespace

bool MasterTrack::next(const Reading& reading, double period) noexcept {
    if (!reading.usable) return false;
    const auto& now = reading.motion;
    const bool first = !known_;
    if (first) {
        known_ = true;
        gap_ = 0;
        last_ = now.place;
        filter_ = {now.place, now.velocity, 0};
        acceleration_ = 0;
    }
    ++gap_;
    const double passed = period * gap_;  // since the last fresh one
    if (reading.fresh) {
        // Nothing moves twice as fast as its limit: the place got another number (its zero, another encoder).
        if (std::abs(way(last_, now.place, reading.feed)) > 2 * reading.largest_velocity * passed) return false;
        last_ = now.place;
        gap_ = 0;
    }
    if (reading.planned) {
        out_ = now;
        out_.trend = now.velocity;
        filter_ = {now.place, now.velocity, 0};
        acceleration_ = now.acceleration;
        return true;
    }

    // A reading that is not fresh has become older instead.
    const double before = filter_.velocity;
    if (reading.fresh && !first) {
        filter_.place.local += filter_.velocity * passed;
        // The filter keeps the reading's feeds, so its local part stays small.
        const double error = way(filter_.place, now.place, reading.feed);
        filter_.place = {now.place.feeds, now.place.local - error};
        filter_.place.local += position_gain * error;
        filter_.velocity += velocity_gain * error / passed;
    }
    if (reading.fresh) acceleration_ += (1 - pole) * ((filter_.velocity - before) / passed - acceleration_);
    const auto given = out_.place;
    out_ = filter_;
    out_.acceleration = acceleration_;
    out_.trend = filter_.velocity;
    out_.place.local += filter_.velocity * reading.age;
    // The filter's own velocity comes late after its place while the master speeds up: whoever followed both would leave the place.
    if (!first) out_.velocity = way(given, out_.place, reading.feed) / period;
    return true;
}

}  // namespace taktwerk::axes
