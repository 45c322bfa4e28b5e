#include "hmi_bridge/lcm_types/message_reader.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

constexpr int deepest = 16;

std::size_t size_of(std::string_view primitive) {
    if (primitive == "int16_t") return 2;
    if (primitive == "int32_t" || primitive == "float") return 4;
    if (primitive == "int64_t" || primitive == "double") return 8;
    if (primitive == "string") return 5;  // at least: a length and a NUL
    return 1;
}

class Reader {
public:
    Reader(const TypeCatalog& catalog, std::span<const std::byte> bytes) : catalog_(catalog), bytes_(bytes) {}

    /// `out`: nullptr where it is only checked.
    bool read_struct(const LcmType& type, Json* out, int depth) {
        if (depth > deepest) return wrong(type.name, "structs stand too deep in one another");
        std::map<std::string_view, std::int64_t> counts;  // whole fields so far: a later array may have its size from one
        for (const auto& field : type.fields) {
            Json value;
            last_whole_.reset();
            if (!read_dimension(field, 0, counts, out != nullptr ? &value : nullptr, depth)) return false;
            if (field.dimensions.empty() && is_primitive(field.type) && last_whole_) counts[field.name] = *last_whole_;
            if (out != nullptr) (*out)[field.name] = std::move(value);
        }
        return true;
    }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    void skip(std::size_t size) { at_ += size; }
    [[nodiscard]] const std::string& problem() const { return problem_; }

private:
    bool wrong(std::string_view where, std::string_view what) {
        if (problem_.empty()) problem_ = fmt::format("{}: {}", where, what);
        return false;
    }
    bool read_dimension(const LcmField& field, std::size_t level, const std::map<std::string_view, std::int64_t>& counts, Json* out,
                        int depth) {
        if (++values_ > most_values) return wrong(field.name, "more values than anybody looks at");
        if (level == field.dimensions.size()) return read_value(field, out, depth);
        const auto& dimension = field.dimensions[level];
        auto count = dimension.fixed;
        if (count < 0) {
            const auto found = counts.find(dimension.size);
            if (found == counts.end()) return wrong(field.name, "its size is no whole number before it");
            count = found->second;
        }
        const bool innermost = level + 1 == field.dimensions.size();
        const std::size_t least = innermost && is_primitive(field.type) ? size_of(field.type) : 0;
        if (count < 0) return wrong(field.name, fmt::format("a count of {}", count));
        // Held against what is left before anything is made; what takes no byte is bounded by the number of values.
        if (static_cast<std::uint64_t>(count) > (least > 0 ? left() / least : most_values))
            return wrong(field.name, fmt::format("a count of {}, and {} bytes are left", count, left()));
        if (innermost && field.type == "byte") return read_bytes(static_cast<std::size_t>(count), out);
        if (out != nullptr) *out = Json::array();
        for (std::int64_t i = 0; i < count; ++i) {
            Json element;
            if (!read_dimension(field, level + 1, counts, out != nullptr ? &element : nullptr, depth)) return false;
            if (out != nullptr) out->push_back(std::move(element));
        }
        return true;
    }
    std::uint64_t big_endian(std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) value = value << 8 | std::to_integer<std::uint64_t>(bytes_[at_ + i]);
        at_ += size;
        return value;
    }
    bool read_value(const LcmField& field, Json* out, int depth) {
        if (!is_primitive(field.type)) {
            const auto* type = catalog_.find(field.type);
            if (type == nullptr) return wrong(field.name, fmt::format("the type {} is not known", field.type));
            if (out != nullptr) *out = Json::object();
            return read_struct(*type, out, depth + 1);
        }
        if (field.type == "string") return read_text(field, out);
        const auto size = size_of(field.type);
        if (left() < size) return wrong(field.name, "the message ends in it");
        const auto raw = big_endian(size);
        if (field.type == "double" || field.type == "float") {
            const double number =
                size == 8 ? std::bit_cast<double>(raw) : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
            if (out != nullptr) *out = number;
            return true;
        }
        const unsigned unused = 64 - 8 * static_cast<unsigned>(size);
        const auto whole = field.type == "byte" ? static_cast<std::int64_t>(raw) : static_cast<std::int64_t>(raw << unused) >> unused;
        last_whole_ = whole;
        if (out != nullptr) *out = field.type == "boolean" ? Json(whole != 0) : Json(whole);
        return true;
    }
    bool read_text(const LcmField& field, Json* out) {
        if (left() < 4) return wrong(field.name, "the message ends in it");
        const auto length = static_cast<std::int32_t>(big_endian(4));
        if (length < 1 || static_cast<std::size_t>(length) > left())
            return wrong(field.name, fmt::format("a text of {} bytes, and {} are left", length, left()));
        const auto size = static_cast<std::size_t>(length);
        if (bytes_[at_ + size - 1] != std::byte{0}) return wrong(field.name, "a text without its NUL");
        if (out != nullptr) *out = std::string(reinterpret_cast<const char*>(bytes_.data() + at_), size - 1);
        at_ += size;
        return true;
    }
    bool read_bytes(std::size_t count, Json* out) {
        const auto taken = bytes_.subspan(at_, count);
        at_ += count;
        if (out == nullptr) return true;
        const auto end = std::find(taken.begin(), taken.end(), std::byte{0});
        const bool text = std::all_of(end, taken.end(), [](std::byte b) { return b == std::byte{0}; }) &&
                          std::all_of(taken.begin(), end, [](std::byte b) { return b >= std::byte{0x20} && b != std::byte{0x7F}; });
        std::string shown;
        if (text) shown.assign(reinterpret_cast<const char*>(taken.data()), static_cast<std::size_t>(end - taken.begin()));
        else
            for (const auto b : taken) shown += fmt::format("{:02x}", std::to_integer<int>(b));
        *out = shown;
        return true;
    }

    const TypeCatalog& catalog_;
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0, values_ = 0;
    std::optional<std::int64_t> last_whole_;
    std::string problem_;
};

Result<void> look_into(const TypeCatalog& catalog, const LcmType& type, std::span<const std::byte> message, Json* out) {
    const auto bad = [&](const std::string& what) {
        return Error{"lcm.bad_message", type.name, what, "Whoever publishes it has another version of the type, or means harm."};
    };
    const auto wanted = catalog.fingerprint(type);
    if (!wanted || fingerprint_of(message) != wanted)
        return Error{"lcm.not_this_type", type.name, "the message has another fingerprint", "Look with the .lcm files of its publisher."};
    if (message.size() > longest_message) return bad(fmt::format("{} bytes are more than anybody looks into", message.size()));
    Reader reader(catalog, message);
    reader.skip(sizeof *wanted);
    if (!reader.read_struct(type, out, 0)) return bad(reader.problem());
    if (reader.left() > 0) return bad(fmt::format("{} bytes stand behind it", reader.left()));
    return {};
}

}  // namespace

std::optional<std::uint64_t> fingerprint_of(std::span<const std::byte> message) noexcept {
    if (message.size() < sizeof(std::uint64_t)) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i) value = value << 8 | std::to_integer<std::uint64_t>(message[i]);
    return value;
}

Result<void> check_message(const TypeCatalog& catalog, const LcmType& type, std::span<const std::byte> message) {
    return look_into(catalog, type, message, nullptr);
}

Result<Json> read_message(const TypeCatalog& catalog, const LcmType& type, std::span<const std::byte> message) {
    Json out = Json::object();
    if (auto ok = look_into(catalog, type, message, &out); !ok) return ok.error();
    return out;
}

}  // namespace taktwerk::hmi
