#include "config/reading/document.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "config/reading/files_read.hpp"

namespace taktwerk::config {

namespace {

Position position_at(std::string_view text, std::size_t offset) {
    Position at{1, 1};
    for (std::size_t i = 0; i < offset; ++i) {
        if (text[i] == '\n') at = {at.line + 1, 1};
        else ++at.column;
    }
    return at;
}

/// Length of the UTF-8 sequence at `i`, 0 when it is none (also for overlong forms, surrogates and control characters).
std::size_t sequence_length(std::string_view text, std::size_t i) noexcept {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned first = byte(i);
    if (first < 0x20) return first == '\n' || first == '\r' || first == '\t' ? 1 : 0;
    if (first < 0x80) return first == 0x7F ? 0 : 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
    if (length == 0 || first > 0xF4 || i + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(i + k) & 0xC0u) != 0x80) return 0;
    const unsigned second = byte(i + 1);
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90) ||
        (first == 0xF4 && second > 0x8F))
        return 0;
    return length;
}

std::optional<std::size_t> first_bad_byte(std::string_view text) noexcept {
    for (std::size_t i = 0; i < text.size();) {
        const auto length = sequence_length(text, i);
        if (length == 0) return i;
        i += length;
    }
    return std::nullopt;
}

/// yaml-cpp's own words for a tab are hard to read; a tab in the indentation is the usual accident.
std::optional<Position> tab_in_indentation(std::string_view text, int line) {
    int n = 1;
    std::size_t at = 0;
    while (n < line && at != std::string_view::npos) {
        at = text.find('\n', at);
        if (at != std::string_view::npos) ++at, ++n;
    }
    if (at == std::string_view::npos) return std::nullopt;
    for (std::size_t i = at; i < text.size() && (text[i] == ' ' || text[i] == '\t'); ++i)
        if (text[i] == '\t') return Position{line, static_cast<int>(i - at) + 1};
    return std::nullopt;
}

/// yaml-cpp takes a quote that is never closed for one that is closed at the end of the file, and all between them for one text. That can be the last quoted
/// text alone. `last`: where that begins; nothing: it is closed.
std::optional<Position> open_quote(std::string_view text, std::optional<Position> last) {
    if (!last) return std::nullopt;
    std::size_t at = 0;
    for (int line = 1; line < last->line && at != std::string_view::npos; ++line)
        if (at = text.find('\n', at); at != std::string_view::npos) ++at;
    if (at == std::string_view::npos) return std::nullopt;
    at = text.find_first_of("\"'|>", at + static_cast<std::size_t>(last->column) - 1);  // behind an anchor
    if (at == std::string_view::npos || text[at] == '|' || text[at] == '>') return std::nullopt;
    const char quote = text[at];
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (quote == '"' && text[i] == '\\') ++i;
        else if (text[i] == quote && quote == '\'' && i + 1 < text.size() && text[i + 1] == quote) ++i;
        else if (text[i] == quote) return std::nullopt;
    }
    return position_at(text, at);
}

/// Only says where documents begin.
class DocumentStarts final : public YAML::EventHandler {
public:
    void OnDocumentStart(const YAML::Mark& mark) override { at = {mark.line + 1, mark.column + 1}; }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}
    Position at;
};

/// YAML::LoadAll never returns on a stray `,` outside brackets: each of its documents ends where it began. Two are enough to know.
std::optional<Position> second_document(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentStarts starts;
    if (!parser.HandleNextDocument(starts) || !parser.HandleNextDocument(starts)) return std::nullopt;
    return starts.at;
}

