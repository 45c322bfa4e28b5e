#include "apps/docs/device_page.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "config/device_file/device_loader.hpp"

namespace taktwerk::apps {

namespace {

using runtime::IoDirection;

std::string channels_of(const config::LoadedDevice& device) {
    std::string out;
    for (const auto direction : {IoDirection::input, IoDirection::output}) {
        const auto names = config::channel_names(device, direction);
        if (names.empty()) continue;
        std::set<std::string> units;
        for (const auto& channel : device.channels)
            if (channel.direction == direction && !channel.unit.empty()) units.insert(channel.unit);
        out += fmt::format("{}{}", out.empty() ? "" : ", ",
                           names.size() == 1 ? names.front() : fmt::format("{} to {}", names.front(), names.back()));
        for (const auto& unit : units) out += fmt::format(" ({})", unit);
    }
    return out.empty() ? "none" : out;
}

std::string current_of(const config::LoadedDevice& device) {
    const auto current = device.device->ebus_current;
    if (!current) return "not known";
    return *current < 0 ? fmt::format("supplies {} mA", -*current) : fmt::format("{} mA", *current);
}

std::string words(const std::string& checked) {
    return checked == "unit"          ? "a real unit"
           : checked == "vendor_file" ? "the vendor's file"
           : checked == "project"     ? "one project"
                                      : "inferred";
}

std::string escaped(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
    return text;
}

}  // namespace

std::string device_reference_markdown(const std::vector<std::string>& folders) {
    config::DeviceLibrary library(folders);
    std::string out =
        "# Devices that are no drives\n\n"
        "Made from `config/devices/` by `taktwerk docs devices`; do not edit. How they are used: [../devices.md](../devices.md). None was "
        "tried on\n"
        "hardware; *checked against* says how far its facts are to be trusted.\n\n"
        "| device | vendor | what it is | channels | E-bus | checked against | source |\n|---|---|---|---|---|---|---|\n";
    for (const auto& name : library.names())
        if (const auto* device = library.find(name))
            out += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", name, escaped(device->vendor), escaped(device->title),
                               channels_of(*device), current_of(*device), words(device->checked), escaped(device->source));
    return out;
}

}  // namespace taktwerk::apps
