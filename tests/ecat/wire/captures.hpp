#pragma once
// Where recorded traffic and EEPROM images are found, and their content.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/ecat/wire/pcapng.hpp"

namespace taktwerk::ecat::test {

/// Recorded traffic and EEPROM images lie beside the source tree, not in it: $TAKTWERK_CAPTURES, else ../shared/captures.
inline std::filesystem::path captures_folder() {
    if (const char* folder = std::getenv("TAKTWERK_CAPTURES")) return folder;
    return std::filesystem::path{TAKTWERK_SOURCE_DIR}.parent_path() / "shared" / "captures";
}

#define TAKTWERK_SKIP_WITHOUT_CAPTURES()                                           \
    if (!std::filesystem::is_directory(::taktwerk::ecat::test::captures_folder())) \
    GTEST_SKIP() << "no recorded traffic at " << ::taktwerk::ecat::test::captures_folder() << "; $TAKTWERK_CAPTURES names another folder"

/// Every recording that is there.
inline std::vector<std::filesystem::path> capture_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{captures_folder()})
        if (entry.path().extension() == ".pcapng") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

inline std::vector<std::byte> read_file(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    const std::vector<char> chars{std::istreambuf_iterator<char>{file}, {}};
    std::vector<std::byte> bytes;
    bytes.reserve(chars.size());
    for (const char c : chars) bytes.push_back(static_cast<std::byte>(c));
    return bytes;
}

inline std::vector<std::vector<std::byte>> read_pcapng(const std::filesystem::path& path) {
    std::vector<std::vector<std::byte>> packets;
    const auto file = read_file(path);
    for (const auto packet : parse_pcapng(file)) packets.emplace_back(packet.begin(), packet.end());
    return packets;
}

}  // namespace taktwerk::ecat::test
