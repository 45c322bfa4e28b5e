#pragma once
// The clock of one slave controller: a local quartz that starts anywhere and drifts, the offset and delay the master writes,
// and the control loop that pulls it towards the reference clock. Integer nanoseconds; deterministic; real-time safe.
// Source: ETG.1000.4 (0910h..0935h), reference/ethercat-masters.md section 5.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::ecat::sim {

class DcClock {
public:
    /// The quartz starts with `local` on it and runs fast by `drift_ppb` (parts per billion, negative: slow).
    void power_on(Instant now, std::int64_t local, std::int32_t drift_ppb) noexcept;

    [[nodiscard]] std::int64_t local(Instant at) const noexcept;
    /// Wraps like the register: a master may write any offset.
    [[nodiscard]] std::int64_t system(Instant at) const noexcept {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(local(at)) + static_cast<std::uint64_t>(offset_));
    }
    /// First machine instant at which the system time is at least `system`; may lie before the last correction. Instant::max()
    /// when that is decades away.
    [[nodiscard]] Instant when_system(std::int64_t system) const noexcept;

    /// The quartz runs at another speed from now on (warmth, a bad part). The local time does not jump.
    void set_drift(std::int32_t drift_ppb, Instant at) noexcept;
    /// The local time jumps.
    void step(Duration by) noexcept { base_local_ += by.count(); }
    void set_offset(std::int64_t offset) noexcept { offset_ = offset; }
    void set_delay(std::uint32_t delay) noexcept { delay_ = delay; }
    /// A system time of the reference clock arrived (a write to 0910h).
    void correct(std::int64_t reference, Instant at) noexcept;
    /// Same, from a write of only the low four bytes.
    void correct_low32(std::uint32_t reference, Instant at) noexcept;
    /// Forgets the learned speed and the mean difference (a write to 0930h).
    void reset_control(Instant at) noexcept;
    /// 092Ch: mean of own system time - (received + delay), sign and magnitude.
    [[nodiscard]] std::uint32_t difference_register() const noexcept;
    [[nodiscard]] std::int64_t mean_difference() const noexcept { return mean_difference_; }

private:
    [[nodiscard]] static std::int64_t scaled(std::int64_t ns, std::int64_t ppb) noexcept;

    Instant base_{};               // machine instant of the last correction
    std::int64_t base_local_ = 0;  // local time at base_
    std::int64_t drift_ppb_ = 0;   // of the quartz
    std::int64_t trim_ppb_ = 0;    // learned by the control loop
    std::int64_t offset_ = 0;
    std::uint32_t delay_ = 0;
    std::int64_t mean_difference_ = 0;
    Instant last_correction_{};
    bool corrected_ = false;
};

}  // namespace taktwerk::ecat::sim
