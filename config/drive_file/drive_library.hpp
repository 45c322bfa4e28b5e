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
    explicit DriveLibrary(std::vector<std::string> folders) : FileLibrary(std::move(folders), load_drive) {}
};

}  // namespace taktwerk::config
