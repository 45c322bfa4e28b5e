#pragma once
// A plain digital I/O terminal: bits in, bits out, SII only, no mailbox. Outputs fall to 0 when the SM watchdog expires and
// whenever the terminal is not in OP. Real-time safe except construction.

#include <array>
#include <cstdint>

#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"

namespace taktwerk::ecat::sim {

inline constexpr unsigned max_terminal_bits = 128;

/// A terminal with this many inputs (objects 6000h:01.. in 1A00h) and outputs (7000h:01.. in 1600h), at most
/// max_terminal_bits each. Sync managers in order: outputs (1000h, watchdog), inputs (1100h); only those it has.
[[nodiscard]] DeviceDescription digital_input_output_terminal(std::uint8_t inputs, std::uint8_t outputs);

class DigitalTerminal final : public DeviceModel {
public:
    /// Input `bit` (0-based) as the field wiring sees it from now on; sampled when a frame arrives.
    void set_input(unsigned bit, bool on) noexcept;
    [[nodiscard]] bool input(unsigned bit) const noexcept;
    /// What the terminal drives.
    [[nodiscard]] bool output(unsigned bit) const noexcept;

    void power_on(ObjectDictionary&, Instant) override { clear_outputs(); }
    void power_off(Instant) override { clear_outputs(); }
    void entered(EsmState state, Instant) override {
        if (state != EsmState::op) clear_outputs();
    }
    void exchange(Instant) override {}
    void outputs_lost(Instant) override { clear_outputs(); }
    void raw_outputs(std::span<const std::byte> outputs) override;
    void raw_inputs(std::span<std::byte> inputs) override;

private:
    void clear_outputs() noexcept { outputs_ = {}; }
    std::array<std::byte, max_terminal_bits / 8> inputs_{}, outputs_{};
};

}  // namespace taktwerk::ecat::sim
