#pragma once
// The handshake of a set-point in profile position mode: control word bits 4 (new set-point), 5 (change set immediately), 6 (relative) against
// status word bit 12. Pure logic. Sources: CiA 402-2; SV33-E 3.4.3(5), SV-DA200 3.2.7, SE-808X 3.2.4. Real-time safe.
//
// The target stands a frame before the edge, and the edge waits until bit 12 of the set-point before has fallen: a drive whose buffer is full
// keeps it up (SV33-E). One that does not answer in time gets its edge back: what it takes later nobody expects any more.

#include <chrono>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::cia402 {

class ProfileHandshake {
public:
    static constexpr Duration patience = std::chrono::milliseconds{500};
    static constexpr std::uint16_t new_setpoint = 1u << 4, immediately = 1u << 5, relative = 1u << 6;
    static constexpr std::uint16_t acknowledge = 1u << 12;

    /// Bits 4 to 6 of this cycle. `status` as read in this mode; `fresh`: it is of this cycle.
    [[nodiscard]] std::uint16_t bits(const ProfileSetpoint& wanted, std::uint16_t status, bool fresh, Instant now) noexcept {
        if (wanted.sequence == 0) return reset();
        const auto kind = static_cast<std::uint16_t>((wanted.immediately ? immediately : 0u) | (wanted.relative ? relative : 0u));
        if (wanted.sequence != sequence_) {
            sequence_ = wanted.sequence;
            phase_ = Phase::announced;
            return kind;
        }
        if (!fresh) return phase_ == Phase::raised ? kind | new_setpoint : kind;
        const bool acknowledged = (status & acknowledge) != 0;
        if (phase_ == Phase::announced && !acknowledged) {
            phase_ = Phase::raised;
            since_ = now;
        } else if (phase_ == Phase::raised && acknowledged) {
            phase_ = Phase::taken;
            accepted_ = sequence_;
        } else if (phase_ == Phase::raised && now - since_ >= patience) {
            phase_ = Phase::refused;
        }
        return phase_ == Phase::raised ? kind | new_setpoint : kind;
    }
    /// Outside profile position mode.
    std::uint16_t reset() noexcept {
        phase_ = Phase::idle;
        sequence_ = 0;
        return 0;
    }
    /// Sequence of the last set-point that the drive took.
    [[nodiscard]] std::uint32_t accepted() const noexcept { return accepted_; }

private:
    enum class Phase : std::uint8_t { idle, announced, raised, taken, refused };
    Phase phase_ = Phase::idle;
    std::uint32_t sequence_ = 0, accepted_ = 0;
    Instant since_{};
};

}  // namespace taktwerk::axes::cia402
