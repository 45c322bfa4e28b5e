#include "ecat/wire/sdo_info.hpp"

#include <algorithm>
#include <array>

#include "core/bytes.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat {

namespace {

constexpr unsigned incomplete_bit = 0x80;
constexpr std::size_t object_fixed = 6;  // index, data type, maximum subindex, object code
constexpr std::size_t entry_fixed = 10;  // index, subindex, value info, data type, bits, access
constexpr std::size_t unit_size = 4;

std::size_t bytes_of_bits(std::uint16_t bits) noexcept { return (bits + 7u) / 8u; }

std::string_view text_of(std::span<const std::byte> bytes) noexcept {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT: std::byte and char may alias
}

/// Takes `size` bytes off the front; false when there are fewer.
bool take(std::span<const std::byte>& rest, std::size_t size, std::span<const std::byte>& part) noexcept {
    if (rest.size() < size) return false;
    part = rest.first(size);
    rest = rest.subspan(size);
    return true;
}

/// Appends to a buffer; after the first part that does not fit nothing more is written and size() is 0.
class Appender {
public:
    explicit Appender(std::span<std::byte> out) noexcept : out_(out) {}
    template <class T>
    void number(T value) noexcept {
        if (!fits(sizeof(T))) return;
        store_le<T>(out_, at_, value);
        at_ += sizeof(T);
    }
    void bytes(std::span<const std::byte> data) noexcept {
        if (!fits(data.size())) return;
        std::copy(data.begin(), data.end(), out_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ += data.size();
    }
    void text(std::string_view text) noexcept { bytes(std::as_bytes(std::span{text})); }
    [[nodiscard]] std::size_t size() const noexcept { return good_ ? at_ : 0; }

private:
    bool fits(std::size_t size) noexcept { return good_ = good_ && out_.size() - at_ >= size; }
    std::span<std::byte> out_;
    std::size_t at_ = 0;
    bool good_ = true;
};

std::size_t encode(std::span<std::byte> out, SdoInfoOpcode opcode, std::span<const std::byte> data) noexcept {
    SdoInfoMessage message;
    message.opcode = opcode;
    message.data = data;
    return encode_sdo_info(out, message);
}

struct TypeText {
    std::uint16_t number;
    std::string_view text;
};
constexpr auto type_texts = std::to_array<TypeText>({
    {coe_type::boolean, "BOOLEAN"},
    {coe_type::integer8, "INTEGER8"},
    {coe_type::integer16, "INTEGER16"},
    {coe_type::integer32, "INTEGER32"},
    {coe_type::unsigned8, "UNSIGNED8"},
    {coe_type::unsigned16, "UNSIGNED16"},
    {coe_type::unsigned32, "UNSIGNED32"},
    {coe_type::real32, "REAL32"},
    {coe_type::visible_string, "VISIBLE_STRING"},
    {coe_type::octet_string, "OCTET_STRING"},
    {coe_type::unicode_string, "UNICODE_STRING"},
    {0x000C, "TIME_OF_DAY"},
    {0x000D, "TIME_DIFFERENCE"},
    {coe_type::domain, "DOMAIN"},
    {0x0010, "INTEGER24"},
    {coe_type::real64, "REAL64"},
    {0x0012, "INTEGER40"},
    {0x0013, "INTEGER48"},
    {0x0014, "INTEGER56"},
    {coe_type::integer64, "INTEGER64"},
    {0x0016, "UNSIGNED24"},
    {0x0018, "UNSIGNED40"},
    {0x0019, "UNSIGNED48"},
    {0x001A, "UNSIGNED56"},
    {coe_type::unsigned64, "UNSIGNED64"},
    {coe_type::pdo_mapping, "PDO_MAPPING"},
    {coe_type::identity, "IDENTITY"},
    {0x0025, "COMMAND_PAR"},
    {0x0027, "PDO_PARAMETER"},
    {0x0028, "ENUM"},
    {coe_type::sm_synchronisation, "SM_SYNCHRONISATION"},
    {coe_type::record, "RECORD"},
    {0x002D, "BITARR8"},
    {0x002E, "BITARR16"},
    {0x002F, "BITARR32"},
    {0x0030, "BIT1"},
    {0x0031, "BIT2"},
    {0x0032, "BIT3"},
    {0x0033, "BIT4"},
    {0x0034, "BIT5"},
    {0x0035, "BIT6"},
    {0x0036, "BIT7"},
    {0x0037, "BIT8"},
});

}  // namespace

std::optional<SdoInfoMessage> parse_sdo_info(std::span<const std::byte> payload) noexcept {
    if (payload.size() < sdo_info_header_size || coe_service(payload) != CoeService::sdo_info) return std::nullopt;
    const auto byte = static_cast<unsigned>(payload[2]);
    const unsigned opcode = byte & ~incomplete_bit;
    if (opcode < static_cast<unsigned>(SdoInfoOpcode::list_request) || opcode > static_cast<unsigned>(SdoInfoOpcode::error))
        return std::nullopt;
    SdoInfoMessage message;
    message.opcode = static_cast<SdoInfoOpcode>(opcode);
    message.incomplete = (byte & incomplete_bit) != 0;
    message.fragments_left = load_le<std::uint16_t>(payload, 4);
    message.data = payload.subspan(sdo_info_header_size);
    return message;
}

std::size_t encode_sdo_info(std::span<std::byte> out, const SdoInfoMessage& message) noexcept {
    Appender to{out};
    to.number(static_cast<std::uint16_t>(static_cast<unsigned>(CoeService::sdo_info) << 12));
    to.number(static_cast<std::uint8_t>(static_cast<unsigned>(message.opcode) | (message.incomplete ? incomplete_bit : 0u)));
    to.number(std::uint8_t{0});
    to.number(message.fragments_left);
    to.bytes(message.data);
    return to.size();
}

std::size_t encode_list_request(std::span<std::byte> out, ObjectList list) noexcept {
    std::array<std::byte, 2> data{};
    store_le<std::uint16_t>(data, 0, static_cast<std::uint16_t>(list));
    return encode(out, SdoInfoOpcode::list_request, data);
}

std::size_t encode_object_request(std::span<std::byte> out, std::uint16_t index) noexcept {
    std::array<std::byte, 2> data{};
    store_le<std::uint16_t>(data, 0, index);
    return encode(out, SdoInfoOpcode::object_request, data);
}

std::size_t encode_entry_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint8_t wanted) noexcept {
    std::array<std::byte, 4> data{};
    store_le<std::uint16_t>(data, 0, index);
    data[2] = static_cast<std::byte>(sub);
    data[3] = static_cast<std::byte>(wanted);
    return encode(out, SdoInfoOpcode::entry_request, data);
}

