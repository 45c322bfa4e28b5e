#include "axes/drives/encoder/encoder_port.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::axes::encoder {

namespace {

/// a - b modulo 2^bits, sign-extended: the shorter way round.
std::int64_t difference(std::int64_t a, std::int64_t b, unsigned bits) noexcept {
    const unsigned unused = 64u - bits;
    const auto wide = static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
    return static_cast<std::int64_t>(wide << unused) >> unused;
}

}  // namespace

EncoderPort::EncoderPort(ecat::Master& bus, std::size_t slave, EncoderChannel channel, bool absolute)
    : bus_(bus), slave_(slave), channel_(std::move(channel)), absolute_(absolute) {
    capabilities_.absolute_encoder = absolute;
    feedback_.power = PowerState::disabled;
}

Result<Signal> EncoderPort::find(const ParameterAddress& address, bool output) const {
    const auto found = output ? bus_.output(slave_, address.index, address.sub) : bus_.input(slave_, address.index, address.sub);
    if (found) return *found;
    return Error{"drive.not_mapped", fmt::format("slave '{}' {}", bus_.slave(slave_).name, channel_.name),
                 fmt::format("object {:04X}h:{:02X} of its encoder is not exchanged", address.index, address.sub),
                 fmt::format("choose a PDO that has it under `pdo.{}` of the slave", output ? "rx" : "tx")};
}

Result<void> EncoderPort::resolve() {
    const auto position = find(channel_.position, false);
    if (!position) return position.error();
    position_ = *position;
    const unsigned counted = channel_.bits == 0 ? position_.bits : std::min<unsigned>(channel_.bits, position_.bits);
    if (counted < position_.bits) {
        position_.bits = static_cast<std::uint8_t>(counted);
        position_.is_signed = false;
    }
    capabilities_.position_bits = position_.bits;
    errors_.clear();
    for (const auto& address : channel_.errors) {
        const auto error = find(address, false);
        if (!error) return error.error();
        errors_.push_back(*error);
    }
    valid_ = {};
    if (channel_.valid.index != 0) {
        const auto valid = find(channel_.valid, false);
        if (!valid) return valid.error();
        valid_ = *valid;
    }
    return find_latch();
}

Result<void> EncoderPort::find_latch() {
    capabilities_.probes = capabilities_.probe_edges = 0;
    ways_ = {};
    if (channel_.latch.index == 0) return {};
    const auto value = find(channel_.latch, false);
    if (!value) return value.error();
    latch_ = *value;
    const std::pair<LatchWay, const EncoderLatch&> ways[] = {
        {LatchWay::index, channel_.index}, {LatchWay::rising, channel_.rising}, {LatchWay::falling, channel_.falling}};
    for (const auto& [which, channel] : ways) {
        if (!channel.there()) continue;
        const auto arm = find(channel.arm, true);
        if (!arm) return arm.error();
        const auto latched = find(channel.latched, false);
        if (!latched) return latched.error();
        way(which) = {*arm, *latched};
    }
    capabilities_.probes = 1;
    capabilities_.probe_edges = static_cast<std::uint8_t>((channel_.rising.there() ? 1u : 0u) | (channel_.falling.there() ? 2u : 0u));
    return {};
}

bool EncoderPort::holds() const noexcept {
    const auto image = bus_.inputs();
    for (const auto& error : errors_)
        if (read_signal(image, error) != 0) return false;
    return !valid_.mapped() || read_signal(image, valid_) != 0;
}

const DriveFeedback& EncoderPort::decode(Instant) noexcept {
    const auto& health = bus_.health(slave_);
    feedback_.age = health.age;
    feedback_.fresh = false;
    feedback_.online = health.al_state == ecat::AlState::op && !health.al_error;
    if (!feedback_.online) {
        probe_.forget();
        sent_ = LatchWay::none;
        was_good_ = invalid_ = false;
        position_at_ = {};
    }
    if (!health.fresh) return feedback_;
    invalid_ = feedback_.online && !holds();
    if (invalid_) {
        was_good_ = false;
        position_at_ = {};
        feedback_.velocity = 0;
        return feedback_;
    }
    feedback_.fresh = true;
    feedback_.latched = health.latched;
    decode_position();
    if (capabilities_.probes > 0) decode_latch();
    return feedback_;
}

void EncoderPort::decode_position() noexcept {
    // Between an error and the value behind it pulses went by; whoever is absolute has not lost its place.
    if (feedback_.online && !was_good_) {
        if (seeded_) {
            ++feedback_.position_epoch;
            if (!absolute_) ++feedback_.reference_epoch;
        }
        was_good_ = true;
    }
    const auto before = feedback_.position;
    const auto raw = read_signal(bus_.inputs(), position_);
    feedback_.position = seeded_ ? anchor_ + difference(raw, anchor_raw_, position_.bits) : raw;
    if (position_at_ != Instant{} && feedback_.latched > position_at_)
        feedback_.velocity = static_cast<double>(feedback_.position - before) / to_seconds(feedback_.latched - position_at_);
    else if (position_at_ == Instant{}) feedback_.velocity = 0;
    // Only what a terminal in OP says moves the anchor.
    if (feedback_.online) {
        anchor_ = feedback_.position;
        anchor_raw_ = raw;
        seeded_ = true;
    }
    position_at_ = feedback_.online ? feedback_.latched : Instant{};
}

void EncoderPort::decode_latch() noexcept {
    const auto image = bus_.inputs();
    const bool known = sent_ != LatchWay::none && feedback_.latched >= armed_from_;
    const bool latched = known && read_signal(image, way(sent_).latched) != 0;
    if (!probe_.take(latched, known, feedback_.probes[0])) return;
    // A raw position, beside the one of now.
    feedback_.probes[0].position = feedback_.position + difference(read_signal(image, latch_), anchor_raw_, position_.bits);
}

void EncoderPort::encode(const DriveCommand& command, Instant now) noexcept {
    if (capabilities_.probes == 0) return;
    const auto image = bus_.outputs();
    bool shows_latch = false;
    for (const auto& one : ways_) shows_latch = shows_latch || (one.latched.mapped() && read_signal(bus_.inputs(), one.latched) != 0);
    const bool gone = sent_ == LatchWay::none && !shows_latch && feedback_.fresh && feedback_.latched >= clear_from_;
    const auto armed = probe_.arm(command.probes[0], gone);
    if (armed != sent_) (armed == LatchWay::none ? clear_from_ : armed_from_) = bus_.outputs_effective(slave_, now);
    sent_ = armed;
    for (std::size_t i = 1; i < ways_.size(); ++i)
        if (ways_[i].arm.mapped()) write_signal(image, ways_[i].arm, static_cast<LatchWay>(i) == armed ? 1 : 0);
}

}  // namespace taktwerk::axes::encoder
