#include "hmi_bridge/views/image_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace taktwerk::hmi {

namespace {

Error wrong(std::string code, std::string what, std::string remedy) { return {std::move(code), "", std::move(what), std::move(remedy)}; }

std::string lower_case(std::string_view text) {
    std::string out(text);
    for (auto& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// " onload=" in a tag, outside of its quoted values: an attribute that runs.
bool has_handler(std::string_view text) {
    bool in_tag = false;
    char quote = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (quote != 0) {
            if (c == quote) quote = 0;
        } else if (!in_tag) {
            in_tag = c == '<';
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '>') {
            in_tag = false;
        } else if (c == 'o' && text.substr(at, 2) == "on" &&
                   (is_space(text[at - 1]) || text[at - 1] == '/' || text[at - 1] == '"' || text[at - 1] == '\'')) {
            std::size_t end = at + 2;
            while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0) ++end;
            while (end < text.size() && is_space(text[end])) ++end;
            if (end < text.size() && text[end] == '=') return true;
        }
    }
    return false;
}

/// The first address in it that is neither a part of the picture itself (`#part`) nor a picture in it (`data:image/`).
std::optional<std::string> foreign_address(std::string_view text) {
    for (const std::string_view key : {"href", "url(", "src"}) {
        for (std::size_t at = 0; (at = text.find(key, at)) != std::string_view::npos;) {
            at += key.size();
            std::size_t begin = at;
            if (key != "url(") {
                while (begin < text.size() && is_space(text[begin])) ++begin;
                if (begin >= text.size() || text[begin] != '=') continue;
                ++begin;
            }
            while (begin < text.size() && (is_space(text[begin]) || text[begin] == '"' || text[begin] == '\'')) ++begin;
            const auto address = text.substr(begin, 80);
            if (address.starts_with('#') || address.starts_with("data:image/")) continue;
            return std::string(address.substr(0, address.find_first_of("\"') >")));
        }
    }
    return std::nullopt;
}

std::optional<Error> active_part(std::string_view svg) {
    const auto text = lower_case(svg);
    constexpr std::array<std::string_view, 10> forbidden{"<script",  "<foreignobject", "<iframe",  "<embed",           "<object",
                                                         "<!entity", "<!doctype",      "<handler", "<?xml-stylesheet", "@import"};
    for (const auto part : forbidden)
        if (text.find(part) != std::string::npos)
            return wrong("view.image_active", fmt::format("it contains `{}`, which draws nothing", part), "save it as a plain SVG");
    if (text.find("javascript:") != std::string::npos || has_handler(text))
        return wrong("view.image_active", "it contains script", "save it as a plain SVG");
    if (const auto address = foreign_address(text))
        return wrong("view.image_active", fmt::format("it fetches '{}' from elsewhere", *address),
                     "put what it shows into the file itself");
    return std::nullopt;
}

std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    return text;
}

}  // namespace

Result<ImageFile> judge_image(std::string bytes) {
    const std::string_view all(bytes);
    if (all.size() > largest_image)
        return wrong("view.image_size", fmt::format("it has {} bytes, at most {} are taken", all.size(), largest_image), "make it smaller");
    if (all.starts_with("\x89PNG\r\n\x1a\n")) return ImageFile{"image/png", std::move(bytes)};
    if (all.starts_with("\xFF\xD8\xFF")) return ImageFile{"image/jpeg", std::move(bytes)};
    const auto text = without_mark(all);
    if ((text.starts_with("<?xml") || text.starts_with("<svg") || text.starts_with("<!--")) &&
        text.find("<svg") != std::string_view::npos) {
        if (text.find('\0') != std::string_view::npos) return wrong("view.image_type", "it is no text in UTF-8", "save it as a plain SVG");
        if (auto error = active_part(text)) return *error;
        return ImageFile{"image/svg+xml", std::move(bytes)};
    }
    return wrong("view.image_type", "it is neither PNG nor JPEG nor SVG, by its first bytes", "convert it to one of them");
}

Result<ImageFile> read_image(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        return wrong("view.no_image", fmt::format("there is no file {}", path), "put it beside the machine file, or correct the name");
    if (!std::filesystem::is_regular_file(status))
        return wrong("view.no_image", fmt::format("{} is no file", path), "name a PNG, JPEG or SVG file");
    const auto size = std::filesystem::file_size(path, error);
    if (!error && size > largest_image)
        return wrong("view.image_size", fmt::format("it has {} bytes, at most {} are taken", size, largest_image), "make it smaller");
    std::ifstream file(path, std::ios::binary);
    std::string bytes(std::min<std::size_t>(largest_image + 1, static_cast<std::size_t>(size) + 1), '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file && !file.eof()) return wrong("view.no_image", fmt::format("{} cannot be read", path), "see its permissions");
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return judge_image(std::move(bytes));
}

}  // namespace taktwerk::hmi
