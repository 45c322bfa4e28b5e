#include "ecat/esi/text_encoding.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <optional>
#include <string_view>

#include <iconv.h>

#include <fmt/format.h>

#include "core/one_line.hpp"

namespace taktwerk::ecat::esi {

namespace {

/// What vendors write, and nothing that runs code of its own (stateful ISO-2022) or is a converter's option ("//TRANSLIT").
constexpr std::array<std::string_view, 20> known_encodings{
    "US-ASCII", "ASCII",   "ISO-8859-1", "ISO-8859-2", "ISO-8859-15", "WINDOWS-1250", "WINDOWS-1251", "WINDOWS-1252", "CP1252",   "GB2312",
    "GBK",      "GB18030", "BIG5",       "SHIFT_JIS",  "EUC-JP",      "EUC-KR",       "UTF-16",       "UTF-16LE",     "UTF-16BE", "UTF-8"};

std::string upper(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return out;
}

/// The registered name of an encoding that people spell otherwise, too ("ISO8859-1", "iso_8859-1", "latin1", "utf8").
std::string registered_name(std::string name) {
    name = upper(name);
    std::replace(name.begin(), name.end(), '_', '-');
    if (name == "SHIFT-JIS") return "SHIFT_JIS";
    if (name == "LATIN1" || name == "LATIN-1") return "ISO-8859-1";
    if (name == "UTF8") return "UTF-8";
    for (const std::string_view family : {"ISO", "WINDOWS"})
        if (name.size() > family.size() && name.rfind(family, 0) == 0 && std::isdigit(static_cast<unsigned char>(name[family.size()])) != 0)
            name.insert(family.size(), "-");
    return name;
}

/// The value of `encoding` in the declaration, by its registered name; empty: there is none.
std::string declared_encoding(std::string_view text) {
    const auto start = text.find("<?xml");
    if (start > 64) return {};  // npos too
    const auto end = text.find("?>", start);
    const auto head = text.substr(start, std::min<std::size_t>(end == std::string_view::npos ? 256 : end - start, 256));
    auto at = head.find("encoding");
    if (at == std::string_view::npos) return {};
    at = head.find_first_of("\"'", at);
    if (at == std::string_view::npos) return {};
    const auto close = head.find(head[at], at + 1);
    return close == std::string_view::npos ? std::string{} : registered_name(std::string{head.substr(at + 1, close - at - 1)});
}

Result<std::string> converted(std::string_view text, const std::string& encoding, const std::string& file) {
    const iconv_t converter = ::iconv_open("UTF-8", encoding.c_str());
    if (converter == reinterpret_cast<iconv_t>(-1))  // NOLINT(performance-no-int-to-ptr)
        return Error{"esi.encoding", file, fmt::format("this computer cannot read the encoding {}", encoding), "save the file as UTF-8"};
    std::string out, in(text);
    std::array<char, 4096> piece{};
    char* from = in.data();
    std::size_t left = in.size();
    std::optional<std::size_t> bad;
    while (left > 0 && !bad) {
        char* to = piece.data();
        std::size_t room = piece.size();
        const auto done = ::iconv(converter, &from, &left, &to, &room);
        out.append(piece.data(), piece.size() - room);
        if (done == static_cast<std::size_t>(-1) && errno != E2BIG) bad = in.size() - left;
    }
    ::iconv_close(converter);
    if (bad)
        return Error{"esi.encoding", file, fmt::format("byte {} is not {}, which the file says that it is written in", *bad, encoding),
                     "save it as UTF-8, or get the file anew from the vendor: it may have been damaged on its way"};
    return out;
}

/// A file that says UTF-8 and has single bytes of Latin-1 in it: frequent, and meant well.
DecodedText as_utf8(std::string_view text) {
    DecodedText out{{}, "UTF-8", {}};
    std::size_t strays = 0, line = 1, first_line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto length = utf8_length(text, at);
        if (text[at] == '\n') ++line;
        if (length > 0) {
            out.utf8.append(text.substr(at, length));
            at += length;
            continue;
        }
        const auto byte = static_cast<unsigned char>(text[at++]);
        out.utf8 += static_cast<char>(0xC0u | (byte >> 6u));
        out.utf8 += static_cast<char>(0x80u | (byte & 0x3Fu));
        if (strays++ == 0) first_line = line;
    }
    if (strays > 0)
        out.remarks.push_back(fmt::format("{} byte{} not UTF-8, the first in line {}: read as ISO-8859-1", strays,
                                          strays == 1 ? " is" : "s are", first_line));
    return out;
}

}  // namespace

Result<DecodedText> decode_text(std::span<const std::byte> bytes, const std::string& file) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());  // NOLINT: bytes as text
    const auto starts = [&](std::string_view mark) { return text.substr(0, mark.size()) == mark; };
    constexpr std::string_view bom8 = "\xEF\xBB\xBF", little("\xFF\xFE", 2), big("\xFE\xFF", 2);
    std::string encoding;
    std::string_view body = text;
    if (starts(bom8)) return as_utf8(text.substr(bom8.size()));
    if (starts(little)) encoding = "UTF-16LE", body = text.substr(2);
    else if (starts(big)) encoding = "UTF-16BE", body = text.substr(2);
    else if (starts(std::string_view("<\0", 2))) encoding = "UTF-16LE";
    else if (starts(std::string_view("\0<", 2))) encoding = "UTF-16BE";
    else encoding = declared_encoding(text);
    // An 8-bit file that calls itself UTF-16 was saved anew by something that left the declaration.
    if (body.size() == text.size() && encoding.rfind("UTF-16", 0) == 0 && text.find('\0') == std::string_view::npos) encoding = "UTF-8";
    if (encoding.empty() || encoding == "UTF-8") return as_utf8(text);
    if (std::find(known_encodings.begin(), known_encodings.end(), encoding) == known_encodings.end())
        return Error{"esi.encoding", file, fmt::format("it is written in '{}', an encoding that is not known here", encoding),
                     "save the file as UTF-8"};
    auto utf8 = converted(body, encoding, file);
    if (!utf8) return utf8.error();
    return DecodedText{std::move(*utf8), encoding, {}};
}

}  // namespace taktwerk::ecat::esi