std::size_t encode_info_error(std::span<std::byte> out, std::uint32_t code) noexcept {
    std::array<std::byte, 4> data{};
    store_le<std::uint32_t>(data, 0, code);
    return encode(out, SdoInfoOpcode::error, data);
}

std::uint16_t ObjectListView::operator[](std::size_t n) const noexcept { return load_le<std::uint16_t>(indexes_, 2 * n); }

std::optional<ObjectListView> parse_object_list(std::span<const std::byte> data) noexcept {
    if (data.size() < 2) return std::nullopt;
    return ObjectListView{load_le<std::uint16_t>(data), data.subspan(2)};
}

std::optional<ObjectDescriptionView> parse_object_description(std::span<const std::byte> data) noexcept {
    if (data.size() < object_fixed) return std::nullopt;
    ObjectDescriptionView object;
    object.index = load_le<std::uint16_t>(data, 0);
    object.data_type = load_le<std::uint16_t>(data, 2);
    object.max_sub = static_cast<std::uint8_t>(data[4]);
    object.code = static_cast<std::uint8_t>(data[5]);
    object.name = text_of(data.subspan(object_fixed));
    return object;
}

std::optional<EntryDescriptionView> parse_entry_description(std::span<const std::byte> data) noexcept {
    if (data.size() < entry_fixed) return std::nullopt;
    EntryDescriptionView entry;
    entry.index = load_le<std::uint16_t>(data, 0);
    entry.sub = static_cast<std::uint8_t>(data[2]);
    entry.contains = static_cast<std::uint8_t>(data[3]);
    entry.data_type = load_le<std::uint16_t>(data, 4);
    entry.bits = load_le<std::uint16_t>(data, 6);
    entry.access = load_le<std::uint16_t>(data, 8);
    auto rest = data.subspan(entry_fixed);
    const std::size_t size = bytes_of_bits(entry.bits);
    if ((entry.contains & value_info::unit) != 0) {
        std::span<const std::byte> unit;
        if (!take(rest, unit_size, unit)) return std::nullopt;
        entry.unit = load_le<std::uint32_t>(unit);
    }
    if ((entry.contains & value_info::default_value) != 0 && !take(rest, size, entry.default_value)) return std::nullopt;
    if ((entry.contains & value_info::minimum) != 0 && !take(rest, size, entry.minimum)) return std::nullopt;
    if ((entry.contains & value_info::maximum) != 0 && !take(rest, size, entry.maximum)) return std::nullopt;
    entry.name = text_of(rest);
    return entry;
}

std::optional<std::uint32_t> parse_info_error(std::span<const std::byte> data) noexcept {
    if (data.size() < 4) return std::nullopt;
    return load_le<std::uint32_t>(data);
}

std::size_t encode_object_description(std::span<std::byte> out, const ObjectDescriptionView& object) noexcept {
    Appender to{out};
    to.number(object.index);
    to.number(object.data_type);
    to.number(object.max_sub);
    to.number(object.code);
    to.text(object.name);
    return to.size();
}

std::size_t encode_entry_description(std::span<std::byte> out, const EntryDescriptionView& entry) noexcept {
    const std::size_t size = bytes_of_bits(entry.bits);
    const auto announced = [&](std::uint8_t bit, std::span<const std::byte> value) {
        return (entry.contains & bit) != 0 ? value.size() == size : value.empty();
    };
    if (!announced(value_info::default_value, entry.default_value) || !announced(value_info::minimum, entry.minimum) ||
        !announced(value_info::maximum, entry.maximum) || entry.unit.has_value() != ((entry.contains & value_info::unit) != 0))
        return 0;
    Appender to{out};
    to.number(entry.index);
    to.number(entry.sub);
    to.number(entry.contains);
    to.number(entry.data_type);
    to.number(entry.bits);
    to.number(entry.access);
    if (entry.unit) to.number(*entry.unit);
    to.bytes(entry.default_value);
    to.bytes(entry.minimum);
    to.bytes(entry.maximum);
    to.text(entry.name);
    return to.size();
}

std::string_view coe_type_text(std::uint16_t number) noexcept {
    const auto it = std::find_if(type_texts.begin(), type_texts.end(), [&](const TypeText& t) { return t.number == number; });
    return it == type_texts.end() ? std::string_view{} : it->text;
}

}  // namespace taktwerk::ecat
