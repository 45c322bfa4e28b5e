// What a writing would change, and whether it may.

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/count_text.hpp"
#include "core/bytes.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Sii;
using ecat::SiiDefect;

/// The field in the image where it means something: what lies behind the end of one may be a string of the other.
std::string changed_field(std::span<const std::byte> before, std::span<const std::byte> after, std::size_t word) {
    auto field = ecat::sii_field(after, word);
    return field == "behind the end marker" ? ecat::sii_field(before, word) + ", no longer used" : field;
}

std::string identity_words(const ecat::Identity& id) {
    return fmt::format("vendor {:08X}h product {:08X}h revision {:08X}h", id.vendor, id.product, id.revision);
}

bool same_device(const ecat::Identity& a, const ecat::Identity& b) {
    return a.vendor == b.vendor && a.product == b.product && a.revision == b.revision;
}

/// Nobody could use such an EEPROM. What else may be wrong with one is how many vendors deliver them.
std::optional<SiiDefect> grave_defect(const Sii& sii) {
    for (const auto defect :
         {SiiDefect::empty, SiiDefect::truncated_header, SiiDefect::bad_checksum, SiiDefect::truncated_category, SiiDefect::no_end})
        if (sii.has(defect)) return defect;
    return std::nullopt;
}

Result<void> fits_slave(const std::string& subject, const EepromImage& before, const EepromImage& file) {
    const Sii is = ecat::parse_sii(before), wanted = ecat::parse_sii(file);
    if (const auto defect = grave_defect(wanted))
        return Error{
            "eeprom.image", subject, fmt::format("no slave could use this image: {}", text(*defect)),
            "give a whole image, such as `bus eeprom read -o` or `bus eeprom backup` write; with --force it is written all the same"};
    if (!same_device(is.identity, wanted.identity))
        return Error{"eeprom.other_device", subject,
                     fmt::format("the image is of another device: it says {}, the slave {}", identity_words(wanted.identity),
                                 is.has(SiiDefect::empty) ? "nothing, its EEPROM is empty" : identity_words(is.identity)),
                     "check the file and the slave; where that is what you want (an empty EEPROM, another revision), say --force"};
    if (is.has(SiiDefect::bad_checksum)) return {};  // what the controller did not load tells nothing of what it needs
    if (is.size_code != wanted.size_code)
        return Error{
            "eeprom.other_size", subject,
            fmt::format("the image is for an EEPROM of {} kbit, the slave says that it has {}", wanted.size_code + 1, is.size_code + 1),
            "check that it is of this kind of slave; with --force it is written all the same"};
    if (is.pdi_control != wanted.pdi_control || is.pdi_configuration != wanted.pdi_configuration)
        return Error{"eeprom.other_interface", subject,
                     fmt::format("the image changes how the controller speaks to the slave's processor: PDI control {:04X}h to {:04X}h, "
                                 "configuration {:04X}h to {:04X}h",
                                 is.pdi_control, wanted.pdi_control, is.pdi_configuration, wanted.pdi_configuration),
                     "a wrong one leaves the slave without its processor until it is written back; if that is what you want, say --force"};
    return {};
}

}  // namespace

Result<EepromImage> eeprom_after(const std::string& subject, const EepromImage& before, const EepromImage& file, bool force) {
    if (file.size() > before.size())
        return Error{"eeprom.too_large", subject, fmt::format("the image has {} bytes, its EEPROM {}", file.size(), before.size()),
                     "check that it is of this kind of slave"};
    if (const auto fits = fits_slave(subject, before, file); !fits && !force) return fits.error();
    EepromImage after = before;
    std::copy(file.begin(), file.end(), after.begin());
    return after;
}

Result<EepromImage> eeprom_with_alias(const std::string& subject, const EepromImage& before, std::uint16_t alias, bool force) {
    const Sii is = ecat::parse_sii(before);
    if (const auto defect = grave_defect(is); defect && (!force || before.size() < ecat::sii_header_bytes))
        return Error{
            "eeprom.image", subject, fmt::format("its EEPROM is not in order: {}", text(*defect)),
            "a new checksum would make the controller load words that it does not load now: write a whole image instead, or say --force"};
    EepromImage after = before;
    ecat::set_sii_alias(after, alias);
    return after;
}

std::string eeprom_changes_text(std::span<const std::byte> before, std::span<const std::byte> after, Colours colours) {
    constexpr std::size_t most_words = 8;  // of one field, side by side
    using Side = TextTable::Column::Side;
    TextTable table{{{"word"}, {"is", Side::left, 40}, {"becomes", Side::left, 40}, {"field", Side::left, 48}}};
    const auto changes = ecat::sii_changes(before, after);
    for (std::size_t n = 0; n < changes.size();) {
        const auto field = changed_field(before, after, changes[n].word);
        std::string from, to;
        std::size_t end = n;
        for (; end < changes.size() && end - n < most_words; ++end) {
            if (changes[end].word != changes[n].word + (end - n) || changed_field(before, after, changes[end].word) != field) break;
            from += fmt::format("{}{:04X}", end == n ? "" : " ", changes[end].from);
            to += fmt::format("{}{:04X}", end == n ? "" : " ", changes[end].to);
        }
        table.add({fmt::format("{:04X}h", changes[n].word), from, to, field});
        n = end;
    }
    return count_text(changes.size(), "word") + (changes.size() == 1 ? " differs\n" : " differ\n") + table.text(colours, 2);
}

Json eeprom_changes_json(std::span<const std::byte> before, std::span<const std::byte> after) {
    Json list = Json::array();
    for (const auto& change : ecat::sii_changes(before, after))
        list.push_back(
            Json{{"word", change.word}, {"from", change.from}, {"to", change.to}, {"field", changed_field(before, after, change.word)}});
    return list;
}

}  // namespace taktwerk::apps
