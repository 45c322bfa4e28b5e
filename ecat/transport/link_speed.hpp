#pragma once
// What stands at the other end of the master's own cable: an EtherCAT slave has 100 Mbit full duplex, so any other link leads to somebody else
// (a switch, a PC), or has been set by hand. Asks the kernel's files; not real-time.

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::ecat {

/// Nothing where the link is as it should be, where there is none, and of interfaces that are no hardware. Error transport.link_speed.
[[nodiscard]] std::optional<Error> link_speed_trouble(std::string_view interface, const std::filesystem::path& sysfs = "/sys/class/net");

}  // namespace taktwerk::ecat
