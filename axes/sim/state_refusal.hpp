#pragma once
// Why a simulated drive refuses a state of the bus: a hand has it refuse, or SYNC0 is shorter than it can.

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "ecat/sim/device_model.hpp"

namespace taktwerk::axes::sim {

class StateRefusal {
public:
    /// The shortest cycle of any mode: the drive does not know yet which one will be asked for.
    explicit StateRefusal(const DriveProfile& profile) noexcept {
        for (const auto cycle : {profile.minimum_cycle_csp, profile.minimum_cycle_csv, profile.minimum_cycle_cst})
            if (cycle > Duration::zero() && (minimum_cycle_ == Duration::zero() || cycle < minimum_cycle_)) minimum_cycle_ = cycle;
    }
    /// Code 0: no more.
    void order(ecat::sim::EsmState state, std::uint16_t al_status_code) noexcept {
        state_ = state;
        code_ = al_status_code;
    }
    /// AL status code; 0: it goes there.
    [[nodiscard]] std::uint16_t code(ecat::sim::EsmState from, ecat::sim::EsmState to,
                                     const ecat::sim::SyncSettings& settings) const noexcept {
        if (code_ != 0 && to == state_) return code_;
        // 0036h: invalid SYNC0 cycle time (ETG.1000.6 table of AL status codes).
        const bool checks = to == ecat::sim::EsmState::safeop && from == ecat::sim::EsmState::preop && settings.sync0_active;
        return checks && settings.sync0_cycle < minimum_cycle_ ? 0x0036 : 0;
    }

private:
    Duration minimum_cycle_{};
    ecat::sim::EsmState state_ = ecat::sim::EsmState::op;
    std::uint16_t code_ = 0;
};

}  // namespace taktwerk::axes::sim
