#include "modbus/tcp/simulated_device.hpp"

#include <array>

#include "modbus/tcp/channel_words.hpp"

namespace taktwerk::modbus::tcp {

namespace {

constexpr Fault no_power{Fault::Kind::timeout, 0}, illegal_address{Fault::Kind::exception, 2};

}  // namespace

SimulatedDevice::SimulatedDevice(const DeviceConfig& device) : channels_(device.channels), words_(device.channels.size()) {}

Fault SimulatedDevice::connect() {
    if (!powered_.load(std::memory_order_relaxed)) return no_power;
    connected_ = true;
    return {};
}

Fault SimulatedDevice::read(Table table, std::uint16_t address, std::span<std::uint16_t> values) {
    if (!powered_.load(std::memory_order_relaxed)) return no_power;
    bool first = false, last = false;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        const auto& channel = channels_[i];
        if (channel.table != table) continue;
        std::array<std::uint16_t, 2> own{};
        put_word(channel, get(i), own);
        for (unsigned k = 0; k < addresses_of(channel.type); ++k) {
            const unsigned at = channel.address + k;
            if (at < address || at >= address + values.size()) continue;
            // Bits of one register are channels of their own.
            auto& value = values[at - address];
            value = channel.type == NumberType::boolean ? static_cast<std::uint16_t>(value | own[k]) : own[k];
            first = first || at == address;
            last = last || at + 1 == address + values.size();
        }
    }
    return first && last ? Fault{} : illegal_address;
}

Fault SimulatedDevice::write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) {
    if (!powered_.load(std::memory_order_relaxed)) return no_power;
    bool any = false;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        const auto& channel = channels_[i];
        const std::size_t width = addresses_of(channel.type);
        if (channel.table != table || channel.address < address || channel.address + width > address + values.size()) continue;
        set(i, word_of(channel, values.subspan(static_cast<std::size_t>(channel.address - address), width)));
        any = true;
    }
    return any ? Fault{} : illegal_address;
}

}  // namespace taktwerk::modbus::tcp
