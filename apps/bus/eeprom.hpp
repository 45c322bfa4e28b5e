#pragma once
// `taktwerk bus eeprom`: what its sub-commands share. Texts are pure, so that tests read them; files are never written over.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/bus/bus.hpp"

namespace taktwerk::apps {

/// Everything in an EEPROM, as little-endian words.
using EepromImage = std::vector<std::byte>;

struct EepromOptions {
    std::shared_ptr<BusOptions> bus;
    std::string slave, file, folder = ".";
    std::vector<std::string> slaves;
    std::uint16_t alias = 0;
};

void add_eeprom_read(CLI::App& eeprom, Action& action);
void add_eeprom_show(CLI::App& eeprom, Action& action);
void add_eeprom_backup(CLI::App& eeprom, Action& action);
void add_eeprom_write(CLI::App& eeprom, Action& action);
void add_eeprom_alias(CLI::App& eeprom, Action& action);
void add_eeprom_make(CLI::App& eeprom, Action& action);

// --- eeprom_text.cpp, eeprom_json.cpp -------------------------------------------------------------------------------------------
/// All that an image says. `where`: "slave 0 'x_drive'", a file.
[[nodiscard]] std::string eeprom_text(const std::string& where, std::span<const std::byte> image, Colours colours);
/// Header and categories, with the end marker.
[[nodiscard]] std::size_t eeprom_used_bytes(std::span<const std::byte> image);
[[nodiscard]] Json eeprom_json(std::span<const std::byte> image);

// --- eeprom_changes.cpp --------------------------------------------------------------------------------------------------------
/// Word by word what a writing changes; neighbours of one field share a line.
[[nodiscard]] std::string eeprom_changes_text(std::span<const std::byte> before, std::span<const std::byte> after, Colours colours);
[[nodiscard]] Json eeprom_changes_json(std::span<const std::byte> before, std::span<const std::byte> after);
/// `file` laid over all that is in the slave. Errors, of which `force` overrules all but the first: eeprom.too_large, eeprom.image (damaged),
/// eeprom.other_device, eeprom.other_size, eeprom.other_interface.
[[nodiscard]] Result<EepromImage> eeprom_after(const std::string& subject, const EepromImage& before, const EepromImage& file, bool force);
/// The same with another alias. Errors: eeprom.image when its checksum is wrong already.
[[nodiscard]] Result<EepromImage> eeprom_with_alias(const std::string& subject, const EepromImage& before, std::uint16_t alias, bool force);

// --- eeprom_files.cpp ----------------------------------------------------------------------------------------------------------
/// Binary, or Intel HEX. Errors: eeprom.file, eeprom.hex.
[[nodiscard]] Result<EepromImage> read_eeprom_file(const std::string& path);
/// On the disk when it returns. Where such a file is there already it must have this content. Errors: eeprom.file, eeprom.exists.
[[nodiscard]] Result<void> write_eeprom_file(const std::string& path, const EepromImage& image);
/// "slave0-000007FB-000C0108-00010001-serial0.bin"
[[nodiscard]] std::string eeprom_backup_name(std::uint16_t position, const EepromImage& image);
/// Puts it into a folder, which is made if need be, and gives the path; beside another content under this name as "...-2.bin".
[[nodiscard]] Result<std::string> back_up_eeprom(const std::string& folder, std::uint16_t position, const EepromImage& image);

// --- eeprom_read.cpp -----------------------------------------------------------------------------------------------------------
/// All that its memory says it has; of an empty one at least `bytes`.
[[nodiscard]] Result<EepromImage> read_eeprom_of(BusSession& session, const ecat::Survey& survey, std::size_t position,
                                                 std::size_t bytes = 0);
/// To the processors of those slaves that had theirs before this command looked. Prints what went wrong.
void give_eeproms_back(BusSession& session, const ecat::Survey& survey);
/// Looks, finds the slave, works, gives back.
int with_eeprom(BusSession& session, const EepromOptions& options, const std::function<int(const ecat::Survey&, std::size_t)>& work);

}  // namespace taktwerk::apps
