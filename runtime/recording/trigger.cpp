#include "runtime/recording/trigger.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace taktwerk::runtime {

namespace {

constexpr std::uint64_t rows_at_once = 512;
constexpr Duration least_patience = std::chrono::milliseconds{100};
constexpr std::uint64_t far = ~std::uint64_t{0} / 4;

bool has_bit(double value, unsigned bit) noexcept {
    // What a double holds exactly; beyond that there are no bits to speak of.
    if (!(value >= 0) || value >= 9007199254740992.0) return false;
    return (static_cast<std::uint64_t>(value) >> bit & 1) != 0;
}

}  // namespace

bool TriggerDetector::happens(double value) noexcept {
    using enum TriggerCondition::Kind;
    if (std::isnan(value)) return false;
    const auto& c = condition_;
    const auto before = before_;
    before_ = value;
    const bool rises = before && *before < c.level && value >= c.level, falls = before && *before > c.level && value <= c.level;
    switch (c.kind) {
        case rising: return rises;
        case falling: return falls;
        case either: return rises || falls;
        case above: return value > c.level;
        case below: return value < c.level;
        case inside: return value >= c.level && value <= c.level2;
        case outside: return value < c.level || value > c.level2;
        case bit: return before && !has_bit(*before, c.bit) && has_bit(value, c.bit);
        case alarm: return false;
    }
    return false;
}

TriggerHunt::TriggerHunt(const SignalRows& rows, Request request)
    : rows_(rows),
      request_(request),
      detector_(request.condition),
      next_(std::max<std::uint64_t>(rows.span().last, 1)),
      quiet_since_(next_),
      not_before_(next_) {
    request_.pre = std::min(request_.pre, far);
    request_.post = std::min(request_.post, far);
    request_.holdoff = std::min(request_.holdoff, far);
    patience_ = std::max<std::uint64_t>(request_.pre + request_.post, static_cast<std::uint64_t>(least_patience / rows.cycle()));
}

void TriggerHunt::happened(std::uint64_t cycle, bool automatic) {
    const auto there = rows_.span();
    const auto from = std::max(there.first, cycle > request_.pre ? cycle - request_.pre : 1);
    events_.push_back({cycle, std::min(from, cycle), cycle + std::max<std::uint64_t>(request_.post, 1), automatic});
    if (events_.size() > most_events) events_.pop_front();
    quiet_since_ = cycle + request_.post;
    // A window that shows nothing keeps no event away: neither in itself nor by a hold-off.
    if (!automatic) not_before_ = cycle + std::max({request_.post, request_.holdoff, std::uint64_t{1}});
    if (request_.mode == Mode::single) armed_ = false;
}

void TriggerHunt::offer(std::uint64_t cycle) {
    if (armed_ && request_.condition.kind == TriggerCondition::Kind::alarm && cycle >= not_before_) happened(cycle, false);
}

void TriggerHunt::step(std::size_t most_rows, std::uint64_t told_to) {
    const std::array<std::uint16_t, 1> word{request_.cell.word};
    const bool looks = request_.condition.kind != TriggerCondition::Kind::alarm;
    for (std::uint64_t left = most_rows; armed_ && left > 0;) {
        auto there = rows_.span();
        if (!looks) there.last = std::min(there.last, told_to);
        if (there.empty() || next_ > there.last) return;
        if (next_ < there.first) {
            skipped_ += there.first - next_;
            next_ = there.first;
        }
        const auto count = std::min({there.last + 1 - next_, rows_at_once, left});
        left -= count;
        auto right = next_;
        if (looks) {
            buffer_.resize(count);
            right = rows_.read(next_, next_ + count, word, buffer_);
            skipped_ += right - next_;
        }
        const auto first = next_;
        for (next_ = right; next_ < first + count && armed_; ++next_) {
            if (looks && detector_.happens(request_.cell.value_of(buffer_[next_ - first])) && next_ >= not_before_) happened(next_, false);
            else if (request_.mode == Mode::automatic && next_ >= quiet_since_ + patience_) happened(next_, true);
        }
    }
}

}  // namespace taktwerk::runtime
