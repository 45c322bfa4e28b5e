// EEPROM images on the disk. What is there is never written over.

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_eeprom_bytes = 512 * 1024;  ///< 4096 kbit: the largest that word 3Eh can sensibly say
constexpr unsigned most_backups = 1000;                ///< of one slave in one folder

Error file_error(const std::string& path, const char* doing) {
    return {"eeprom.file", path, fmt::format("the file cannot be {}: {}", doing, std::strerror(errno)),
            "check the path, and that you may use it"};
}

bool holds(const std::string& path, const EepromImage& image) {
    const auto there = read_eeprom_file(path);
    return there && *there == image;
}

/// Until it is on the disk: what is in the EEPROM may be gone with the next power cut.
Result<void> write_all(int file, const std::string& path, const EepromImage& image) {
    for (std::size_t done = 0; done < image.size();) {
        const auto some = ::write(file, image.data() + done, image.size() - done);
        if (some < 0 && errno == EINTR) continue;
        if (some <= 0) return file_error(path, "written");
        done += static_cast<std::size_t>(some);
    }
    if (::fsync(file) != 0) return file_error(path, "written");
    return {};
}

}  // namespace

Result<EepromImage> read_eeprom_file(const std::string& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return Error{"eeprom.file", path, "is a folder", "give the file in it"};
    std::ifstream file{path, std::ios::binary};
    if (!file) return file_error(path, "read");
    const std::vector<char> chars{std::istreambuf_iterator<char>{file}, {}};
    if (chars.size() > most_eeprom_bytes || chars.size() % 2 != 0 || chars.empty())
        return Error{"eeprom.file", path,
                     fmt::format("{} bytes are no EEPROM: it has words, and at most {} KiB", chars.size(), most_eeprom_bytes / 1024),
                     "give a binary image, such as `bus eeprom read -o` writes"};
    EepromImage image;
    image.reserve(chars.size());
    for (const char c : chars) image.push_back(static_cast<std::byte>(c));
    return image;
}

Result<void> write_eeprom_file(const std::string& path, const EepromImage& image) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0 && errno == EEXIST) {
        if (holds(path, image)) return {};
        return Error{"eeprom.exists", path, "there is such a file already, with another content",
                     "choose another name: nothing is written over"};
    }
    if (file < 0) return file_error(path, "written");
    auto written = write_all(file, path, image);
    if (::close(file) != 0 && written) return file_error(path, "written");
    if (!written) ::unlink(path.c_str());
    return written;
}

std::string eeprom_backup_name(std::uint16_t position, const EepromImage& image) {
    const auto id = ecat::parse_sii(image).identity;
    return fmt::format("slave{}-{:08X}-{:08X}-{:08X}-serial{}.bin", position, id.vendor, id.product, id.revision, id.serial);
}

Result<std::string> back_up_eeprom(const std::string& folder, std::uint16_t position, const EepromImage& image) {
    std::error_code ignored;  // the file says what is wrong
    fs::create_directories(folder, ignored);
    const fs::path name = eeprom_backup_name(position, image);
    for (unsigned n = 1; n <= most_backups; ++n) {
        const auto path = (fs::path(folder) / (n == 1 ? name : fs::path(fmt::format("{}-{}.bin", name.stem().string(), n)))).string();
        const auto written = write_eeprom_file(path, image);
        if (written) return path;
        if (written.error().code != "eeprom.exists") return written.error();
    }
    return Error{"eeprom.file", folder, fmt::format("there are {} backups of this slave with other contents", most_backups),
                 "give another folder: -d DIR"};
}

}  // namespace taktwerk::apps
