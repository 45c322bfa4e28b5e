#include "hmi_bridge/lcm_types/type_catalog.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::hmi {
namespace {

constexpr std::size_t most_nested = 16;     // structs in structs
constexpr std::size_t most_parts = 10'000;  // of one type, over all

/// lcm-gen's own (lcmgen.c): shifts of a signed number, and a char that may be negative.
std::int64_t mixed(std::int64_t v, signed char c) {
    const auto shifted = static_cast<std::uint64_t>(v) << 8 ^ static_cast<std::uint64_t>(v >> 55);
    return static_cast<std::int64_t>(shifted + static_cast<std::uint64_t>(static_cast<std::int64_t>(c)));
}

std::int64_t mixed(std::int64_t v, std::string_view text) {
    v = mixed(v, static_cast<signed char>(text.size()));
    for (const char c : text) v = mixed(v, static_cast<signed char>(c));
    return v;
}

}  // namespace

Result<void> TypeCatalog::add(std::string_view text, const std::string& file) {
    auto types = parse_lcm_text(text, file);
    if (!types) return types.error();
    for (auto& type : *types) {
        auto name = type.full_name();
        types_.insert_or_assign(std::move(name), std::move(type));
    }
    by_fingerprint_.clear();
    return {};
}

const LcmType* TypeCatalog::find(std::string_view full_name) const {
    const auto found = types_.find(full_name);
    return found == types_.end() ? nullptr : &found->second;
}

const LcmType* TypeCatalog::find(std::uint64_t wanted) const {
    if (by_fingerprint_.empty())
        for (const auto& [name, type] : types_)
            if (const auto made = fingerprint(type)) by_fingerprint_.emplace(*made, &type);
    const auto found = by_fingerprint_.find(wanted);
    return found == by_fingerprint_.end() ? nullptr : found->second;
}

std::optional<std::uint64_t> TypeCatalog::hash(const LcmType& type, std::vector<const LcmType*>& above, std::size_t& parts_left) const {
    if (std::find(above.begin(), above.end(), &type) != above.end()) return 0;  // it holds itself
    if (above.size() >= most_nested || parts_left == 0) return std::nullopt;
    --parts_left;
    std::int64_t own = 0x12345678;
    std::uint64_t parts = 0;
    above.push_back(&type);
    for (const auto& field : type.fields) {
        own = mixed(own, field.name);
        if (is_primitive(field.type)) own = mixed(own, field.type);
        own = mixed(own, static_cast<signed char>(field.dimensions.size()));
        for (const auto& dimension : field.dimensions) {
            own = mixed(own, static_cast<signed char>(dimension.fixed < 0 ? 1 : 0));
            own = mixed(own, dimension.size);
        }
        if (is_primitive(field.type)) continue;
        const auto* part = find(field.type);
        const auto of_part = part != nullptr ? hash(*part, above, parts_left) : std::nullopt;
        if (!of_part) return std::nullopt;
        parts += *of_part;
    }
    above.pop_back();
    const auto sum = static_cast<std::uint64_t>(own) + parts;
    return (sum << 1) + (sum >> 63);
}

std::optional<std::uint64_t> TypeCatalog::fingerprint(const LcmType& type) const {
    std::vector<const LcmType*> above;
    std::size_t parts_left = most_parts;
    return hash(type, above, parts_left);
}

}  // namespace taktwerk::hmi
