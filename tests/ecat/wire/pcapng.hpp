#pragma once
// The packets of a little-endian pcapng file, and where recorded traffic is found.

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

#include "core/bytes.hpp"

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

/// Enhanced and simple packet blocks (types 6 and 3); everything else is skipped.
inline std::vector<std::vector<std::byte>> read_pcapng(const std::filesystem::path& path) {
    const auto file = read_file(path);
    std::vector<std::vector<std::byte>> packets;
    const std::span<const std::byte> all{file};
    for (std::size_t at = 0; at + 12 <= all.size();) {
        const auto type = load_le<std::uint32_t>(all, at);
        const std::size_t length = load_le<std::uint32_t>(all, at + 4);
        if (length < 12 || length > all.size() - at) break;
        const auto body = all.subspan(at + 8, length - 12);
        if (type == 6 && body.size() >= 20) {
            const auto packet = body.subspan(20, std::min<std::size_t>(load_le<std::uint32_t>(body, 12), body.size() - 20));
            packets.emplace_back(packet.begin(), packet.end());
        } else if (type == 3 && body.size() >= 4) {
            const auto packet = body.subspan(4, std::min<std::size_t>(load_le<std::uint32_t>(body, 0), body.size() - 4));
            packets.emplace_back(packet.begin(), packet.end());
        }
        at += length;
    }
    return packets;
}

}  // namespace taktwerk::ecat::test
