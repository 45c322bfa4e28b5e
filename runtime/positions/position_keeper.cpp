#include "runtime/positions/position_keeper.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::runtime {

namespace {

using namespace std::chrono_literals;

constexpr Duration standing_time = 2s;  // machines that stop and go do not write each time
constexpr Duration retry_after = 1s;
constexpr Duration slow_disk = 3s;  // a disk that was asleep takes about as long

/// Its reference may become another at any moment: what stands on the disk must not be believed from now on.
bool homes(const axes::AxisView& view) noexcept {
    return view.state == axes::AxisState::Homing || view.side[static_cast<std::size_t>(axes::SideSlot::passive_homing)] != 0;
}

}  // namespace

PositionKeeper::PositionKeeper(const std::filesystem::path& directory, std::span<const AxisBinding> bindings, std::vector<Error>& errors)
    : store_(directory), watched_(bindings.size()), latest_(std::vector<axes::RetainedPosition>(bindings.size())) {
    if (auto in_use = store_.lock()) errors.push_back(std::move(*in_use));
    const auto loaded = store_.load();
    lost_ = loaded.lost;
    for (std::size_t i = 0; i < bindings.size(); ++i) {
        const auto& axis = bindings[i].axis;
        RetainedAxis mine{axis.name, {}, axis.gearing};
        for (const auto& found : loaded.axes)
            if (found.name == axis.name) mine = found;
        const double window = axis.memory.moved_while_off * std::abs(axis.gearing.counts_per_unit());
        watched_[i].written = mine.position;
        watched_[i].at_rest_step = static_cast<std::int64_t>(std::min(window / 4, 1e15));
        watched_[i].moving_step = (axis.memory.range > 0 ? axis.memory.range : std::int64_t{1} << 32) / 8;
        kept_.push_back(std::move(mine));
    }
}

void PositionKeeper::restore(std::span<axes::Axis> axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].config().simulated) continue;  // its drive forgets; what is kept is the real one's
        axes[i].restore(kept_[i].position, kept_[i].gearing);
        kept_[i].gearing = axes[i].config().gearing;
    }
}

bool PositionKeeper::differs(const Watched& axis, const axes::RetainedPosition& now) noexcept {
    const auto& before = axis.written;
    if (now.homed != before.homed) return true;
    if (!now.homed) return false;
    if (now.shift != before.shift || now.at_rest != before.at_rest) return true;
    const auto way = now.counts > before.counts ? now.counts - before.counts : before.counts - now.counts;
    return way > (now.at_rest ? axis.at_rest_step : axis.moving_step);
}

void PositionKeeper::watch(std::span<const axes::Axis> axes, Instant now, bool ending) noexcept {
    bool changed = false, all_known = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (axes[i].config().simulated) continue;
        auto& watched = watched_[i];
        auto position = axes[i].retained();
        all_known = all_known && (position.homed || !axes[i].config().memory.absolute);
        if (homes(axes[i].view())) position = {};
        if (!position.at_rest) watched.moved = now;
        if (!ending && now - watched.moved < standing_time) position.at_rest = false;
        if (!differs(watched, position)) continue;
        watched.written = position;
        changed = true;
    }
    lost_ = lost_ && !all_known;
    if (!changed) return;
    auto& back = latest_.back();
    for (std::size_t i = 0; i < watched_.size(); ++i) back[i] = watched_[i].written;
    latest_.publish();
}

bool PositionKeeper::hangs(Instant now) const noexcept {
    const auto since = writing_since_.load(std::memory_order_relaxed);
    return since >= 0 && now.time_since_epoch() - Duration{since} > slow_disk;
}

void PositionKeeper::step(Instant now) {
    const auto reading = latest_.read();
    if (reading.is_new)
        for (std::size_t i = 0; i < kept_.size(); ++i) kept_[i].position = (*reading.value)[i];
    const bool again = failing() && now >= retry_at_;
    if (!reading.is_new && !again && proved_) return;
    proved_ = true;
    std::vector<RetainedAxis> homed;
    for (const auto& axis : kept_)
        if (axis.position.homed) homed.push_back(axis);
    writing_since_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    const auto saved = store_.save(homed);
    writing_since_.store(-1, std::memory_order_relaxed);
    failing_.store(!saved.ok(), std::memory_order_relaxed);
    outdated_.store(!saved.ok() && saved.error().code == "positions.outdated", std::memory_order_relaxed);
    retry_at_ = now + retry_after;
}

}  // namespace taktwerk::runtime
