#pragma once
// How old a page's message is when it arrives, by the page's own clock. The two clocks share no zero: the quickest message so far shows their
// difference, and what takes longer than it has waited somewhere (a network that stalled, a server that stood still). One connection. Not thread-safe.

#include "core/time.hpp"

namespace taktwerk::hmi::web {

class MessageAge {
public:
    /// What may begin something is refused when it is older; a jog earlier, since it is renewed each 50 ms.
    static constexpr Duration longest = std::chrono::milliseconds{250};
    static constexpr Duration longest_of_jog = std::chrono::milliseconds{150};
    /// What two quartzes may differ by: without it, a page whose clock is slow would grow old within a day. 200 ppm.
    static constexpr double drift = 200e-6;

    /// After so long without a message nobody knows what the clocks have done meanwhile, or whether one waits: what comes then is old by `unknown`,
    /// and so is what comes right behind it, for what a stall has held back comes at once. A page says its time each few seconds.
    static constexpr Duration longest_silence = std::chrono::minutes{2};
    static constexpr Duration unknown = std::chrono::seconds{10}, behind_it = std::chrono::milliseconds{300};

    /// `sent_ms`: performance.now() of the page, ms, finite. Never negative.
    Duration of(double sent_ms, Instant arrived);

private:
    bool known_ = false;
    double least_s_ = 0;  ///< arrival minus sending, s
    Instant at_{}, sure_from_{};
};

}  // namespace taktwerk::hmi::web
