#include "axes/sim/drive_homing.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

bool DriveHoming::asked(const AxisInputs& in) noexcept {
    const bool held = (in.control & 0x10u) != 0, halt = (in.control & 0x100u) != 0;
    if (held && !halt) return !bit_;
    run_.abort();
    return false;
}

void DriveHoming::start(const AxisInputs& in, const DriveProfile& profile, const HomingView& view) noexcept {
    attained_ = failed_ = false;
    offset_ = in.home_offset;
    position_method_ = in.home_position_method;
    const auto number = in.homing.method == 19 && profile.has(Quirk::homing_19_starts_negative) ? 21 : in.homing.method;
    const auto& documented = profile.homing_methods;  // none: it knows them all
    const bool known = in.homing.method >= -2 && in.homing.method < 62 &&
                       (documented.empty() || std::find(documented.begin(), documented.end(), in.homing.method) != documented.end());
    run_.start(in.homing, known ? homing_method(number) : HomingMethod{}, view);
}

void DriveHoming::forget() noexcept {
    run_.cancel();
    attained_ = failed_ = false;
}

DriveHoming::News DriveHoming::step(double dt, const HomingView& view) noexcept {
    run_.step(dt, view);
    if (run_.state() == HomingRun::State::failed && !failed_) {
        failed_ = true;
        return News::failed;
    }
    if (run_.state() == HomingRun::State::attained && !attained_) {
        attained_ = true;
        return News::attained;
    }
    return News::none;
}

double DriveHoming::shift(double zero) const noexcept {
    const auto offset = static_cast<double>(offset_);
    return position_method_ == 1 ? -offset : std::floor(run_.reference() - zero) - offset;
}

}  // namespace taktwerk::axes::sim
