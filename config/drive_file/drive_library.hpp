#pragma once
// Finds drive files by name in some folders; each is read once.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/drive_file/drive_loader.hpp"

namespace taktwerk::config {

class DriveLibrary {
public:
    explicit DriveLibrary(std::vector<std::string> folders) : folders_(std::move(folders)) {}

    /// nullptr when there is no such file or it has errors (then errors() grew).
    const LoadedDrive* find(const std::string& name);
    [[nodiscard]] bool exists(const std::string& name) const;
    [[nodiscard]] std::vector<std::string> names() const;  ///< all drive types in the folders
    [[nodiscard]] const std::vector<std::string>& folders() const noexcept { return folders_; }
    [[nodiscard]] const std::vector<Error>& errors() const noexcept { return errors_; }

private:
    [[nodiscard]] std::string path_of(const std::string& name) const;
    std::vector<std::string> folders_;
    std::map<std::string, std::variant<LoadedDrive, std::vector<Error>>, std::less<>> drives_;
    std::vector<Error> errors_;
};

}  // namespace taktwerk::config
