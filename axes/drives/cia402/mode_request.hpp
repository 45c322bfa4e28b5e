#pragma once
// Which mode of operation goes to the drive: a change waits until the last one is long enough ago, and for a while after it 6061h and what
// belongs to the mode may be anything (TSVM 5.4.1). Pure logic, real-time safe.

#include <optional>

#include "axes/port/drive_profile.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::cia402 {

class ModeRequest {
public:
    /// The mode of this cycle. `effective()`: when the drive will have these outputs.
    template <class Effective>
    DriveMode send(DriveMode wanted, const DriveModeRules& rules, Instant now, Effective effective) noexcept {
        if (wanted == sent_) return sent_;
        if (sent_at_ && now - *sent_at_ < rules.change_interval) return sent_;
        sent_ = wanted;
        sent_at_ = now;
        if (rules.indeterminate > Duration::zero()) valid_from_ = effective() + rules.indeterminate;
        return sent_;
    }
    /// What was latched then says something of the mode.
    [[nodiscard]] bool valid(Instant latched) const noexcept { return latched >= valid_from_; }

private:
    DriveMode sent_ = DriveMode::none;
    std::optional<Instant> sent_at_;
    Instant valid_from_{};
};

}  // namespace taktwerk::axes::cia402
