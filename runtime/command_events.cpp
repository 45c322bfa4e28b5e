#include "runtime/command_events.hpp"

#include <algorithm>

namespace taktwerk::runtime {

namespace {

bool same(const CommandEvent& a, const CommandEvent& b) noexcept {
    const auto &p = a.place, &q = b.place;
    if (a.group != b.group || p.line != q.line || p.column != q.column || p.at.room != q.at.room || p.at.place != q.at.place) return false;
    return a.what == b.what && a.axis == b.axis && a.given == b.given && a.by == b.by && a.held == b.held && a.error == b.error &&
           a.axis_error == b.axis_error && a.error_axis == b.error_axis;
}

}  // namespace

void CommandEvents::note(const CommandEvent& event, Instant now) noexcept {
    const auto last = events_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto known = std::find_if(events_.begin(), last, [&](const CommandEvent& e) { return same(e, event); });
    if (known != last && now - known->at < quiet) {
        ++known->times;
        ++revision_;
        return;
    }
    if (now - second_ >= std::chrono::seconds{1}) {
        second_ = now;
        in_second_ = 0;
    }
    if (in_second_ >= most_a_second) {
        ++dropped_;
        ++revision_;
        return;
    }
    ++in_second_;
    // What is news again goes to the end; a full list loses its oldest.
    if (known != last || count_ == capacity) {
        std::copy((known != last ? known : events_.begin()) + 1, last, known != last ? known : events_.begin());
        --count_;
    }
    auto& added = events_[count_++] = event;
    added.number = next_++;
    added.at = now;
    added.times = 1;
    ++revision_;
}

}  // namespace taktwerk::runtime
