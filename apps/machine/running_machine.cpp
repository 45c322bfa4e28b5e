#include "apps/machine/running_machine.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "hmi_bridge/socket/client.hpp"
#include "hmi_bridge/socket/socket_path.hpp"

namespace taktwerk::apps {

namespace {

constexpr Duration patience = std::chrono::milliseconds{500};

std::vector<std::string> sockets() {
    std::vector<std::string> out;
    for (const auto& folder : hmi::socket_folders()) {
        std::error_code ignored;
        for (std::filesystem::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
            if (entry->path().extension() == ".sock") out.push_back(entry->path().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

bool drives(const nlohmann::ordered_json& hello, const std::string& port) {
    if (const auto interface = hello.find("interface"); interface != hello.end() && *interface == port) return true;
    const auto devices = hello.find("serial_devices");
    return devices != hello.end() && devices->is_array() && std::find(devices->begin(), devices->end(), port) != devices->end();
}

/// Whatever answers there may be of another version, or no runtime at all.
RunningMachine running(const nlohmann::ordered_json& hello, const std::string& path) {
    const auto name = hello.find("machine"), process = hello.find("pid");
    return {name != hello.end() && name->is_string() ? name->get<std::string>() : std::string{}, path,
            process != hello.end() && process->is_number_integer() ? process->get<int>() : 0};
}

}  // namespace

std::optional<RunningMachine> machine_on(const std::string& port, const std::string& further_socket) {
    auto paths = sockets();
    if (!further_socket.empty()) paths.push_back(further_socket);
    for (const auto& path : paths) {
        auto client = hmi::Client::connect(path);
        if (!client) continue;
        const auto answer = client->request({{"cmd", "hello"}}, patience);
        if (!answer || !answer->contains("hello")) continue;
        const auto& hello = (*answer)["hello"];
        if (hello.is_object() && drives(hello, port)) return running(hello, path);
    }
    return std::nullopt;
}

}  // namespace taktwerk::apps
