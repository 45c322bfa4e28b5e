#include "modbus/line/virtual_line.hpp"

#include <algorithm>

namespace taktwerk::modbus {

namespace {

bool take_one(std::uint32_t& count) noexcept {
    if (count == 0) return false;
    --count;
    return true;
}

}  // namespace

bool VirtualLine::send(std::span<const std::byte> frame, Instant now) {
    advance(now);
    ++frames_;
    if (cut_) return true;
    request_ = {};
    request_.size = std::min(frame.size(), longest_frame);
    std::copy_n(frame.begin(), request_.size, request_.bytes.begin());
    request_pending_ = true;
    request_heard_at_ = now + settings_.duration(request_.size) + settings_.frame_gap();
    answer_ = {};
    answer_read_ = 0;
    return true;
}

void VirtualLine::advance(Instant now) {
    if (request_pending_ && request_heard_at_ <= now) {
        for (auto* station : stations_) station->advance(request_heard_at_);
        hear_request(request_heard_at_);
    }
    for (auto* station : stations_) station->advance(now);
}

void VirtualLine::hear_request(Instant at) {
    request_pending_ = false;
    if (cut_) return;
    for (auto* station : stations_) {
        if (station->line() != settings_) continue;
        Frame answer;
        if (!station->hear(request_.span(), at, answer) || answer.size == 0) continue;
        if (take_one(lost_answers_)) continue;
        if (take_one(damaged_answers_)) answer.bytes[answer.size / 2] ^= std::byte{0x10};
        if (take_one(short_answers_)) --answer.size;
        answer_ = answer;
        answer_read_ = 0;
        answer_begins_ = at + station->turnaround();
    }
}

std::size_t VirtualLine::receive(std::span<std::byte> into, Instant now) {
    advance(now);
    if (cut_) answer_ = {};
    std::size_t count = 0;
    while (count < into.size() && answer_read_ < answer_.size && answer_begins_ + settings_.duration(answer_read_ + 1) <= now)
        into[count++] = answer_.bytes[answer_read_++];
    return count;
}

void VirtualLine::discard(Instant now) {
    advance(now);
    while (answer_read_ < answer_.size && answer_begins_ + settings_.duration(answer_read_ + 1) <= now) ++answer_read_;
}

}  // namespace taktwerk::modbus