/// yaml-cpp's words are those of its parser. Where: the next thing that it could not fit in, often a line further on.
struct SyntaxWords {
    std::string_view parsers, what, remedy;
};
constexpr std::array<SyntaxWords, 6> syntax_words{{
    {"illegal map value", "a `:` stands where no key can be",
     "is the `:`, or the blank behind it, missing in the line in front? a text with `: ` in it wants quotes"},
    {"end of map not found", "this line begins in a column in which none of the lines above it does",
     "begin all keys of a section in the same column"},
    {"end of sequence not found", "this line begins in a column in which none of the lines above it does",
     "begin all `-` of a list in the same column"},
    {"end of map flow not found", "a `{` in front of this is not closed, or a comma is missing behind it",
     "close it with `}`, and part its keys by commas"},
    {"end of sequence flow not found", "a `[` in front of this is not closed, or a comma is missing behind it",
     "close it with `]`, and part its values by commas"},
    {"the referenced anchor is not defined", "there is no anchor `&name` for this `*name`",
     "write the anchor in front of it, or correct the name"},
}};

class Converter {
public:
    explicit Converter(Document& document) : document_(document) {}

    Node convert(const YAML::Node& from, Position fallback, int depth) {
        Node node;
        const auto mark = from.Mark();
        // Of a value that is not there the mark is that of whatever comes next.
        node.at = mark.is_null() || mark.line < 0 || (from.IsNull() && depth > 0) ? fallback : Position{mark.line + 1, mark.column + 1};
        if (full_) return node;
        if (++count_ > max_nodes) {
            full_ = true;
            problem("config.too_many_nodes", node.at, fmt::format("the file expands to more than {} values", max_nodes),
                    "use fewer anchors and aliases");
            return node;
        }
        if (depth > max_depth) {
            full_ = true;
            problem("config.too_deep", node.at, fmt::format("values are nested more than {} levels deep", max_depth),
                    "check brackets and indentation");
            return node;
        }
        if (from.IsScalar()) {
            node.kind = Node::Kind::scalar;
            node.text = from.Scalar();
            bytes_ += node.text.size();
            if (bytes_ > 4 * max_file_bytes) {
                full_ = true;
                problem("config.too_many_nodes", node.at, "aliases multiply the file beyond 4 MiB", "use fewer anchors and aliases");
                return node;
            }
            node.quoted = from.Tag() == "!";
            if (node.quoted &&
                (!last_quoted_ || std::pair(node.at.line, node.at.column) > std::pair(last_quoted_->line, last_quoted_->column)))
                last_quoted_ = node.at;
        } else if (from.IsSequence()) {
            node.kind = Node::Kind::list;
            for (const auto& item : from) node.items.push_back(convert(item, node.at, depth + 1));
        } else if (from.IsMap()) {
            node.kind = Node::Kind::map;
            for (const auto& pair : from) add_entry(node, pair.first, pair.second, depth);
        }
        return node;
    }

    [[nodiscard]] std::optional<Position> last_quoted() const noexcept { return last_quoted_; }

private:
    void add_entry(Node& node, const YAML::Node& key, const YAML::Node& value, int depth) {
        const Position at = key.Mark().is_null() ? node.at : Position{key.Mark().line + 1, key.Mark().column + 1};
        if (!key.IsScalar()) {
            problem("config.key", at, "a key must be a word", "write `key: value`");
            return;
        }
        for (const auto& entry : node.entries)
            if (entry.key == key.Scalar()) {
                problem("config.duplicate_key", at,
                        fmt::format("`{}` stands here twice; the first is in line {}", entry.key, entry.at.line), "remove one of them");
                return;
            }
        node.entries.push_back({key.Scalar(), at, {}});
        auto converted = convert(value, at, depth + 1);
        node.entries.back().value = std::move(converted);
    }

    void problem(std::string code, Position at, std::string what, std::string remedy) {
        document_.errors.push_back({std::move(code), located(document_.file, at), std::move(what), std::move(remedy)});
    }

    Document& document_;
    std::size_t count_ = 0, bytes_ = 0;
    std::optional<Position> last_quoted_;
    bool full_ = false;
};

}  // namespace

