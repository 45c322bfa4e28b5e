#include "config/reading/files_read.hpp"

#include <algorithm>
#include <span>

#include "core/crc32.hpp"

namespace taktwerk::config {

namespace {
thread_local FilesRead* innermost = nullptr;
}  // namespace

FilesRead::FilesRead() : outer_(innermost) { innermost = this; }
FilesRead::~FilesRead() { innermost = outer_; }

void FilesRead::note(const std::string& path, std::string_view text) {
    if (innermost == nullptr) return;
    auto& files = innermost->files_;
    if (std::ranges::find(files, path, &File::path) != files.end()) return;
    files.push_back({path, crc32(std::as_bytes(std::span{text.data(), text.size()})), text.size()});
}

}  // namespace taktwerk::config
