#include "config/drive_file/drive_library.hpp"

#include <algorithm>
#include <filesystem>

namespace taktwerk::config {

namespace fs = std::filesystem;

std::string DriveLibrary::path_of(const std::string& name) const {
    for (const auto& folder : folders_) {
        const auto path = fs::path(folder) / (name + ".yaml");
        std::error_code error;
        if (fs::exists(path, error)) return path.lexically_normal().string();
    }
    return {};
}

bool DriveLibrary::exists(const std::string& name) const { return !path_of(name).empty(); }

const LoadedDrive* DriveLibrary::find(const std::string& name) {
    auto found = drives_.find(name);
    if (found == drives_.end()) {
        const auto path = path_of(name);
        if (path.empty()) return nullptr;
        found = drives_.emplace(name, load_drive(path)).first;
        if (const auto* errors = std::get_if<std::vector<Error>>(&found->second))
            errors_.insert(errors_.end(), errors->begin(), errors->end());
    }
    return std::get_if<LoadedDrive>(&found->second);
}

std::vector<std::string> DriveLibrary::names() const {
    std::vector<std::string> out;
    for (const auto& folder : folders_) {
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
