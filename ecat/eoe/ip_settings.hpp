#pragma once
// Telling a slave its address in its Ethernet (EoE Set IP). Service side. Source: ETG.1000.6 (EoE).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "ecat/mailbox/mailbox_client.hpp"
#include "ecat/wire/eoe.hpp"

namespace taktwerk::ecat {

/// Errors: eoe.refused (with its result), eoe.timeout, eoe.mailbox, bus.no_frame, bus.no_slave.
[[nodiscard]] Script<Result<void>> set_ip(DatagramPort& port, MailboxEndpoint& mailbox, EoeAddress address);

/// "192.168.7.2/24". Nothing: it is none.
struct IpAndSubnet {
    std::uint32_t ip = 0, subnet = 0;
    friend bool operator==(const IpAndSubnet&, const IpAndSubnet&) = default;
};
[[nodiscard]] std::optional<IpAndSubnet> parse_ip_and_subnet(std::string_view text) noexcept;
/// "192.168.7.2"
[[nodiscard]] std::string ip_text(std::uint32_t ip);

}  // namespace taktwerk::ecat
