#include "ecat/ring/bus_interfaces.hpp"

namespace taktwerk::ecat {

Result<std::unique_ptr<BusInterfaces>> BusInterfaces::open(const std::string& first, const std::string& second, Duration patience,
                                                           const RawSocketOptions& options) {
    std::unique_ptr<BusInterfaces> interfaces{new BusInterfaces};
    auto opened = RawSocketTransport::open(first, options);
    if (!opened) return opened.error();
    interfaces->first_ = std::move(*opened);
    if (second.empty()) return interfaces;
    auto other = RawSocketTransport::open(second, options);
    if (!other) return other.error();
    interfaces->second_ = std::move(*other);
    interfaces->ring_ = std::make_unique<RingTransport>(*interfaces->first_, *interfaces->second_, patience);
    return interfaces;
}

void BusInterfaces::refresh() noexcept {
    first_->refresh();
    if (second_) second_->refresh();
}

std::vector<std::string> BusInterfaces::refused() const {
    std::vector<std::string> all;
    for (const auto* nic : {first_.get(), second_.get()}) {
        if (nic == nullptr) continue;
        for (const auto& refused : nic->report().refused) all.push_back(nic->interface() + ": " + refused);
    }
    return all;
}

}  // namespace taktwerk::ecat
