#include "hmi_bridge/web/message_age.hpp"

#include <algorithm>

namespace taktwerk::hmi::web {

Duration MessageAge::of(double sent_ms, Instant arrived) {
    const double difference_s = to_seconds(arrived.time_since_epoch()) - sent_ms / 1000;
    const bool silent = known_ && arrived - at_ > longest_silence;
    if (silent) sure_from_ = arrived + behind_it;
    least_s_ = known_ && !silent ? std::min(difference_s, least_s_ + drift * to_seconds(arrived - at_)) : difference_s;
    known_ = true;
    at_ = arrived;
    if (arrived < sure_from_) return unknown;
    constexpr double forever_s = 1e6;  // a clock that jumped: old in any case
    return from_seconds(std::min(difference_s - least_s_, forever_s));
}

}  // namespace taktwerk::hmi::web
