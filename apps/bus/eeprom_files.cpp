// EEPROM images on the disk. What is there is never written over.

#include <filesystem>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/bus/intel_hex.hpp"
#include "apps/bus/kept_file.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_eeprom_bytes = 512 * 1024;            ///< 4096 kbit: the largest that word 3Eh can sensibly say
constexpr std::size_t most_eeprom_text = 3 * most_eeprom_bytes;  ///< Intel HEX with 16 bytes a line takes 2.8 characters a byte
constexpr unsigned most_backups = 1000;                          ///< of one slave in one folder

}  // namespace

Result<EepromImage> read_eeprom_file(const std::string& path) {
    auto image = read_whole_file(path, most_eeprom_text, "eeprom.file");
    if (image && is_intel_hex(*image)) image = parse_intel_hex(*image, most_eeprom_bytes, path);
    if (image && image->size() > most_eeprom_bytes)
        return Error{"eeprom.file", path, fmt::format("{} bytes: more than the largest EEPROM has ({})", image->size(), most_eeprom_bytes),
                     "is it the file you mean?"};
    if (image && (image->size() % 2 != 0 || image->empty()))
        return Error{"eeprom.file", path, fmt::format("{} bytes are no EEPROM: it has words", image->size()),
                     "give a binary image, such as `bus eeprom read -o` writes, or one in Intel HEX"};
    return image;
}

Result<void> write_eeprom_file(const std::string& path, const EepromImage& image) {
    auto written = write_new_file(path, image, "eeprom.file", "eeprom.exists");
    if (written || written.error().code != "eeprom.exists") return written;
    const auto there = read_eeprom_file(path);
    return there && *there == image ? Result<void>{} : written;
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
