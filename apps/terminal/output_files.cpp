#include "apps/terminal/output_files.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;

/// Devices and pipes take what comes from everybody.
bool same_file(const std::string& a, const std::string& b) {
    std::error_code failed;
    if (fs::exists(a, failed) && fs::exists(b, failed)) return fs::is_regular_file(a, failed) && fs::equivalent(a, b, failed);
    return fs::weakly_canonical(fs::absolute(a, failed), failed) == fs::weakly_canonical(fs::absolute(b, failed), failed);
}

}  // namespace

std::optional<Error> output_in_the_way(std::span<const OutputFile> outputs, std::span<const std::string> inputs) {
    const auto refuse = [](const OutputFile& output, std::string what) {
        return Error{"usage.output", output.option, fmt::format("'{}' {}", output.path, what), "give it a file of its own"};
    };
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].path.empty()) continue;
        for (const auto& input : inputs)
            if (!input.empty() && same_file(outputs[i].path, input)) return refuse(outputs[i], "would be written over what is to be read");
        for (std::size_t k = 0; k < i; ++k)
            if (!outputs[k].path.empty() && same_file(outputs[i].path, outputs[k].path))
                return refuse(outputs[i], fmt::format("is the file of {} already", outputs[k].option));
    }
    return std::nullopt;
}

}  // namespace taktwerk::apps
