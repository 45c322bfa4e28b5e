#pragma once
// What a drive makes of cycles without process data: a cyclic target goes on by its last increment for so many cycles, then it
// stands; after a time without data there is an alarm. Pure logic. Source: SV-DA200 2.1 note 7 (P4.27), 5.2 (Er24-c).

#include <cstdint>

namespace taktwerk::axes::sim {

class LostData {
public:
    /// One cycle: the target to follow. `fresh`: `raw` came since the last cycle. `cycles`: how many may be made up for; 0: none.
    [[nodiscard]] std::int64_t target(std::int64_t raw, bool fresh, std::int64_t cycles) noexcept {
        if (fresh) {
            // What came after a gap covers all of its cycles.
            increment_ = known_ ? (raw - raw_) / (lost_ + 1) : 0;
            raw_ = target_ = raw;
            lost_ = 0;
            known_ = true;
        } else {
            ++lost_;
            if (lost_ <= cycles) target_ += increment_;
        }
        return target_;
    }
    /// The drive follows no target: the next one is the first.
    void restart(std::int64_t at) noexcept {
        raw_ = target_ = at;
        increment_ = lost_ = 0;
        known_ = false;
    }

private:
    std::int64_t raw_ = 0, target_ = 0, increment_ = 0, lost_ = 0;
    bool known_ = false;
};

}  // namespace taktwerk::axes::sim
