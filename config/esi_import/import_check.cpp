#include "config/esi_import/import_check.hpp"

#include "config/device_file/device_loader.hpp"

namespace taktwerk::config {

std::vector<Error> problems_of_device(const std::string& name, std::string_view text) {
    auto loaded = load_device_text(name + ".yaml", text);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) return std::move(*errors);
    ecat::BusConfig bus;
    ecat::SlaveConfig slave;
    slave.name = name;
    slave.position = 0;
    slave.device = std::get<LoadedDevice>(loaded).device;
    slave.dc = slave.device->dc.supported;
    bus.slaves.push_back(std::move(slave));
    return ecat::check(bus);
}

}  // namespace taktwerk::config
