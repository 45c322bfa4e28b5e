#pragma once
// A Modbus device that answers from memory: what a simulated machine has in place of the real one.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "modbus/tcp/exchange.hpp"

namespace taktwerk::modbus::tcp {

/// It has the registers of its channels and no others: who asks for another address gets exception 2. What lies in the gaps that reads
/// span is 0.
class SimulatedDevice final : public Exchange {
public:
    explicit SimulatedDevice(const DeviceConfig& device);

    // --- the poller's thread ----------------------------------------------------------------------------------------------------
    [[nodiscard]] bool connected() const override { return connected_; }
    [[nodiscard]] Fault connect() override;
    void close() override { connected_ = false; }
    [[nodiscard]] Fault read(Table table, std::uint16_t address, std::span<std::uint16_t> values) override;
    [[nodiscard]] Fault write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) override;

    // --- any thread -------------------------------------------------------------------------------------------------------------
    /// The raw word of a channel.
    void set(std::size_t channel, std::int64_t word) noexcept { words_[channel].store(word, std::memory_order_relaxed); }
    [[nodiscard]] std::int64_t get(std::size_t channel) const noexcept { return words_[channel].load(std::memory_order_relaxed); }
    /// From here on nothing answers (timeout), or it does again.
    void set_power(bool on) noexcept { powered_.store(on, std::memory_order_relaxed); }

private:
    std::vector<Channel> channels_;
    std::vector<std::atomic<std::int64_t>> words_;
    std::atomic<bool> powered_{true};
    bool connected_ = false;
};

}  // namespace taktwerk::modbus::tcp
