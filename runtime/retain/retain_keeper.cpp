#include "runtime/retain/retain_keeper.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

using namespace std::chrono_literals;

constexpr Duration retry_after = 1s;
constexpr Duration slow_disk = 3s;  // a disk that was asleep takes about as long

RetainStore::Loaded load(RetainStore& store, RetainStart start, std::vector<Error>& errors) {
    if (auto in_use = store.lock()) errors.push_back(std::move(*in_use));
    auto loaded = store.load();
    if (start == RetainStart::origin) loaded.kept.axes.clear();
    return loaded;
}

std::vector<std::byte> image_of(std::span<const RetainedItem> items) {
    std::vector<std::byte> image;
    for (const auto& item : items) {
        const auto* begin = static_cast<const std::byte*>(item.address);
        image.insert(image.end(), begin, begin + item.size);
    }
    return image;
}

}  // namespace

RetainKeeper::RetainKeeper(const RetainConfig& config, std::span<const AxisBinding> bindings, std::vector<Error>& errors)
    : config_(config),
      store_(config.directory),
      loaded_(load(store_, config.start, errors)),
      positions_(bindings, loaded_.kept.axes),
      positions_lost_(loaded_.lost) {}

void RetainKeeper::restore(std::span<const RetainedItem> items, std::span<const MachineLayout::ParameterInfo> infos,
                           std::span<double> parameters, std::span<const RetainBound> bounds) {
    values_.emplace(items, infos);
    notes_ = values_->restore(loaded_.kept, config_.start, parameters, bounds);
    // Behind an alarm when nothing was left; where the other file is used this is all that is said of it.
    for (const auto& damage : loaded_.damage)
        notes_.push_back({RetainNote::What::damaged, damage.subject,
                          fmt::format("{}: {}; {}", damage.subject, damage.what,
                                      loaded_.lost ? "the other one is not usable either"
                                                   : "the other one is used, which is one writing older at most")});
    values_lost_ = loaded_.lost && !(items.empty() && infos.empty());
    loaded_ = {};
    parameters_.assign(parameters.begin(), parameters.end());
    to_write_ = {image_of(items), parameters_};
    latest_.emplace(to_write_);
}

void RetainKeeper::watch(std::span<const axes::Axis> axes, const Values& values, Instant now, bool ending, bool power_fails) noexcept {
    positions_.look(axes, now, ending);
    positions_lost_ = positions_lost_ && !positions_.all_known();
    waits_ =
        waits_ || values.changed || !std::equal(values.parameters.begin(), values.parameters.end(), parameters_.begin(), parameters_.end());
    const bool fails_now = power_fails && !power_failed_;
    power_failed_ = power_fails;
    if (!waits_ || !(ending || fails_now || now >= publish_at_)) return;
    publish(values);
    publish_at_ = now + config_.every;
}

void RetainKeeper::publish(const Values& values) noexcept {
    std::copy(values.parameters.begin(), values.parameters.end(), parameters_.begin());
    auto& back = latest_->back();
    std::copy(values.image.begin(), values.image.end(), back.image.begin());
    std::copy(values.parameters.begin(), values.parameters.end(), back.parameters.begin());
    latest_->publish();
    waits_ = false;
}

bool RetainKeeper::hangs(Instant now) const noexcept {
    const auto since = writing_since_.load(std::memory_order_relaxed);
    return since >= 0 && now.time_since_epoch() - Duration{since} > slow_disk;
}

void RetainKeeper::step(Instant now) {
    bool anything = positions_.take();
    if (const auto reading = latest_->read(); reading.is_new) {
        to_write_ = *reading.value;
        anything = true;
    }
    const bool again = failing() && now >= retry_at_;
    if (!anything && !again && proved_) return;
    proved_ = true;
    Kept kept;
    kept.axes = positions_.homed();
    values_->write(to_write_.image, to_write_.parameters, kept);
    writing_since_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    const auto saved = store_.save(std::move(kept));
    writing_since_.store(-1, std::memory_order_relaxed);
    failing_.store(!saved.ok(), std::memory_order_relaxed);
    outdated_.store(!saved.ok() && saved.error().code == "retain.outdated", std::memory_order_relaxed);
    retry_at_ = now + retry_after;
}

}  // namespace taktwerk::runtime
