// Any bytes as a machine file: a machine or errors, each with a sentence; never a crash.
#include <cstdlib>
#include <string_view>

#include "config/machine_file/machine_loader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace taktwerk;
    config::LoadOptions options;
    options.resolve_programs = false;
    const auto loaded = config::load_machine_text("fuzz.yaml", {reinterpret_cast<const char*>(data), size}, options);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded))
        for (const auto& error : *errors)
            if (error.what.empty()) std::abort();
    return 0;
}
