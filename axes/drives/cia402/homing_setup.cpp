#include "axes/drives/cia402/homing_setup.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace taktwerk::axes::cia402 {

namespace {

/// As homing_startup() does: a speed or acceleration of zero would never end.
std::int64_t raw(double value) noexcept { return static_cast<std::int64_t>(std::clamp(std::round(std::abs(value)), 1.0, 4294967295.0)); }

}  // namespace

bool HomingSetup::ready(const DriveHomingSetup& wanted) noexcept {
    if (wanted.method == 0) return true;
    const Values values{wanted.method, raw(wanted.search_velocity), raw(wanted.latch_velocity), raw(wanted.acceleration)};
    if (values == have_) return true;
    if (request_ == 0 || values != asked_) {
        refused_ = false;
        asked_ = values;
        if (++request_ == 0) request_ = 1;
        for (std::size_t i = 0; i < count; ++i) wanted_[i].store(values[i], std::memory_order_relaxed);
        wanted_request_.store(request_, std::memory_order_release);
        return false;
    }
    const auto answer = answer_.load(std::memory_order_acquire);
    if (answer >> 1 != request_) return false;
    refused_ = (answer & 1u) == 0;
    if (!refused_) have_ = values;
    return !refused_;
}

void HomingSetup::finish(bool well) noexcept {
    place_ = count;
    reading_back_ = false;
    answer_.store(static_cast<std::uint64_t>(served_) << 1 | (well ? 1u : 0u), std::memory_order_release);
}

void HomingSetup::step(ecat::Master& bus, std::size_t slave) {
    if (place_ == count) {
        const auto request = wanted_request_.load(std::memory_order_acquire);
        if (request == served_) return;
        served_ = request;
        for (std::size_t i = 0; i < count; ++i) writing_[i] = wanted_[i].load(std::memory_order_relaxed);
        place_ = 0;
    }
    const auto& object = objects_[place_];
    const auto value = static_cast<std::uint64_t>(writing_[place_]);
    if (ticket_ == 0) {
        std::vector<std::byte> bytes;
        for (std::size_t i = 0; i < object.bytes; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFFu));
        ticket_ = reading_back_ ? bus.upload(slave, object.index, object.sub) : bus.download(slave, object.index, object.sub, bytes);
        return;
    }
    const auto answer = bus.poll(ticket_);
    if (!answer) return;
    ticket_ = 0;
    if (!answer->ok()) return finish(false);
    if (reading_back_) {
        const auto& data = answer->value().data;
        for (std::size_t i = 0; i < std::min<std::size_t>(object.bytes, data.size()); ++i)
            if (data[i] != static_cast<std::byte>(value >> (8 * i) & 0xFFu)) return finish(false);
    }
    reading_back_ = !reading_back_ && object.readable;
    if (reading_back_) return;
    if (++place_ == count) finish(true);
}

}  // namespace taktwerk::axes::cia402
