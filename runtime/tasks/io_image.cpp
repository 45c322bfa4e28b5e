#include "runtime/tasks/io_image.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/group_presence.hpp"

namespace taktwerk::runtime {

namespace {

std::int64_t logical(std::int64_t value, const IoPoint& point, const Signal& signal) noexcept {
    return point.inverted && signal.bits == 1 ? 1 - (value & 1) : value;
}

/// The low bits, read again as the terminal reads them.
std::int64_t carried(std::int64_t value, const Signal& signal) noexcept {
    if (signal.bits == 0 || signal.bits >= 64) return value;
    const auto mask = (std::uint64_t{1} << signal.bits) - 1, sign = std::uint64_t{1} << (signal.bits - 1);
    const auto low = static_cast<std::uint64_t>(value) & mask;
    return static_cast<std::int64_t>(signal.is_signed && (low & sign) != 0 ? low | ~mask : low);
}

/// What the bits of an object hold.
PointLine line_of(const IoPoint& point, const Signal& signal) noexcept {
    PointLine line = point.line;
    line.fit(signal.bits, signal.is_signed);
    return line;
}

/// An alarm at a limit ends a little inside of it, so that noise at the limit is one alarm.
constexpr double limit_hysteresis = 0.01;  // of the width between the limits

IoImage::Trouble beyond(const PointLimits& limits, double value, IoImage::Trouble before) noexcept {
    using Trouble = IoImage::Trouble;
    const double inside = limit_hysteresis * (limits.high - limits.low);
    if (value < limits.low + (before == Trouble::below_limit ? inside : 0)) return Trouble::below_limit;
    if (value > limits.high - (before == Trouble::above_limit ? inside : 0)) return Trouble::above_limit;
    return Trouble::none;
}

IoImage::Trouble trouble_of(PointStatus::Kind kind) noexcept {
    switch (kind) {
        case PointStatus::Kind::underrange: return IoImage::Trouble::underrange;
        case PointStatus::Kind::overrange: return IoImage::Trouble::overrange;
        case PointStatus::Kind::error: break;
    }
    return IoImage::Trouble::error;
}

}  // namespace

IoImage::IoImage(const std::vector<IoPoint>& points, Duration cycle) : cycle_s_(to_seconds(cycle)) {
    for (const auto& point : points) {
        if (point.direction == IoDirection::input) {
            input_points_.emplace_back().config = point;
            inputs_.push_back(0);
        } else {
            output_points_.emplace_back().config = point;
            outputs_.push_back(point.safe_value);
            output_lines_.push_back(point.line);
        }
    }
    input_values_.resize(inputs_.size());
    troubles_.resize(inputs_.size());
    forces_.reserve(max_forces);
}

Result<Signal> IoImage::signal_of(const ecat::Master& bus, const Point& point, std::uint16_t index, std::uint8_t sub) const {
    auto signal = point.config.direction == IoDirection::input ? bus.input(point.slave, index, sub) : bus.output(point.slave, index, sub);
    if (signal) return signal;
    auto error = signal.error();
    error.subject = fmt::format("io point '{}'", point.config.name);
    return error;
}

Result<void> IoImage::resolve(const ecat::Master& bus, Point& point) const {
    if (point.config.beside) {
        point.signal = *point.config.beside;
        point.config.line = line_of(point.config, point.signal);
        return {};
    }
    if (point.config.presence) {
        point.group = group_index(bus, point.config.presence->group);
        point.signal.bits = 1;
        point.config.line = line_of(point.config, point.signal);
        return {};
    }
    point.slave = 0;
    while (point.slave < bus.slave_count() && bus.slave(point.slave).name != point.config.slave) ++point.slave;
    if (point.slave == bus.slave_count())
        return Error{"io.unknown_slave", fmt::format("io point '{}'", point.config.name),
                     fmt::format("there is no slave '{}' on the bus", point.config.slave), "correct `slave:` of the point"};
    point.group = group_index(bus, bus.slave(point.slave).hot_connect);
    point.away = point.group >= 0;
    const auto signal = signal_of(bus, point, point.config.index, point.config.sub);
    if (!signal) return signal.error();
    point.signal = *signal;
    point.config.line = line_of(point.config, point.signal);
    point.status.clear();
    for (const auto& status : point.config.status) {
        const auto bit = signal_of(bus, point, status.index, status.sub);
        if (!bit) return bit.error();
        point.status.push_back({status.kind, *bit});
    }
    return {};
}

Result<void> IoImage::resolve(const ecat::Master& bus) {
    for (auto* points : {&input_points_, &output_points_})
        for (auto& point : *points)
            if (auto ok = resolve(bus, point); !ok) return ok;
    output_bits_.clear();
    output_lines_.clear();
    for (const auto& point : output_points_) {
        output_bits_.push_back(static_cast<std::uint8_t>(std::min(64, static_cast<int>(point.signal.bits))));
        output_lines_.push_back(point.config.line);
    }
    return {};
}

void IoImage::read(std::span<const std::byte> image, const ecat::Master& bus) noexcept {
    read_presence(bus);
    for (std::size_t i = 0; i < input_points_.size(); ++i) {
        const auto& p = input_points_[i];
        if (p.config.beside) {
            word_of(i) = logical(p.beside.word, p.config, *p.config.beside);
            judge(i, image, p.beside.fresh, p.beside.fresh);
            continue;
        }
        if (p.group >= 0 && watch_group(i, bus)) continue;
        word_of(i) = logical(read_signal(image, p.signal), p.config, p.signal);
        if (p.slave >= bus.slave_count()) continue;
        const auto& slave = bus.health(p.slave);
        judge(i, image, slave.fresh, slave.age == 0);
    }
}

bool IoImage::watch_group(std::size_t input, const ecat::Master& bus) noexcept {
    auto& p = input_points_[input];
    const auto presence = presence_of(bus, p.group);
    auto& shown = value_of(input);
    if (p.config.presence) {
        word_of(input) = presence == p.config.presence->shows ? 1 : 0;
        shown = {static_cast<double>(word_of(input)), true};
        return true;
    }
    if (presence == axes::Presence::present) return false;
    // The last value stands, and nobody may believe it. What joins begins anew.
    p.seen = shown.good = false;
    troubles_[input] = Trouble::none;
    return true;
}

void IoImage::take_beside(std::size_t input, std::int64_t word, bool fresh) noexcept { input_points_[input].beside = {word, fresh}; }

std::int64_t IoImage::beside(std::size_t output) const noexcept {
    const auto& point = output_points_[output].config;
    return logical(carried(output_word(output), *point.beside), point, *point.beside);
}

void IoImage::judge(std::size_t input, std::span<const std::byte> image, bool fresh, bool young) noexcept {
    auto& p = input_points_[input];
    auto& shown = value_of(input);
    const double value = p.config.line.value_of(word_of(input));
    const bool filtered = p.config.filter > Duration::zero() && p.seen && std::isfinite(shown.value);
    shown.value = filtered ? shown.value + (value - shown.value) * cycle_s_ / (cycle_s_ + to_seconds(p.config.filter)) : value;
    if (fresh) {
        p.seen = true;
        auto trouble = Trouble::none;
        for (const auto& status : p.status)
            if (trouble != Trouble::error && read_signal(image, status.signal) != 0) trouble = trouble_of(status.kind);
        if (trouble == Trouble::none && !std::isfinite(value)) trouble = Trouble::no_number;
        if (trouble == Trouble::none && p.config.limits) trouble = beyond(*p.config.limits, shown.value, troubles_[input]);
        troubles_[input] = trouble;
    }
    // A real number that is none (NaN, infinite) is no value. Between the turns of a slower sync unit it stays so.
    shown.good = p.seen && young && troubles_[input] == Trouble::none && std::isfinite(value);
}

void IoImage::read_presence(const ecat::Master& bus) noexcept {
    for (auto& p : output_points_)
        if (p.group >= 0) p.away = presence_of(bus, p.group) != axes::Presence::present;
}

void IoImage::write(std::span<std::byte> image) noexcept {
    for (std::size_t i = 0; i < output_points_.size(); ++i) {
        const auto& p = output_points_[i];
        outputs_[i] = carried(outputs_[i], p.signal);
        if (p.config.beside) continue;
        const auto word = p.away ? carried(p.config.safe_value, p.signal) : output_word(i);
        write_signal(image, p.signal, logical(word, p.config, p.signal));
    }
}

void IoImage::make_safe() noexcept {
    for (std::size_t i = 0; i < output_points_.size(); ++i) outputs_[i] = output_points_[i].config.safe_value;
}

bool IoImage::fits(std::size_t output, double value) const noexcept {
    const auto& point = output_points_[output].config;
    const bool whole = !point.unit.empty() || !point.line.is_plain() || value == std::floor(value);
    return whole && output_lines_[output].holds(value);
}

int IoImage::find(IoDirection direction, std::string_view name) const noexcept {
    const auto& points = direction == IoDirection::input ? input_points_ : output_points_;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].config.name == name) return static_cast<int>(i);
    return -1;
}

const IoPoint& IoImage::point(IoDirection direction, std::size_t index) const noexcept {
    return direction == IoDirection::input ? input_points_[index].config : output_points_[index].config;
}

std::vector<std::string> IoImage::names(IoDirection direction) const {
    std::vector<std::string> out;
    for (const auto& point : direction == IoDirection::input ? input_points_ : output_points_) out.push_back(point.config.name);
    return out;
}

}  // namespace taktwerk::runtime
