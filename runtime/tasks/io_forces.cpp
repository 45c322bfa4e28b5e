// Forcing points of the image. Real-time safe.

#include <cmath>

#include "runtime/tasks/io_image.hpp"

namespace taktwerk::runtime {

bool IoImage::can_force(IoDirection direction, std::size_t index, double value) const noexcept {
    const auto& points = direction == IoDirection::input ? input_points_ : output_points_;
    if (index >= points.size()) return false;
    const auto& point = points[index].config;
    const bool whole = !point.unit.empty() || !point.line.is_plain() || value == std::floor(value);
    return whole && point.line.holds(value);
}

bool IoImage::force(IoDirection direction, std::size_t index, double value, std::uint32_t client) noexcept {
    auto& point = direction == IoDirection::input ? input_points_[index] : output_points_[index];
    const auto word = point.config.line.raw_of(value);
    const auto place = static_cast<std::uint16_t>(index);
    if (!point.forced) {
        if (forces_.size() >= max_forces) return false;
        if (direction == IoDirection::input) {
            point.real_word = inputs_[index];
            point.real = input_values_[index];
        }
        point.forced = true;
        forces_.push_back({direction, place, client, value});
    }
    const double shown = point.config.line.value_of(word);  // as far as the bits go
    for (auto& force : forces_)
        if (force.direction == direction && force.index == place) force = {direction, place, client, shown};
    if (direction == IoDirection::output) {
        point.forced_word = word;
    } else {
        inputs_[index] = word;
        input_values_[index] = {shown, true};
    }
    return true;
}

void IoImage::end_force(const ForcedPoint& force) noexcept {
    auto& point = force.direction == IoDirection::input ? input_points_[force.index] : output_points_[force.index];
    point.forced = false;
    if (force.direction == IoDirection::output) return;
    inputs_[force.index] = point.real_word;
    input_values_[force.index] = point.real;
}

template <class Which>
void IoImage::release_those(Which which) noexcept {
    std::size_t kept = 0;
    for (const auto& force : forces_) {
        if (which(force)) end_force(force);
        else forces_[kept++] = force;
    }
    forces_.resize(kept);
}

void IoImage::release_force(IoDirection direction, std::size_t index) noexcept {
    release_those([&](const ForcedPoint& force) { return force.direction == direction && force.index == index; });
}

void IoImage::release_forces_of(std::uint32_t client) noexcept {
    release_those([&](const ForcedPoint& force) { return force.client == client; });
}

void IoImage::release_forces() noexcept {
    release_those([](const ForcedPoint&) { return true; });
}

void IoImage::release_output_forces() noexcept {
    release_those([](const ForcedPoint& force) { return force.direction == IoDirection::output; });
}

}  // namespace taktwerk::runtime
