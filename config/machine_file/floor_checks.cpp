#include "config/machine_file/floor_checks.hpp"

#include "runtime/check/machine_check.hpp"

namespace taktwerk::config {

std::vector<Error> check_floors(const LoadedMachine& loaded) {
    auto errors = runtime::check(loaded.machine);  // asks the axes and the bus too
    auto more = hmi::check(loaded.hmi);
    errors.insert(errors.end(), more.begin(), more.end());
    return errors;
}

}  // namespace taktwerk::config
