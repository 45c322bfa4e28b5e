#pragma once
// How the machine's state goes out and commands come in. Plain data; config/ fills it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/modbus_server_config.hpp"
#include "hmi_bridge/view_config.hpp"

namespace taktwerk::hmi {

enum class LcmCommands : std::uint8_t {
    disabled,  ///< only the local socket commands (default)
    local,  ///< also over LCM with ttl=0: every process of this host may command, but for what the gateway takes from known clients alone
};

struct HistoryConfig {
    std::string directory;      ///< of the file; empty: the runtime's own choice (apps/machine/history_folder.hpp)
    std::int64_t rows = 10000;  ///< alarms kept, the newest; 0: no history
};

struct HmiConfig {
    bool lcm = true;  ///< publish the state over LCM
    std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
    bool lcm_required = false;  ///< refuse to run without a working LCM
    LcmCommands lcm_commands = LcmCommands::disabled;
    double rate_hz = 50;  ///< of the state messages, 1..1000
    std::string
        socket_group;    ///< group of the socket: besides the runtime's own user (and root) its members command; empty: the process' group
    std::string socket;  ///< Unix socket of the command line; empty: /run/taktwerk/<machine>.sock or $XDG_RUNTIME_DIR
    HistoryConfig history;
    std::optional<ModbusServerConfig> modbus_server;  ///< nothing: no Modbus client is served
    std::vector<View> views{};                        ///< the machine builder's own pages
};

[[nodiscard]] std::vector<Error> check(const HmiConfig& config);

}  // namespace taktwerk::hmi
