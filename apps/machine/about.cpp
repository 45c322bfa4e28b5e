#include "apps/machine/about.hpp"

#include "programs/api/abi.hpp"

namespace taktwerk::apps {

// Versions as cmake found them; licences as the Debian packages' copyright files state them.
hmi::JsonRequests::About about() {
    return {sdk_version,
            {{"taktwerk", sdk_version, "Apache-2.0"},
             {"CLI11", TAKTWERK_CLI11_VERSION, "BSD-3-Clause"},
             {"Eigen", TAKTWERK_EIGEN_VERSION, "MPL-2.0"},
             {"fmt", TAKTWERK_FMT_VERSION, "MIT"},
             {"LCM", "", "LGPL-2.1"},
             {"libmodbus", TAKTWERK_LIBMODBUS_VERSION, "LGPL-2.1"},
             {"nlohmann-json", TAKTWERK_JSON_VERSION, "MIT"},
             {"pugixml", TAKTWERK_PUGIXML_VERSION, "MIT"},
             {"SQLite", TAKTWERK_SQLITE_VERSION, "public domain"},
             {"yaml-cpp", TAKTWERK_YAML_VERSION, "MIT"}}};
}

}  // namespace taktwerk::apps
