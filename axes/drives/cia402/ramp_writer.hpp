#pragma once
// Speed and ramps of a drive's own profile that are not mapped: written by SDO before the set-point that needs them. The cycle asks, the service
// side writes: two threads, atomics only, nothing waits. What the drive has already is not written again (EEPROM).

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ecat/description/device_description.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class RampWriter {
public:
    enum Ramp : std::uint8_t { velocity, acceleration, deceleration, torque_slope };  ///< 6081h, 6083h, 6084h, 6087h
    static constexpr std::size_t ramps = 4;

    /// Before the cycle: an unmapped object of the drive. One that is not named here is never written.
    void use(Ramp ramp, std::uint16_t index, std::size_t bytes) noexcept { objects_[ramp] = {index, bytes, std::nullopt}; }

    // --- in the cycle; real-time safe ---------------------------------------------------------------------------------
    /// What set-point `sequence` (not 0) needs, raw; 0: as it is. Once per sequence.
    void ask(std::uint32_t sequence, const std::array<std::uint32_t, ramps>& values) noexcept {
        if (sequence == asked_) return;
        asked_ = sequence;
        for (std::size_t i = 0; i < ramps; ++i) values_[i].store(values[i], std::memory_order_relaxed);
        request_.store(sequence, std::memory_order_release);
    }
    /// All of it is in the drive. Never true for one that the drive refused.
    [[nodiscard]] bool written(std::uint32_t sequence) const noexcept { return done_.load(std::memory_order_acquire) == sequence; }

    /// The drive was away: it may have lost what was written.
    void forget() noexcept { forget_.store(true, std::memory_order_release); }

    // --- service side ---------------------------------------------------------------------------------------------------
    void step(ecat::Master& bus, std::size_t slave);

private:
    struct Object {
        std::uint16_t index = 0;  // 0: mapped, or not there
        std::size_t bytes = 4;
        std::optional<std::uint32_t> known;  // as written last
    };
    std::array<Object, ramps> objects_{};
    std::array<std::atomic<std::uint32_t>, ramps> values_{};
    std::atomic<std::uint32_t> request_{0}, done_{0};
    std::atomic<bool> forget_{false};
    std::uint32_t asked_ = 0;

    std::uint32_t working_ = 0;  // the request under way
    std::size_t next_ = 0;
    std::uint32_t value_ = 0;
    ecat::SdoTicket ticket_ = 0;
};

}  // namespace taktwerk::axes::cia402