const Node* Node::find(std::string_view key) const noexcept {
    for (const auto& entry : entries)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

std::string_view describe(const Node& node) noexcept {
    switch (node.kind) {
        case Node::Kind::null: return "nothing";
        case Node::Kind::scalar: return "a single value";
        case Node::Kind::list: return "a list";
        case Node::Kind::map: return "a section of `key: value` lines";
    }
    return "?";
}

std::string located(std::string_view file, Position at) {
    return at.line == 0 ? std::string(file) : fmt::format("{}:{}:{}", file, at.line, at.column);
}

Document parse_document(std::string file, std::string_view text) {
    Document document;
    document.file = std::move(file);
    const auto fail = [&](std::string code, Position at, std::string what, std::string remedy) {
        document.errors.push_back({std::move(code), located(document.file, at), std::move(what), std::move(remedy)});
    };
    if (text.size() > max_file_bytes) {
        fail("config.too_large", {}, fmt::format("the file has {} bytes, more than {}", text.size(), max_file_bytes),
             "is this the right file?");
        return document;
    }
    if (const auto bad = first_bad_byte(text)) {
        fail("config.encoding", position_at(text, *bad),
             fmt::format("byte {:02X}h is no UTF-8 text", static_cast<unsigned char>(text[*bad])), "save the file as UTF-8");
        return document;
    }
    try {
        if (const auto second = second_document(std::string(text))) {
            fail("config.several_documents", *second, "a second YAML document begins here, or text that belongs to nothing",
                 "keep one document in a file; check `---`, commas and brackets");
            return document;
        }
        const auto root = YAML::Load(std::string(text));
        if (root.IsNull()) {
            fail("config.empty", {}, "the file is empty", "start from config/machines/minimal.yaml");
            return document;
        }
        Converter converter(document);
        document.root = converter.convert(root, {1, 1}, 0);
        if (const auto open = open_quote(text, converter.last_quoted())) {
            document.errors.clear();  // what it swallowed is missed in vain
            document.root = {};
            fail("config.syntax", *open, "the quote that begins here is never closed: all that follows would be one text",
                 "close it in its line, or leave it out");
        }
    } catch (const YAML::Exception& e) {
        const Position at = e.mark.is_null() || e.mark.line < 0 ? Position{} : Position{e.mark.line + 1, e.mark.column + 1};
        if (const auto tab = tab_in_indentation(text, at.line))
            fail("config.syntax", *tab, "the line is indented with a tab, which YAML does not allow", "indent with spaces");
        else {
            const auto words = std::find_if(syntax_words.begin(), syntax_words.end(), [&](const auto& w) { return w.parsers == e.msg; });
            const bool known = words != syntax_words.end();
            fail("config.syntax", at, fmt::format("this is no YAML: {}", known ? words->what : e.msg),
                 std::string(known ? words->remedy : "check indentation, quotes and brackets"));
        }
    } catch (const std::exception& e) {
        fail("config.syntax", {}, fmt::format("this is no YAML: {}", e.what()), "check indentation, quotes and brackets");
    }
    return document;
}

Result<std::string> read_text(const std::string& path, std::string_view kind, std::string_view where, std::size_t most) {
    const auto fail = [&](std::string code, std::string what, std::string remedy) {
        return Error{std::move(code), path, std::move(what), std::move(remedy)};
    };
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) return fail("config.no_file", "there is no such file", fmt::format("check the path{}", where));
    if (!std::filesystem::is_regular_file(status))
        return fail("config.not_a_file", "this is not a regular file", fmt::format("give the path of a {} file", kind));
    const auto size = std::filesystem::file_size(path, error);
    if (!error && size > most)
        return fail("config.too_large", fmt::format("the file has {} bytes, more than {}", size, most), "is this the right file?");
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        return fail("config.unreadable", fmt::format("the file cannot be opened: {}", std::strerror(errno)), "check its permissions");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) return fail("config.unreadable", "the file cannot be read", "check the disk and its permissions");
    FilesRead::note(path, text);
    return text;
}

Document read_document(const std::string& path) {
    auto text = read_text(path, "YAML");
    if (text) return parse_document(path, *text);
    Document document;
    document.file = path;
    document.errors.push_back(text.error());
    return document;
}

}  // namespace taktwerk::config
