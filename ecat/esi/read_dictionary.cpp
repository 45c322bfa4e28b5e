// The dictionary: objects with the data types that they refer to, taken apart into single sub-indices. ETG.2000: Profile/Dictionary.

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "ecat/esi/base_type.hpp"
#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"

namespace taktwerk::ecat::esi {

namespace {

constexpr std::int64_t low64 = std::numeric_limits<std::int64_t>::min(), high64 = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t most_objects = 65'536;  // of one dictionary

struct Flags {
    std::optional<Access> access;
    std::optional<Mappable> mappable;
};

Flags read_flags(const Element& flags) {
    Flags out;
    if (!flags) return out;
    flags.knows({"Access", "Category", "PdoMapping", "Backup", "Setting", "SdoAccess", "Attribute"});
    if (const auto access = flags.child("Access")) {
        access.knows({});  // ReadRestrictions, WriteRestrictions: in which states
        const auto text = access.text();
        if (text == "rw") out.access = Access::rw;
        else if (text == "wo") out.access = Access::wo;
        else out.access = Access::ro;
    }
    if (const auto mapping = flags.child("PdoMapping")) {
        auto text = mapping.text();
        std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(c | 0x20u); });
        const bool rx = text.find('r') != std::string::npos, tx = text.find('t') != std::string::npos;
        out.mappable = rx && tx ? Mappable::both : rx ? Mappable::rx : tx ? Mappable::tx : Mappable::no;
    }
    return out;
}

struct DefaultValue {
    std::optional<std::int64_t> number;
    std::string text;
};

std::int64_t number_of_bytes(const std::vector<std::byte>& bytes, bool is_signed) {
    std::uint64_t value = 0;
    for (std::size_t n = bytes.size(); n-- > 0;) value = value << 8u | std::to_integer<std::uint64_t>(bytes[n]);
    if (is_signed && !bytes.empty() && bytes.size() < 8 && (std::to_integer<unsigned>(bytes.back()) & 0x80u) != 0)
        value |= ~std::uint64_t{0} << (8 * bytes.size());
    return static_cast<std::int64_t>(value);
}

/// "...Data" is bytes as on the wire, "...Value" a number, "...String" text.
std::optional<std::int64_t> number_in_info(const Element& info, const char* data, const char* value, std::optional<DataType> type) {
    if (!type || *type == DataType::STRING || *type == DataType::REAL32 || *type == DataType::REAL64) return std::nullopt;
    if (const auto bytes = info.child(data)) {
        const auto parsed = parse_bytes(bytes.text());
        if (parsed && !parsed->empty() && parsed->size() <= 8) return number_of_bytes(*parsed, is_signed(*type));
        if (!parsed)
            bytes.problem("esi.bytes", fmt::format("{} is '{}', which are no bytes in hexadecimal", data, bytes.text().substr(0, 40)),
                          "write pairs of digits, the least byte first: 0A00");
        return std::nullopt;
    }
    return info.number_of(value, low64, high64);
}

/// Bytes of a text up to its first zero, without what is no printable ASCII.
std::string text_of_bytes(const std::vector<std::byte>& bytes) {
    std::string out;
    for (const auto byte : bytes) {
        const auto c = std::to_integer<unsigned char>(byte);
        if (c == 0) break;
        if (c >= 0x20 && c < 0x7F) out += static_cast<char>(c);
    }
    return out;
}

void apply_info(const Element& info, EsiObject& object) {
    if (!info) return;
    info.knows({"DefaultString", "DefaultValue", "DefaultData", "MinValue", "MinData", "MaxValue", "MaxData", "Unit", "SubItem"});
    object.value = number_in_info(info, "DefaultData", "DefaultValue", object.basic);
    object.minimum = number_in_info(info, "MinData", "MinValue", object.basic);
    object.maximum = number_in_info(info, "MaxData", "MaxValue", object.basic);
    object.unit = info.text_of("Unit");
    if (object.basic == DataType::STRING) {
        object.text = info.text_of("DefaultString");
        if (const auto bytes = parse_bytes(info.text_of("DefaultData")); bytes && object.text.empty()) object.text = text_of_bytes(*bytes);
    }
}

