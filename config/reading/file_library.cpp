#include "config/reading/file_library.hpp"

#include <algorithm>
#include <filesystem>

namespace taktwerk::config {

namespace fs = std::filesystem;

std::string find_file(const std::vector<std::string>& folders, const std::string& name) {
    for (const auto& folder : folders) {
        const auto path = fs::path(folder) / (name + ".yaml");
        std::error_code error;
        if (fs::exists(path, error)) return path.lexically_normal().string();
    }
    return {};
}

std::vector<std::string> file_names(const std::vector<std::string>& folders) {
    std::vector<std::string> out;
    for (const auto& folder : folders) {
        std::error_code error;
        for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
            const auto& file = it->path();
            const auto stem = file.stem().string();
            if (file.extension() == ".yaml" && stem.find('.') == std::string::npos) out.push_back(stem);
        }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

}  // namespace taktwerk::config
