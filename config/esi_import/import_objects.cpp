// The dictionary, and names for process data.

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/esi_import/import_parts.hpp"
#include "ecat/esi/base_type.hpp"

namespace taktwerk::config {

namespace {

using namespace ecat::esi;
using ecat::DataType;
using Address = std::pair<std::uint16_t, std::uint8_t>;

constexpr std::size_t most_objects = 4000;  // a file that people edit, and that its reader takes (document.hpp)

/// What follows from the other parts of a description (DeviceDescription::objects).
bool follows_from_the_rest(std::uint16_t index) {
    return index == 0x1008 || index == 0x1018 || (index >= 0x1C00 && index <= 0x1C3F) || (index >= 0x1600 && index <= 0x1BFF);
}

bool is_whole(DataType type) { return type != DataType::STRING && type != DataType::REAL32 && type != DataType::REAL64; }

/// A number as one of the type: "#x80000000" of a DINT is negative. Nothing: it is beyond the type.
std::optional<std::int64_t> as_of(DataType type, std::optional<std::int64_t> value) {
    const auto bits = ecat::bit_size(type);
    if (!value || !is_whole(type) || bits == 0) return std::nullopt;
    if (bits == 64) return !ecat::is_signed(type) && *value < 0 ? std::nullopt : value;
    const std::int64_t all = std::int64_t{1} << bits, half = std::int64_t{1} << (bits - 1);
    if (!ecat::is_signed(type)) return *value >= 0 && *value < all ? value : std::nullopt;
    if (*value >= half && *value < all) return *value - all;
    return *value >= -half && *value < half ? value : std::nullopt;
}

ObjectRow row_of(const EsiObject& from) {
    ObjectRow row;
    auto& object = row.object;
    object.index = from.index, object.sub = from.sub;
    object.name = from.name.empty() ? fmt::format("object {:04X}h:{:02X}", from.index, from.sub) : from.name;
    object.type = *from.basic;
    object.access = from.access;
    object.mappable = from.mappable;
    if (const auto value = as_of(object.type, from.value)) object.value = *value, row.has_value = true;
    object.minimum = as_of(object.type, from.minimum), object.maximum = as_of(object.type, from.maximum);
    if (object.minimum && object.maximum && *object.minimum > *object.maximum) object.minimum.reset(), object.maximum.reset();
    object.text = from.text;
    row.parameter.unit = from.unit;
    row.parameter.meaning = from.meaning;
    return row;
}

std::string snake(const std::string& words) {
    std::string out;
    for (const char c : words) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 && byte < 0x80) out += static_cast<char>(std::tolower(byte));
        else if (!out.empty() && out.back() != '_') out += '_';
    }
    while (!out.empty() && out.back() == '_') out.pop_back();
    if (!out.empty() && std::isdigit(static_cast<unsigned char>(out.front())) != 0) out = "ch_" + out;
    if (out == "null") out = "ch_null";  // which is no word in YAML
    return out;
}

}  // namespace

