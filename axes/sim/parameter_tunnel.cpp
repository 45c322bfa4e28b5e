#include "axes/sim/parameter_tunnel.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr std::uint8_t address_sub = 1, value_sub = 2, result_sub = 3;
constexpr std::int64_t read_valid = 0, write_done = 4, refused = 1;

ecat::sim::Entry* at(ecat::sim::ObjectDictionary& dictionary, std::int64_t address) noexcept {
    return dictionary.find(static_cast<std::uint16_t>(address >> 8), static_cast<std::uint8_t>(address));
}

}  // namespace

void ParameterTunnel::written(std::uint16_t index, std::uint8_t sub) noexcept {
    if (index_ == 0 || index != index_ || dictionary_ == nullptr) return;
    auto* const address = dictionary_->find(index_, address_sub);
    auto* const value = dictionary_->find(index_, value_sub);
    auto* const result = dictionary_->find(index_, result_sub);
    if (!address || !value || !result) return;
    if (sub == address_sub) {
        std::int64_t found = 0;
        result->set(read(address->get(), found));
        value->set(found);
    } else if (sub == value_sub) {
        result->set(write(address->get(), value->get()));
    }
}

std::int64_t ParameterTunnel::read(std::int64_t address, std::int64_t& value) const noexcept {
    const auto* const entry = at(*dictionary_, address);
    if (!entry) return refused;
    value = entry->get();
    return read_valid;
}

std::int64_t ParameterTunnel::write(std::int64_t address, std::int64_t value) noexcept {
    auto* const entry = at(*dictionary_, address);
    if (!entry || entry->access() == ecat::Access::ro) return refused;
    // The array carries 32 unsigned bits: a signed object takes them as its own.
    if (entry->is_signed()) value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
    if ((entry->minimum() && value < *entry->minimum()) || (entry->maximum() && value > *entry->maximum())) return refused;
    entry->set(value);
    return write_done;
}

}  // namespace taktwerk::axes::sim
