#include "axes/drives/cia402/torque_limit_writer.hpp"

#include <algorithm>
#include <span>

namespace taktwerk::axes::cia402 {

TorqueLimitWriter::Answer TorqueLimitWriter::ask(const Values& wanted, bool online) noexcept {
    if (!online) {
        away_ = request_ != 0;
        return Answer::pending;
    }
    if (wanted != asked_ || away_) {
        away_ = false;
        asked_ = wanted;
        publish();
        return Answer::pending;
    }
    if (request_ == 0) return Answer::taken;
    const auto answer = answer_.load(std::memory_order_acquire);
    if (answer >> 1 != request_) return Answer::pending;
    return (answer & 1u) != 0 ? Answer::taken : Answer::refused;
}

void TorqueLimitWriter::publish() noexcept {
    if (++request_ == 0) request_ = 1;
    for (std::size_t i = 0; i < most; ++i) wanted_[i].store(asked_[i], std::memory_order_relaxed);
    wanted_request_.store(request_, std::memory_order_release);
}

void TorqueLimitWriter::finish(bool well) noexcept {
    place_ = most;
    answer_.store(static_cast<std::uint64_t>(served_) << 1 | (well ? 1u : 0u), std::memory_order_release);
}

/// What was asked of the drive has come back, or nothing was asked.
bool TorqueLimitWriter::answered(ecat::Master& bus) {
    if (ticket_ == 0) return true;
    const auto answer = bus.poll(ticket_);
    if (!answer) return false;
    ticket_ = 0;
    auto& object = objects_[place_];
    if (reading_) {
        object.at_start = object.high;  // one that cannot be read is given back the most it takes
        if (answer->ok()) {
            const auto& data = answer->value().data;
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < std::min(object.bytes, data.size()); ++i)
                value |= std::to_integer<std::uint64_t>(data[i]) << (8 * i);
            object.at_start = static_cast<std::int64_t>(value);
        }
        reading_ = false;
    } else if (!answer->ok()) {
        finish(false);
    } else if (++place_ == most || objects_[place_].index == 0) {
        finish(true);
    }
    return true;
}

void TorqueLimitWriter::step(ecat::Master& bus, std::size_t slave) {
    if (!answered(bus)) return;
    const auto request = wanted_request_.load(std::memory_order_acquire);
    if (request != served_) {
        served_ = request;
        for (std::size_t i = 0; i < most; ++i) writing_[i] = wanted_[i].load(std::memory_order_relaxed);
        place_ = 0;
    }
    if (place_ == most) return;
    const auto& object = objects_[place_];
    reading_ = object.at_start == not_stated;
    if (reading_) {
        ticket_ = bus.upload(slave, object.index, 0);
        return;
    }
    // Of 0 a drive would have no torque at all.
    const auto value = static_cast<std::uint64_t>(
        writing_[place_] == no_limit ? object.at_start : std::clamp<std::int64_t>(writing_[place_], 1, object.high));
    std::array<std::byte, 4> data{};
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::byte>(value >> (8 * i) & 0xFFu);
    ticket_ = bus.download(slave, object.index, 0, std::span{data}.first(std::min(object.bytes, data.size())));
}

}  // namespace taktwerk::axes::cia402
