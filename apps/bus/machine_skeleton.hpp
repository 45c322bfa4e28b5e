#pragma once
// A machine file to begin with, made of the slaves that are on a bus: what is known of them, and what has to be filled in. Pure.

#include <string>
#include <vector>

#include "config/device_file/device_loader.hpp"
#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::apps {

/// What a slave on the bus was recognised as.
struct RecognisedSlave {
    enum class Kind : std::uint8_t { unknown, drive, device } kind = Kind::unknown;
    std::string type;   ///< the name of its drive or device file
    unsigned axes = 1;  ///< of a drive
    const config::LoadedDevice* device = nullptr;
    std::string remark;  ///< what a person should look at; may be empty
};

/// `interfaces`: the lines of the bus that name them. YAML that `check` accepts: one for each slave in the order of the cable. Names are made of the types: `el3104_4`, axes are `axis1`, ... .
[[nodiscard]] std::string machine_skeleton(const std::string& name, const std::string& interfaces, const ecat::Survey& survey,
                                           const std::vector<RecognisedSlave>& slaves);

}  // namespace taktwerk::apps
