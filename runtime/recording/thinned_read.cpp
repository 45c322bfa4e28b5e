#include "runtime/recording/thinned_read.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace taktwerk::runtime {

namespace {

constexpr std::uint64_t most_rows = 512;  // read at once
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

ThinnedRead::ThinnedRead(const SignalRows& rows, std::vector<const RecordedSignal*> signals, Window window)
    : rows_(rows),
      signals_(std::move(signals)),
      per_(std::max<std::uint64_t>(window.per, 1)),
      pairs_(signals_.size()),
      values_(signals_.size()) {
    const auto there = rows.span();
    const auto wanted = window.to > window.from ? window.to - window.from : 0;
    from_ = std::clamp(window.from, there.first, there.last + 1);
    to_ = std::clamp(window.to, from_, there.last + 1);
    // Nothing of it is there yet: it begins where it was asked for, and who reads on misses nothing.
    if (window.from > there.last) from_ = to_ = window.from;
    at_ = from_;
    missing_ = wanted - (to_ - from_);
    for (const auto* signal : signals_) words_.push_back(signal->cell.word);
    if (const auto* time = rows.find(time_signal)) words_.push_back(time->cell.word);
}

void ThinnedRead::add(std::size_t signal, double value) {
    if (per_ == 1) {
        values_[signal].push_back(value);
        return;
    }
    auto& pair = pairs_[signal];
    if (std::isnan(value)) return;
    pair.low = pair.any ? std::min(pair.low, value) : value;
    pair.high = pair.any ? std::max(pair.high, value) : value;
    pair.any = true;
}

void ThinnedRead::close_pairs() {
    for (std::size_t s = 0; s < signals_.size(); ++s) {
        values_[s].push_back(pairs_[s].any ? pairs_[s].low : nothing);
        values_[s].push_back(pairs_[s].any ? pairs_[s].high : nothing);
        pairs_[s] = {};
    }
    in_pair_ = 0;
}

bool ThinnedRead::step(std::size_t& cells) {
    const auto width = std::max<std::size_t>(words_.size(), 1);
    while (at_ < to_ && cells > 0) {
        const auto count = std::min({to_ - at_, most_rows, std::max<std::uint64_t>(cells / width, 1)});
        cells -= std::min<std::size_t>(cells, count * width);
        buffer_.resize(count * width);
        const auto right = rows_.read(at_, at_ + count, words_, buffer_);
        missing_ += right - at_;
        const bool begins = at_ == from_;
        if (begins) from_ = right;
        if (begins && words_.size() > signals_.size() && right < at_ + count)
            time_ = Instant{Duration{static_cast<std::int64_t>(buffer_[signals_.size() * count + (right - at_)])}};
        for (auto cycle = begins ? right : at_; cycle < at_ + count; ++cycle) {
            for (std::size_t s = 0; s < signals_.size(); ++s)
                add(s, cycle < right ? nothing : signals_[s]->cell.value_of(buffer_[s * count + (cycle - at_)]));
            if (per_ > 1 && ++in_pair_ == per_) close_pairs();
        }
        at_ += count;
    }
    if (at_ < to_) return false;
    if (in_pair_ > 0) close_pairs();
    return true;
}

}  // namespace taktwerk::runtime
