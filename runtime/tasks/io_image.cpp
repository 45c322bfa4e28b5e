#include "runtime/tasks/io_image.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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

}  // namespace

IoImage::IoImage(const std::vector<IoPoint>& points) {
    for (const auto& point : points) {
        if (point.direction == IoDirection::input) {
            input_points_.push_back({point, {}});
            inputs_.push_back(0);
        } else {
            output_points_.push_back({point, {}});
            outputs_.push_back(point.safe_value);
        }
    }
}

Result<void> IoImage::resolve(const ecat::Master& bus) {
    const auto slave_of = [&](const std::string& name) -> std::size_t {
        for (std::size_t i = 0; i < bus.slave_count(); ++i)
            if (bus.slave(i).name == name) return i;
        return bus.slave_count();
    };
    for (auto* points : {&input_points_, &output_points_}) {
        for (auto& point : *points) {
            const auto slave = slave_of(point.config.slave);
            if (slave == bus.slave_count())
                return Error{"io.unknown_slave", fmt::format("io point '{}'", point.config.name),
                             fmt::format("there is no slave '{}' on the bus", point.config.slave), "correct `slave:` of the point"};
            auto signal = points == &input_points_ ? bus.input(slave, point.config.index, point.config.sub)
                                                   : bus.output(slave, point.config.index, point.config.sub);
            if (!signal) {
                auto error = signal.error();
                error.subject = fmt::format("io point '{}'", point.config.name);
                return error;
            }
            point.signal = *signal;
        }
    }
    output_bits_.clear();
    for (const auto& point : output_points_)
        output_bits_.push_back(static_cast<std::uint8_t>(std::min(64, static_cast<int>(point.signal.bits))));
    return {};
}

void IoImage::read(std::span<const std::byte> image) noexcept {
    for (std::size_t i = 0; i < input_points_.size(); ++i) {
        const auto& p = input_points_[i];
        inputs_[i] = logical(read_signal(image, p.signal), p.config, p.signal);
    }
}

void IoImage::write(std::span<std::byte> image) noexcept {
    for (std::size_t i = 0; i < output_points_.size(); ++i) {
        const auto& p = output_points_[i];
        outputs_[i] = carried(outputs_[i], p.signal);
        write_signal(image, p.signal, logical(outputs_[i], p.config, p.signal));
    }
}

void IoImage::make_safe() noexcept {
    for (std::size_t i = 0; i < output_points_.size(); ++i) outputs_[i] = output_points_[i].config.safe_value;
}

bool IoImage::fits(std::size_t output, double value) const noexcept {
    const auto& signal = output_points_[output].signal;
    if (!std::isfinite(value) || value != std::floor(value)) return false;
    const double span = std::ldexp(1.0, signal.bits);
    const double low = signal.is_signed ? -span / 2 : 0, beyond = signal.is_signed ? span / 2 : span;
    return value >= low && value < beyond && value < 0x1p63;  // int64 carries it
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
