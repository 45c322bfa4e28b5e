#include "hmi_bridge/hmi_config.hpp"

#include <fmt/format.h>

#include "hmi_bridge/lcm/lcm_url.hpp"

namespace taktwerk::hmi {

std::vector<Error> check(const HmiConfig& config) {
    std::vector<Error> errors;
    if (!(config.rate_hz >= 1 && config.rate_hz <= 1000))
        errors.push_back({"hmi.rate", "lcm.rate", fmt::format("a rate of {:g} Hz is outside 1 to 1000 Hz", config.rate_hz),
                          "50 Hz is plenty for people."});
    if (config.lcm) {
        const auto url = parse_lcm_url(config.lcm_url);
        if (!url) errors.push_back(url.error());
        else if (url->leaves_host() && config.lcm_commands != LcmCommands::disabled)
            errors.push_back(
                {"hmi.commands_leave_host", "lcm.commands",
                 fmt::format("with ttl={} everybody on the network could command this machine: LCM knows no passwords", url->ttl),
                 "Set ttl=0 in the URL, or commands: disabled."});
    } else {
        if (config.lcm_required)
            errors.push_back({"hmi.required_but_off", "lcm.required", "LCM is required and switched off", "Remove one of the two."});
        if (config.lcm_commands != LcmCommands::disabled)
            errors.push_back({"hmi.commands_but_off", "lcm.commands", "commands over LCM are allowed, but LCM is switched off",
                              "Remove one of the two."});
    }
    if (config.socket.size() > 107)
        errors.push_back({"hmi.socket_too_long", "socket", "a socket's path has at most 107 characters", "Give a shorter path."});
    return errors;
}

}  // namespace taktwerk::hmi
