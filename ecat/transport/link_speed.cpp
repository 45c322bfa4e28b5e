#include "ecat/transport/link_speed.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "ecat/transport/network_interface.hpp"

namespace taktwerk::ecat {

std::optional<Error> link_speed_trouble(std::string_view interface, const std::filesystem::path& sysfs) {
    constexpr int of_ethercat = 100;
    const std::filesystem::path here = sysfs / interface;
    std::error_code ignored;
    if (!std::filesystem::exists(here / "device", ignored)) return std::nullopt;
    int speed = 0;  // Mbit/s; not to be read, or negative: no link
    std::string duplex;
    std::ifstream{here / "speed"} >> speed;
    std::ifstream{here / "duplex"} >> duplex;
    if (speed > 0 && speed != of_ethercat)
        return interface_error(
            "transport.link_speed", interface,
            fmt::format("its link has {} Mbit, and an EtherCAT slave has {}: at its other end stands a switch, a computer or "
                        "another device",
                        speed, of_ethercat),
            "plug the cable straight into the IN port of the first slave");
    if (speed > 0 && duplex == "half")
        return interface_error("transport.link_speed", interface,
                               "its link is half duplex, and EtherCAT needs full duplex: frames are lost",
                               fmt::format("let both ends negotiate: ethtool -s {} autoneg on; a hub in between does not", interface));
    return std::nullopt;
}

}  // namespace taktwerk::ecat
