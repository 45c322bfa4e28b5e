#pragma once
// What a driver does with a network interface's interrupts and its link, asked and set by the kernel's ethtool interface (SIOCETHTOOL,
// linux/ethtool.h). Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

struct EthernetSettings {
    std::string driver;                       ///< "igb"
    std::optional<std::uint32_t> receive_us;  ///< an interrupt waits so long for more frames (rx-usecs)
    std::optional<std::uint32_t> send_us;     ///< likewise for what was sent (tx-usecs)
    std::optional<bool> adaptive_receive;     ///< the driver chooses that time itself (adaptive-rx)
    std::optional<bool> energy_efficient;     ///< EEE (IEEE 802.3az) switched on; nothing: the driver has none
    bool energy_efficient_now = false;        ///< ... and agreed upon with the other end
};

/// What of it may be changed.
enum class EthernetKnob : std::uint8_t { receive_us, send_us, adaptive_receive, energy_efficient };
/// As ethtool(8) calls it: "rx-usecs".
[[nodiscard]] const char* name(EthernetKnob knob) noexcept;
[[nodiscard]] std::optional<EthernetKnob> ethernet_knob(const std::string& name) noexcept;

class EthernetPorts {
public:
    virtual ~EthernetPorts() = default;
    /// All network interfaces that a socket of this process can have, sorted; nothing: not known.
    [[nodiscard]] virtual std::optional<std::vector<std::string>> names() const { return std::nullopt; }
    [[nodiscard]] virtual EthernetSettings read(const std::string& interface) const = 0;
    /// Errors: doctor.ethernet.
    [[nodiscard]] virtual Result<void> set(const std::string& interface, EthernetKnob knob, std::uint32_t value) = 0;
};

/// Of this computer.
class KernelEthernetPorts final : public EthernetPorts {
public:
    [[nodiscard]] std::optional<std::vector<std::string>> names() const override;
    [[nodiscard]] EthernetSettings read(const std::string& interface) const override;
    [[nodiscard]] Result<void> set(const std::string& interface, EthernetKnob knob, std::uint32_t value) override;
};

/// The value of a knob; nothing where the driver has none.
[[nodiscard]] std::optional<std::uint32_t> value_of(const EthernetSettings& settings, EthernetKnob knob) noexcept;

}  // namespace taktwerk::apps
