#pragma once
// A machine with a slave that has files, firmware and Ethernet, in a folder of its own; and firmware for it.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "ecat/sim/firmware_image.hpp"

namespace taktwerk::apps {

class GaugeFiles {
public:
    GaugeFiles() {
        std::filesystem::create_directories(folder + "/machines");
        std::filesystem::create_directories(folder + "/devices");
        std::ofstream(folder + "/devices/gauge.yaml") << R"(version: 1
name: gauge
vendor: nobody
title: a gauge with files, for tests
source: made up
checked: project
identity: { device_name: GAUGE, vendor: 0x00000ABC, product: 0x00004711, revision: 0x00010000, revision_rule: any }
mailbox:
  coe: true
  foe: true
  eoe: true
  bootstrap: { out_start: 0x1000, out_size: 256, in_start: 0x1100, in_size: 256 }
sync_managers:
  - { use: mailbox_out, start: 0x1000, size: 128, control: 0x26 }
  - { use: mailbox_in, start: 0x1080, size: 128, control: 0x22 }
  - { use: outputs, start: 0x1200, control: 0x24 }
  - { use: inputs, start: 0x1300, control: 0x20 }
pdo:
  tx:
    - { pdo: 1A00h, fixed: true, sync_manager: 3, assigned: true, objects: [6000h:01/16] }
objects:
  - { object: 100Ah, name: software version, type: STRING, access: ro, text: '?' }
channels:
  value: { input: 6000h:01, type: I16 }
)";
        std::ofstream(machine) << R"(version: 1
name: gauges
cycle: 4 ms
bus:
  interface: simulated
  slaves:
    - { name: io, terminal: { inputs: 8, outputs: 8 } }
    - { name: gauge, device: gauge }
)";
    }
    ~GaugeFiles() { std::filesystem::remove_all(folder); }
    GaugeFiles(const GaugeFiles&) = delete;
    GaugeFiles& operator=(const GaugeFiles&) = delete;

    [[nodiscard]] std::string keep(const std::string& name, std::string_view bytes) const {
        auto path = folder + "/" + name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }
    [[nodiscard]] std::string firmware(const std::string& name, std::string_view version, std::uint32_t revision,
                                       std::uint32_t product = 0x4711, std::size_t body = 12'000) const {
        const auto image = ecat::sim::firmware_image({0xABC, product, revision, 0}, version, body);
        return keep(name, {reinterpret_cast<const char*>(image.data()), image.size()});
    }

    const std::string folder = (std::filesystem::temp_directory_path() / ("taktwerk-gauge-" + std::to_string(::getpid()))).string();
    const std::string machine = folder + "/machines/gauges.yaml";
};

}  // namespace taktwerk::apps
