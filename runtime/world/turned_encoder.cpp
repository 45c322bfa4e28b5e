#include "runtime/world/turned_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::runtime {

namespace {

/// The first of the places `at`, `at` + `every`, ... that is passed on the way; every = 0: there is only the one.
std::optional<double> passed(double from, double to, double at, double every) noexcept {
    if (from == to) return std::nullopt;
    double place = at;
    if (every > 0) {
        const double steps = (from - at) / every;
        place = at + every * (to > from ? std::floor(steps) + 1 : std::ceil(steps) - 1);
    }
    const bool on_the_way = to > from ? place > from && place <= to : place < from && place >= to;
    return on_the_way ? std::optional{place} : std::nullopt;
}

}  // namespace

TurnedEncoder::TurnedEncoder(const AxisBinding& binding, Device device, unsigned bits)
    : axis_(binding.axis.name),
      channel_(*binding.encoder),
      simulation_(binding.simulation),
      device_(std::move(device)),
      counts_per_unit_(binding.axis.gearing.counts_per_unit()),
      turn_(static_cast<double>(binding.axis.gearing.counts_per_revolution)),
      absolute_(binding.axis.memory.absolute),
      bits_(channel_.bits == 0 ? bits : std::min<unsigned>(channel_.bits, bits)) {
    set(channel_.valid, 1);
    if (!absolute_) zero_ = simulation_.start * counts_per_unit_;  // a counter begins with 0
}

void TurnedEncoder::set(const axes::ParameterAddress& object, std::int64_t value) const {
    if (object.index != 0) device_.set(object, value);
}

std::int64_t TurnedEncoder::raw(double counts) const noexcept {
    const auto whole = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(counts - zero_)));
    return static_cast<std::int64_t>(bits_ >= 64 ? whole : whole & ((std::uint64_t{1} << bits_) - 1));
}

void TurnedEncoder::turn(double u, bool powered) noexcept {
    const double counts = u * counts_per_unit_;
    if (!powered && !absolute_) zero_ = counts;
    else if (fails_ && !absolute_ && before_) zero_ += counts - *before_;
    set(channel_.position, raw(counts));
    if (before_) latch(*before_, counts);
    before_ = counts;
}

void TurnedEncoder::latch(double from, double to) noexcept {
    const auto watch = [&](const axes::EncoderLatch& way, const std::optional<double>& event) {
        if (!way.there()) return;
        if (device_.get(way.arm) == 0) return set(way.latched, 0);
        if (!event || device_.get(way.latched) != 0) return;
        set(channel_.latch, raw(*event));
        set(way.latched, 1);
    };
    watch(channel_.index, passed(from, to, simulation_.index_pulse * counts_per_unit_, turn_));
    const auto& marks = simulation_.marks;
    std::optional<double> on, off;
    if (marks.every > 0) {
        const double begin = marks.first * counts_per_unit_, end = (marks.first + marks.length) * counts_per_unit_;
        const double every = std::abs(marks.every * counts_per_unit_);
        const bool forward = (to > from) == (counts_per_unit_ > 0);
        on = passed(from, to, forward ? begin : end, every);
        off = passed(from, to, forward ? end : begin, every);
    }
    // Two ways may share one bit and one latch: the bit falls when none of them is armed.
    if (channel_.rising.there() && channel_.falling.there() && channel_.rising.latched == channel_.falling.latched) {
        const bool falling = device_.get(channel_.falling.arm) != 0;
        return watch(falling ? channel_.falling : channel_.rising, falling ? off : on);
    }
    watch(channel_.rising, on);
    watch(channel_.falling, off);
}

void TurnedEncoder::fail(bool holds_not) noexcept {
    fails_ = holds_not;
    for (const auto& error : channel_.errors) set(error, holds_not ? 1 : 0);
    set(channel_.valid, holds_not ? 0 : 1);
}

}  // namespace taktwerk::runtime
