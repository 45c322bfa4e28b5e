#include "config/machine_file/floor_checks.hpp"

#include "hmi_bridge/modbus/shown_value.hpp"
#include "hmi_bridge/views/view_check.hpp"
#include "runtime/check/machine_check.hpp"

namespace taktwerk::config {

std::vector<Error> check_floors(const LoadedMachine& loaded) {
    auto errors = runtime::check(loaded.machine);  // asks the axes and the bus too
    auto more = hmi::check(loaded.hmi);
    errors.insert(errors.end(), more.begin(), more.end());
    more = hmi::check(loaded.hmi.views, hmi::view_values_of(loaded.machine));
    errors.insert(errors.end(), more.begin(), more.end());
    if (!loaded.hmi.modbus_server) return errors;
    more = hmi::check(*loaded.hmi.modbus_server, hmi::names_of(loaded.machine));
    errors.insert(errors.end(), more.begin(), more.end());
    return errors;
}

}  // namespace taktwerk::config
