// Any bytes as a saved set of a drive's parameters: errors with a sentence each, or values that this drive has and that write back.
#include <cstdlib>
#include <string_view>

#include "axes/port/parameter_text.hpp"
#include "config/drive_file/drive_loader.hpp"
#include "config/drive_file/parameter_set.hpp"

using namespace taktwerk;
using namespace taktwerk::config;

namespace {
std::shared_ptr<const axes::DriveProfile> drive() {
    const auto loaded = load_drive(TAKTWERK_SOURCE_DIR "/config/drives/xp200.yaml");
    if (!std::holds_alternative<LoadedDrive>(loaded)) std::abort();
    return std::get<LoadedDrive>(loaded).profile;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto profile = drive();
    const auto read = parse_parameter_set("fuzz.yaml", {reinterpret_cast<const char*>(data), size}, *profile);
    if (const auto* errors = std::get_if<std::vector<Error>>(&read)) {
        if (errors->empty()) std::abort();
        for (const auto& error : *errors)
            if (error.what.empty()) std::abort();
        return 0;
    }
    const auto& set = std::get<ParameterSet>(read);
    for (const auto& value : set.values)
        if (value.parameter == nullptr || !axes::is_setting(*value.parameter)) std::abort();
    const auto again = parse_parameter_set("again.yaml", text_of(set), *profile);
    const auto* same = std::get_if<ParameterSet>(&again);
    if (same == nullptr || same->values.size() != set.values.size()) std::abort();
    for (std::size_t i = 0; i < set.values.size(); ++i)
        if (same->values[i].parameter != set.values[i].parameter || same->values[i].raw != set.values[i].raw) std::abort();
    return 0;
}
