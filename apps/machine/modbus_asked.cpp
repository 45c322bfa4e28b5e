#include "apps/machine/modbus_asked.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "modbus/tcp/request_plan.hpp"

namespace taktwerk::apps {

namespace {

using modbus::tcp::Channel;
using modbus::tcp::DeviceConfig;
using modbus::tcp::Request;

double in_ms(Duration duration) { return to_seconds(duration) * 1e3; }

std::vector<std::string> names_in(const DeviceConfig& device, const Request& request) {
    std::vector<std::string> names;
    for (const auto i : request.channels) names.push_back(device.channels[i].name);
    return names;
}

std::vector<std::string> unused_of(const DeviceConfig& device) {
    std::vector<std::string> names;
    for (const auto& channel : device.channels)
        if (channel.use == Channel::Use::none) names.push_back(channel.name);
    return names;
}

}  // namespace

std::string modbus_asked_text(const std::vector<DeviceConfig>& devices) {
    std::string out;
    for (const auto& device : devices) {
        out += fmt::format("  {:<12} {}, unit {}; read every {:g} ms, not good beyond {:g} ms; an answer within {:g} ms\n", device.name,
                           device.host.empty() ? std::string{"simulated"} : fmt::format("{} port {}", device.host, device.port),
                           device.unit, in_ms(device.poll), in_ms(device.max_age), in_ms(device.timeout));
        for (const auto& request : modbus::tcp::plan_requests(device))
            out += fmt::format("    {} {}: {}\n", request.write ? "writes by" : "reads by ", modbus::tcp::text_of(request),
                               fmt::join(names_in(device, request), ", "));
        if (const auto unused = unused_of(device); !unused.empty())
            out += fmt::format("    no point uses {}: not asked for\n", fmt::join(unused, ", "));
    }
    return out.empty() ? out : "\nModbus TCP devices\n" + out;
}

nlohmann::ordered_json modbus_asked_json(const std::vector<DeviceConfig>& devices) {
    using Json = nlohmann::ordered_json;
    Json all = Json::array();
    for (const auto& device : devices) {
        Json one{{"name", device.name},
                 {"host", device.host},
                 {"port", device.port},
                 {"unit", device.unit},
                 {"poll_ms", in_ms(device.poll)},
                 {"timeout_ms", in_ms(device.timeout)},
                 {"max_age_ms", in_ms(device.max_age)},
                 {"refresh_ms", in_ms(device.refresh)}};
        auto& requests = one["requests"] = Json::array();
        for (const auto& request : modbus::tcp::plan_requests(device))
            requests.push_back(Json{{"function", modbus::tcp::function_of(request)},
                                    {"write", request.write},
                                    {"address", request.address},
                                    {"count", request.count},
                                    {"registers", names_in(device, request)}});
        one["unused"] = unused_of(device);
        all.push_back(std::move(one));
    }
    return all;
}

}  // namespace taktwerk::apps
