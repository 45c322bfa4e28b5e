#include "runtime/retain/position_watch.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::runtime {

namespace {

using namespace std::chrono_literals;

constexpr Duration standing_time = 2s;  // machines that stop and go do not write each time

/// Its reference may become another at any moment: what stands on the disk must not be believed from now on.
bool homes(const axes::AxisView& view) noexcept {
    return view.state == axes::AxisState::Homing || view.side[static_cast<std::size_t>(axes::SideSlot::passive_homing)] != 0;
}

}  // namespace

PositionWatch::PositionWatch(std::span<const AxisBinding> bindings, std::span<const RetainedAxis> kept)
    : watched_(bindings.size()), latest_(std::vector<axes::RetainedPosition>(bindings.size())) {
    for (std::size_t i = 0; i < bindings.size(); ++i) {
        const auto& axis = bindings[i].axis;
        RetainedAxis mine{axis.name, {}, axis.gearing};
        for (const auto& found : kept)
            if (found.name == axis.name) mine = found;
        const double window = axis.memory.moved_while_off * std::abs(axis.gearing.counts_per_unit());
        watched_[i].written = mine.position;
        watched_[i].at_rest_step = static_cast<std::int64_t>(std::min(window / 4, 1e15));
        watched_[i].moving_step = (axis.memory.range > 0 ? axis.memory.range : std::int64_t{1} << 32) / 8;
        kept_.push_back(std::move(mine));
    }
}

void PositionWatch::restore(std::span<axes::Axis> axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].config().simulated) continue;  // its drive forgets; what is kept is the real one's
        axes[i].restore(kept_[i].position, kept_[i].gearing);
        kept_[i].gearing = axes[i].config().gearing;
    }
}

bool PositionWatch::differs(const Watched& axis, const axes::RetainedPosition& now) noexcept {
    const auto& before = axis.written;
    if (now.homed != before.homed) return true;
    if (!now.homed) return false;
    if (now.shift != before.shift || now.at_rest != before.at_rest) return true;
    const auto way = now.counts > before.counts ? now.counts - before.counts : before.counts - now.counts;
    return way > (now.at_rest ? axis.at_rest_step : axis.moving_step);
}

void PositionWatch::look(std::span<const axes::Axis> axes, Instant now, bool ending) noexcept {
    bool changed = false;
    all_known_ = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].config().simulated) continue;
        auto& watched = watched_[i];
        auto position = axes[i].retained();
        all_known_ = all_known_ && (position.homed || !axes[i].config().memory.absolute);
        if (homes(axes[i].view())) position = {};
        if (!position.at_rest) watched.moved = now;
        if (!ending && now - watched.moved < standing_time) position.at_rest = false;
        if (!differs(watched, position)) continue;
        watched.written = position;
        changed = true;
    }
    if (!changed) return;
    auto& back = latest_.back();
    for (std::size_t i = 0; i < watched_.size(); ++i) back[i] = watched_[i].written;
    latest_.publish();
}

bool PositionWatch::take() {
    const auto reading = latest_.read();
    if (reading.is_new)
        for (std::size_t i = 0; i < kept_.size(); ++i) kept_[i].position = (*reading.value)[i];
    return reading.is_new;
}

std::vector<RetainedAxis> PositionWatch::homed() const {
    std::vector<RetainedAxis> out;
    for (const auto& axis : kept_)
        if (axis.position.homed) out.push_back(axis);
    return out;
}

}  // namespace taktwerk::runtime
