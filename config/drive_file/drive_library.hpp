#pragma once
// Drive files by name: `profile: sv33-e`.

#include <string>
#include <utility>
#include <vector>

#include "config/drive_file/drive_loader.hpp"
#include "config/reading/file_library.hpp"

namespace taktwerk::config {

class DriveLibrary : public FileLibrary<LoadedDrive> {
public:
    explicit DriveLibrary(const std::vector<std::string>& folders)
        : FileLibrary(folders, [folders](const std::string& path) { return load_drive(path, folders); }) {}
};

}  // namespace taktwerk::config