/// The types that a file defines itself.
class TypeTable {
public:
    explicit TypeTable(const Element& types) {
        if (!types) return;
        for (const auto& type : types.children("DataType")) {
            type.knows({"Name", "BaseType", "BitSize", "SubItem", "ArrayInfo", "EnumInfo", "Index"});
            types_.emplace(type.text_of("Name"), type);
        }
    }
    [[nodiscard]] const Element* find(const std::string& name) const {
        const auto found = types_.find(name);
        return found == types_.end() ? nullptr : &found->second;
    }
    /// Through types that only give another one a name, with what its values mean.
    [[nodiscard]] std::optional<DataType> basic(std::string name, std::string* meaning = nullptr) const {
        for (int hops = 0; hops < 8; ++hops) {
            if (const auto known = basic_type(name)) return known;
            const auto* type = find(name);
            if (type == nullptr || type->child("SubItem") || type->child("ArrayInfo")) return std::nullopt;
            if (meaning != nullptr && meaning->empty()) *meaning = meaning_of(*type);
            name = type->text_of("BaseType");
        }
        return std::nullopt;
    }

private:
    static std::string meaning_of(const Element& type) {
        std::string out;
        for (const auto& one : type.children("EnumInfo")) {
            one.knows({"Text", "Enum"});
            out += fmt::format("{}{} {}", out.empty() ? "" : " · ", one.text_of("Enum"), one.in_english("Text"));
        }
        return out;
    }

    std::map<std::string, Element> types_;
};

class ObjectReader {
public:
    ObjectReader(const TypeTable& types, std::vector<EsiObject>& out) : types_(types), out_(out) {}

    void read(const Element& object) {
        if (out_.size() >= most_objects || items_ >= most_objects) return;
        object.knows({"Index", "Name", "Type", "BitSize", "Info", "Flags", "Comment"});
        const auto index = object.required_number_of("Index", 0, u16);
        if (!index) return;
        EsiObject base;
        base.index = static_cast<std::uint16_t>(*index);
        base.name = object.in_english("Name");
        base.type = object.text_of("Type");
        base.bits = static_cast<std::uint32_t>(object.number_of("BitSize", 0, u32).value_or(0));
        const auto flags = read_flags(object.child("Flags"));
        base.access = flags.access.value_or(Access::ro);
        base.mappable = flags.mappable.value_or(Mappable::no);
        const auto first = out_.size();
        names_.clear();
        const auto* type = types_.find(base.type);
        const auto info = object.child("Info");
        if (type != nullptr && type->child("SubItem")) {
            for (const auto& item : type->children("SubItem")) read_item(item, base);
        } else {
            base.basic = types_.basic(base.type, &base.meaning);
            apply_info(info, base);
            add(base, {});
        }
        apply_sub_infos(info, first);
    }

private:
    /// `name` is what defaults call it.
    void add(EsiObject object, std::string name) {
        if (out_.size() >= most_objects) return;
        out_.push_back(std::move(object));
        names_.push_back(std::move(name));
    }