void import_objects(const EsiDevice& from, EsiImport& to) {
    std::set<Address> there, of_modules;
    std::vector<std::string> without_type;
    std::size_t cut = 0, beyond = 0;
    for (const auto& object : from.objects) {
        if (follows_from_the_rest(object.index)) {
            if (object.index == 0x1008 && object.sub == 0 && !object.text.empty()) to.file.device.device_name = object.text;
            continue;
        }
        if (!object.basic) {
            without_type.push_back(fmt::format("{:04X}h:{:02X} ({})", object.index, object.sub, object.type));
            continue;
        }
        if (to.file.objects.size() >= most_objects) {
            ++cut;
            continue;
        }
        if (!there.emplace(object.index, object.sub).second) continue;
        to.file.objects.push_back(row_of(object));
        const auto& row = to.file.objects.back();
        const bool lost =
            (object.value && !row.has_value) || (object.minimum && !row.object.minimum) || (object.maximum && !row.object.maximum);
        if (lost) ++beyond;
    }
    if (!without_type.empty()) {
        const auto all = without_type.size();
        constexpr std::size_t shown = 5;
        if (all > shown) without_type.resize(shown);
        to.leftovers.push_back({fmt::format("{} values of types that are not known here: {}{}", all, fmt::join(without_type, ", "),
                                            all > shown ? ", ..." : ""),
                                "`bus sdo` reads and writes them as bytes"});
    }
    if (cut > 0)
        to.leftovers.push_back({fmt::format("{} values of the dictionary beyond the first {}", cut, most_objects),
                                "`bus sdo` and `drive get` take them by number"});
    if (beyond > 0)
        to.leftovers.push_back({fmt::format("defaults or limits of {} objects that do not fit their types", beyond), "left out"});
    // Objects of PDOs that the dictionary does not list: a signed number needs its type. Of modules as in slot 0, where several may use one
    // number: the widest type counts.
    const auto add = [&](const EsiEntry& entry, bool rx) {
        const auto type = basic_type(entry.type);
        if (entry.index == 0 || !type || ecat::bit_size(*type) < entry.bits) return;
        if (!there.emplace(entry.index, entry.sub).second) {
            for (auto& row : to.file.objects)
                if (of_modules.count({entry.index, entry.sub}) != 0 && row.object.index == entry.index && row.object.sub == entry.sub &&
                    ecat::bit_size(row.object.type) < ecat::bit_size(*type))
                    row.object.type = *type;
            return;
        }
        EsiObject object;
        object.index = entry.index, object.sub = entry.sub;
        object.name = entry.name;
        object.basic = type;
        object.access = rx ? ecat::Access::rw : ecat::Access::ro;
        object.mappable = rx ? ecat::Mappable::rx : ecat::Mappable::tx;
        to.file.objects.push_back(row_of(object));
    };
    for (const bool rx : {true, false})
        for (const auto& pdo : rx ? from.rx : from.tx)
            for (const auto& entry : pdo.entries) add(entry, rx);
    for (const auto& module : from.modules)
        for (const bool rx : {true, false})
            for (const auto& pdo : rx ? module.rx : module.tx)
                for (const auto& entry : pdo.entries) {
                    if (there.count({entry.index, entry.sub}) == 0) of_modules.emplace(entry.index, entry.sub);
                    add(entry, rx);
                }
}

void import_channels(const EsiDevice& from, EsiImport& to) {
    constexpr std::uint32_t most_bits = 64;
    constexpr std::size_t longest_channel = 80;
    struct Named {
        Address address;
        std::string of_entry, of_both, doc;
        bool rx;
    };
    std::vector<Named> all;
    std::set<std::pair<bool, Address>> there;
    std::map<std::string, int> uses;
    for (const bool rx : {true, false})
        for (const auto& pdo : rx ? from.rx : from.tx)
            for (const auto& entry : pdo.entries) {
                const Address address{entry.index, entry.sub};
                if (entry.index == 0 || entry.bits == 0 || entry.bits > most_bits || !there.emplace(rx, address).second) continue;
                all.push_back({address, snake(entry.name), snake(pdo.name + " " + entry.name), pdo.name + ": " + entry.name, rx});
                ++uses[all.back().of_entry];
            }
    std::set<std::string> taken;
    for (const auto& one : all) {
        auto name = one.of_entry.empty() || uses[one.of_entry] > 1 ? one.of_both : one.of_entry;
        if (name.empty()) name = one.rx ? "out" : "in";
        name.resize(std::min(name.size(), longest_channel));  // YAML takes keys of up to 1024
        if (taken.count(name) != 0) name += fmt::format("_{:04x}_{:02x}", one.address.first, one.address.second);
        if (!taken.insert(name).second) name += one.rx ? "_out" : "_in";  // the same object in both directions
        taken.insert(name);
        ChannelRow row;
        row.name = name;
        (one.rx ? row.output : row.input) = ObjectAddress{one.address.first, one.address.second};
        row.doc = one.doc;
        to.file.channels.push_back(std::move(row));
    }
}

}  // namespace taktwerk::config
