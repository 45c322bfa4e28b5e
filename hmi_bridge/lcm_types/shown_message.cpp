#include "hmi_bridge/lcm_types/shown_message.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view since_1970 = "us since 1970";
constexpr std::array<std::string_view, 17> units{"us",     "ns", "ms",   "s",   "u",     "u/s", "u/s2", "u/s3", "unit",
                                                 "unit/s", "mm", "mm/s", "deg", "deg/s", "Hz",  "%",    "ppb"};
constexpr std::size_t longest_array = 64;  // elements of a line

std::string one_line(std::string_view text) {
    std::string out;
    for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    return out;
}

std::string scalar(const Json& value) {
    if (value.is_string()) return one_line(value.get_ref<const std::string&>());
    if (value.is_number_float()) return fmt::format("{:.10g}", value.get<double>());
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string calendar(std::int64_t utime) {
    const std::time_t seconds = utime / 1'000'000;
    std::tm parts{};
    if (utime < 0 || ::gmtime_r(&seconds, &parts) == nullptr) return {};
    return fmt::format(" ({:04}-{:02}-{:02} {:02}:{:02}:{:02}.{:06} UTC)", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                       parts.tm_hour, parts.tm_min, parts.tm_sec, utime % 1'000'000);
}

bool of_a_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// "machine_state_v1_t PHASE_..." or "PHASE_...": the constants meant, by their first letters.
struct Meant {
    const LcmType* type = nullptr;
    std::string prefix;
};
Meant constants_meant(const TypeCatalog& catalog, const LcmType& type, std::string_view comment) {
    const auto dots = comment.find("_...");
    if (dots == std::string_view::npos) return {};
    auto begin = dots;
    while (begin > 0 && of_a_name(comment[begin - 1])) --begin;
    Meant meant{&type, std::string(comment.substr(begin, dots + 1 - begin))};
    if (begin < 2 || comment[begin - 1] != ' ' || !comment.substr(0, begin - 1).ends_with("_t")) return meant;
    auto before = begin - 1;
    while (before > 0 && of_a_name(comment[before - 1])) --before;
    const auto other = std::string(comment.substr(before, begin - 1 - before));
    if (const auto* found = catalog.find(type.package.empty() ? other : type.package + "." + other)) meant.type = found;
    return meant;
}

class Lines {
public:
    explicit Lines(const TypeCatalog& catalog) : catalog_(catalog) {}

    void add(const LcmType& type, const Json& message, const std::string& path) {
        for (const auto& field : type.fields) {
            const auto found = message.find(field.name);
            if (found == message.end()) continue;
            const auto* part = is_primitive(field.type) ? nullptr : catalog_.find(field.type);
            if (part != nullptr) add_part(*part, *found, path + field.name);
            else lines.push_back(fmt::format("{}{}: {}", path, field.name, value(type, field, message, *found)));
        }
    }
    std::vector<std::string> lines;

private:
    void add_part(const LcmType& part, const Json& value, const std::string& path) {
        if (value.is_object()) return add(part, value, path + ".");
        if (value.is_array())
            for (std::size_t i = 0; i < value.size(); ++i) add_part(part, value[i], fmt::format("{}[{}]", path, i));
    }
    [[nodiscard]] std::string value(const LcmType& type, const LcmField& field, const Json& message, const Json& found) const {
        auto unit = found.is_string() ? std::string{} : unit_in(field.comment);  // a text may be about units
        if (unit == since_1970)
            return found.is_number_integer() ? scalar(found) + " us" + calendar(found.get<std::int64_t>()) : scalar(found);
        if (const auto own = message.find("unit"); own != message.end() && own->is_string()) {
            const auto& word = own->get_ref<const std::string&>();
            if (unit == "u" || unit.starts_with("u/")) unit.replace(0, 1, one_line(word));
            if (unit == "unit" || unit.starts_with("unit/")) unit.replace(0, 4, one_line(word));
        }
        std::string text;
        if (found.is_array()) {
            for (std::size_t i = 0; i < found.size() && i < longest_array; ++i)
                text += (i > 0 ? ", " : "") + (found[i].is_array() ? found[i].dump(-1, ' ', false, Json::error_handler_t::replace)
                                                                   : element(type, field, found[i]));
            if (found.size() > longest_array) text += fmt::format(", ... {} in all", found.size());
            text = "[" + text + "]";
        } else {
            text = element(type, field, found);
        }
        return unit.empty() ? text : text + " " + unit;
    }
    [[nodiscard]] std::string element(const LcmType& type, const LcmField& field, const Json& value) const {
        auto text = scalar(value);
        if (!value.is_number_integer() || field.comment.find("_...") == std::string::npos) return text;
        const auto meant = constants_meant(catalog_, type, field.comment);
        for (const auto& constant : meant.type->constants)
            if (constant.name.starts_with(meant.prefix) && constant.value == value.get<std::int64_t>())
                return text + " " + constant.name.substr(meant.prefix.size());
        return text;
    }

    const TypeCatalog& catalog_;
};

}  // namespace

std::string unit_in(std::string_view comment) {
    const auto first = comment.substr(0, comment.find_first_of(",;:."));
    if (first.starts_with(since_1970)) return std::string(since_1970);
    return std::find(units.begin(), units.end(), first) != units.end() ? std::string(first) : std::string{};
}

std::vector<std::string> shown_lines(const TypeCatalog& catalog, const LcmType& type, const Json& message) {
    Lines lines(catalog);
    lines.add(type, message, "");
    return std::move(lines.lines);
}

}  // namespace taktwerk::hmi