    /// A sub-index of a record, or all elements of its array.
    void read_item(const Element& item, const EsiObject& base) {
        if (++items_ > most_objects) return;
        item.knows({"SubIdx", "Name", "DisplayName", "Type", "BitSize", "BitOffs", "Flags", "Comment"});
        EsiObject sub = base;
        const auto flags = read_flags(item.child("Flags"));
        if (flags.access) sub.access = *flags.access;
        if (flags.mappable) sub.mappable = *flags.mappable;
        sub.type = item.text_of("Type");
        sub.bits = static_cast<std::uint32_t>(item.number_of("BitSize", 0, u32).value_or(0));
        auto name = item.in_english("DisplayName");
        if (name.empty()) name = item.in_english("Name");
        const auto* type = types_.find(sub.type);
        if (!item.child("SubIdx") && type != nullptr && type->child("ArrayInfo")) {
            read_elements(*type, sub, base.name);
            return;
        }
        sub.sub = static_cast<std::uint8_t>(item.number_of("SubIdx", 0, u8).value_or(0));
        sub.basic = types_.basic(sub.type, &sub.meaning);
        sub.name = sub.sub == 0 || base.name.empty() ? (base.name.empty() ? name : base.name) : base.name + ": " + name;
        if (sub.sub == 0 && !base.name.empty()) sub.name = base.name + ": number of entries";
        add(std::move(sub), item.in_english("Name"));
    }

    void read_elements(const Element& type, const EsiObject& like, const std::string& name) {
        const auto range = type.child("ArrayInfo");
        range.knows({"LBound", "Elements"});
        const auto low = range.number_of("LBound", 0, u8).value_or(1), count = range.number_of("Elements", 0, u8).value_or(0);
        const auto base = type.text_of("BaseType");
        for (std::int64_t n = 0; n < count && low + n <= u8; ++n) {
            EsiObject one = like;
            one.sub = static_cast<std::uint8_t>(low + n);
            one.type = base;
            one.bits = count > 0 ? like.bits / static_cast<std::uint32_t>(count) : 0;
            one.basic = types_.basic(base, &one.meaning);
            one.name = fmt::format("{}: {}", name, low + n);
            add(std::move(one), fmt::format("SubIndex {:03}", low + n));
        }
    }

    /// Defaults stand in the order of the sub-indices, elements of arrays each by itself; where some are left out, the name says which.
    void apply_sub_infos(const Element& info, std::size_t first) {
        if (!info) return;
        const auto items = info.children("SubItem");
        const bool complete = items.size() == names_.size();
        std::size_t next = 0;
        for (const auto& item : items) {
            item.knows({"Name", "Info"});
            auto n = next;
            const auto name = item.in_english("Name");
            while (!complete && n < names_.size() && names_[n] != name) ++n;
            if (n >= names_.size()) {
                item.problem("esi.dictionary", fmt::format("its type has no sub-index '{}' behind those before it", name.substr(0, 60)),
                             "compare the defaults of this object with the manual");
                continue;
            }
            apply_info(item.child("Info"), out_[first + n]);
            next = n + 1;
        }
    }

    const TypeTable& types_;
    std::vector<EsiObject>& out_;
    std::vector<std::string> names_;  ///< of the sub-indices of the object that is read
    std::size_t items_ = 0;           ///< sub-indices that were looked at: types may be used by any number of objects
};

}  // namespace

void read_profile(const Element& profile, std::vector<unsigned>& numbers, std::vector<EsiObject>& objects) {
    profile.knows({"ProfileNo", "AddInfo", "ChannelInfo", "ChannelCount", "Dictionary"});
    if (const auto channel = profile.child("ChannelInfo")) {
        channel.knows({"ProfileNo", "AddInfo", "DisplayName"});
        if (const auto number = channel.number_of("ProfileNo", 0, u32)) numbers.push_back(static_cast<unsigned>(*number & u16));
    }
    if (const auto number = profile.number_of("ProfileNo", 0, u32)) numbers.push_back(static_cast<unsigned>(*number & u16));
    const auto dictionary = profile.child("Dictionary");
    if (!dictionary) return;
    dictionary.knows({"DataTypes", "Objects"});
    const TypeTable types(dictionary.child("DataTypes"));
    ObjectReader reader(types, objects);
    if (const auto all = dictionary.child("Objects"))
        for (const auto& object : all.children("Object")) reader.read(object);
}

}  // namespace taktwerk::ecat::esi
