#include "axes/coupling/cam_curve.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

bool CamCurve::set(const PreparedCam& cam, const CamFit& fit) noexcept {
    *this = {};
    cam_ = &cam;
    fit_ = fit;
    sense_ = fit.master_scaling < 0 ? -1 : 1;
    pass_length_ = cam.length() * std::abs(fit.master_scaling);
    feeds_ = fit.master_origin.feeds;
    if (!passes_.set(fit.master_feed, fit.master_scaling < 0 ? -1 : 1, 1, pass_length_)) return false;
    const double stroke = cam.stroke() * fit.slave_scaling;
    return stroke == 0 || strokes_.set(std::abs(stroke), stroke < 0 ? -1 : 1, 1, fit.slave_feed);
}

CamCurve::Spot CamCurve::locate(const EndlessPlace& master) noexcept {
    passes_.advance(master.feeds - feeds_);
    feeds_ = master.feeds;
    const double from = passes_.rest() + sense_ * (master.local - fit_.master_origin.local);
    const double more = std::floor(from / pass_length_);
    // Rounding may leave a hair below 0 or up to the length itself.
    return {passes_.whole() + static_cast<std::int64_t>(more), std::clamp(from - more * pass_length_, 0.0, pass_length_)};
}

EndlessPlace CamCurve::slave_end() const noexcept {
    return {fit_.slave_origin.feeds, fit_.slave_origin.local + fit_.slave_scaling * (cam_->at(held_).position - fit_.table_origin)};
}

EndlessMotion CamCurve::at(const EndlessMotion& master) noexcept {
    const auto spot = locate(master.place);
    const std::int64_t before = seen_ ? pass_ : spot.pass;
    seen_ = true;
    pass_ = spot.pass;
    strokes_.advance(cam_->periodic() ? spot.pass - before : 0);

    double table = spot.at / std::abs(fit_.master_scaling);
    bool holds = false;
    if (spot.pass != before) {
        // Forwards through the end of the pass before, backwards through the beginning of the one after. end_: as the master stands now
        // minus what it has gone since.
        const double since = spot.pass > before ? spot.at : spot.at - pass_length_;
        end_ = {master.place.feeds, master.place.local - sense_ * since};
    }
    if (cam_->periodic()) {
        ends_ += static_cast<std::uint32_t>(std::abs(spot.pass - before));
    } else {
        if (phase_ == Phase::outside && (spot.pass == 0 || (before < 0) != (spot.pass < 0))) phase_ = Phase::inside;
        if (phase_ == Phase::inside && spot.pass != 0) {
            phase_ = Phase::over;
            held_ = spot.pass > 0 ? cam_->length() : 0;
            ++ends_;
        }
        holds = spot.pass != 0 || phase_ == Phase::over;
        if (phase_ == Phase::over) table = held_;
        else if (spot.pass != 0) table = spot.pass > 0 ? cam_->length() : 0;
    }

    const auto value = cam_->at(std::min(table, cam_->length()));
    EndlessMotion slave;
    slave.place = {fit_.slave_origin.feeds + strokes_.whole(),
                   fit_.slave_origin.local + strokes_.rest() + fit_.slave_scaling * (value.position - fit_.table_origin)};
    if (holds) return slave;
    const double slope = value.first / fit_.master_scaling;
    const double curvature = value.second / (fit_.master_scaling * fit_.master_scaling);
    slave.velocity = fit_.slave_scaling * slope * master.velocity;
    slave.acceleration = fit_.slave_scaling * (slope * master.acceleration + curvature * master.velocity * master.velocity);
    return slave;
}

}  // namespace taktwerk::axes
